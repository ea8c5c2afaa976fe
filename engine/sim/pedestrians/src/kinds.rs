//! [`KindShares`]: which shares of the people are children, old people, and people who take something along.

use crate::PedestrianConfigRule;
use cosfly_domain::{BodyKind, Walking};
use cosfly_frames::Seed;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Shares of the people by kind; all others are grown people on foot.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct KindShares {
    /// Children, 0.98 to 1.45 m tall. Default 0.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub child: f64,
    /// People with a dog on a leash. Default 0.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub dog_walker: f64,
    /// Old people, slow, stooped, with a stick. Default 0.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub elder: f64,
    /// People with a push-chair. Default 0.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub push_chair: f64,
    /// People who run, 1.8 to 2.4 times as fast as they would walk; in company they keep to its pace. Default 0.
    #[serde(skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub runner: f64,
    /// People who sit on a chair at an edge of the walkable ground and stay there. Default 0.
    #[serde(skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub sitter: f64,
    /// People in a wheelchair. Default 0.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub wheelchair: f64,
}

impl KindShares {
    /// Whether all are grown people on foot.
    pub(crate) fn is_default(&self) -> bool {
        *self == Self::default()
    }

    fn shares(&self) -> [(BodyKind, &'static [&'static str], f64); 7] {
        [
            (BodyKind::Child, &["kinds", "child"], self.child),
            (BodyKind::DogWalker, &["kinds", "dog_walker"], self.dog_walker),
            (BodyKind::Elder, &["kinds", "elder"], self.elder),
            (BodyKind::PushChair, &["kinds", "push_chair"], self.push_chair),
            (BodyKind::Wheelchair, &["kinds", "wheelchair"], self.wheelchair),
            (BodyKind::Sitter, &["kinds", "sitter"], self.sitter),
            (BodyKind::Runner, &["kinds", "runner"], self.runner),
        ]
    }

    pub(crate) fn check(&self) -> Result<(), PedestrianConfigRule> {
        for (_, path, share) in self.shares() {
            PedestrianConfigRule::within(path, share, 0.0, 1.0)?;
        }
        let sum: f64 = self.shares().iter().map(|it| it.2).sum();
        if sum > 1.0 + 1e-9 {
            let message =
                format!("the shares add up to `{sum}`; they must add up to at most `1`, the rest are grown people");
            return Err(PedestrianConfigRule { path: vec!["kinds"], message });
        }
        Ok(())
    }

    /// The kind of somebody, drawn from a seed.
    pub fn draw(&self, seed: &Seed) -> BodyKind {
        if self.is_default() {
            return BodyKind::Pedestrian;
        }
        let mut left = seed.stream("kind").unit();
        let is_drawn = |(_, _, share): &(BodyKind, &[&str], f64)| {
            left -= share;
            left < 0.0
        };
        self.shares().into_iter().find(is_drawn).map_or(BodyKind::Pedestrian, |it| it.0)
    }

    /// Distance that the middle of everybody keeps from obstacles, metres: half the length of the longest
    /// kind that is present, at least `of_people`.
    pub(crate) fn clearance_m(&self, of_people: f64) -> f64 {
        let present = self.shares().into_iter().filter(|(.., share)| *share > 0.0);
        let outlines = present.filter_map(|(kind, ..)| kind.row().walking.as_ref()?.outline_m);
        outlines.map(|[length_m, _]| 0.5 * length_m).fold(of_people, f64::max)
    }
}

pub(crate) fn is_zero(share: &f64) -> bool {
    *share == 0.0
}

/// Size and pace of somebody of a kind, as a share of the speed that the person would have had.
pub(crate) struct OfKind {
    pub pace: f64,
    pub height_m: f64,
    pub radius_m: f64,
}

impl OfKind {
    /// Somebody of a kind who would be so high and wide as a grown person on foot.
    pub fn drawn(kind: BodyKind, seed: &Seed, height_m: f64, radius_m: f64) -> Self {
        let as_grown = Self { pace: 1.0, height_m, radius_m };
        let Some(Walking { heights_m, pace: [slow, fast], outline_m }) = kind.row().walking else { return as_grown };
        if kind == BodyKind::Pedestrian {
            return as_grown;
        }
        let mut stream = seed.stream("kind size");
        let pace = stream.uniform(slow, fast);
        let own_m = heights_m.map_or(height_m, |[low, high]| stream.uniform(low, high));
        let radius_m = outline_m.map_or(radius_m * own_m / height_m, |[length_m, _]| 0.5 * length_m);
        Self { pace, height_m: own_m, radius_m }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::CrowdConfig;

    #[test]
    fn kinds_have_their_shares_and_those_that_cannot_be_are_refused() {
        let kinds = KindShares { child: 0.3, wheelchair: 0.1, ..KindShares::default() };
        let drawn: Vec<BodyKind> = (0..2000).map(|number| kinds.draw(&Seed([4; 32]).child("person", number))).collect();
        for (kind, share) in [(BodyKind::Child, 0.3), (BodyKind::Wheelchair, 0.1), (BodyKind::Pedestrian, 0.6)] {
            let found = drawn.iter().filter(|it| **it == kind).count() as f64 / 2000.0;
            assert!((found - share).abs() < 0.03, "{kind:?}: {found}");
        }
        let with_dogs = KindShares { dog_walker: 0.1, ..KindShares::default() };
        assert_eq!([kinds.clearance_m(0.3), with_dogs.clearance_m(0.3)], [0.525, 0.8]);
        assert_eq!(KindShares { child: 0.3, ..KindShares::default() }.clearance_m(0.3), 0.3);
        let refused = |kinds: KindShares| CrowdConfig { kinds, ..CrowdConfig::default() }.check().unwrap_err();
        assert_eq!(refused(KindShares { elder: -0.1, ..KindShares::default() }).path, ["kinds", "elder"]);
        let all = refused(KindShares { elder: 0.75, child: 0.5, ..KindShares::default() });
        assert!(all.path == ["kinds"] && all.message.starts_with("the shares add up to `1.25`; they must"), "{all:?}");
    }
}
