//! Looks by order: shares of the people by bag, build and gait.

use cosfly_domain::{Traffic, Traits};
use cosfly_frames::Seed;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Fresh draws of looks for somebody who is to look as ordered.
const DRAWS: u64 = 5_000;

/// Shares of the people by bag, build and gait, followed people among them. What has no shares is left to chance.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct LooksConfig {
    /// Shares of people with no bag, a backpack, a bag at the shoulder, such as `{ none = 0.6, backpack = 0.3, shoulder_bag = 0.1 }`.
    /// They must add up to 1. Left to chance, they are 0.52, 0.35 and 0.13.
    pub bags: Option<BagShares>,
    /// Shares of slim, medium and stout people. Left to chance, they are about 0.18, 0.52 and 0.30.
    pub builds: Option<BuildShares>,
    /// Shares of people with short, medium and long steps. Left to chance, each is a third.
    pub gaits: Option<GaitShares>,
}

/// Shares by bag.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct BagShares {
    /// No bag. Default 0.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub none: f64,
    /// A backpack. Default 0.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub backpack: f64,
    /// A bag at the shoulder. Default 0.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub shoulder_bag: f64,
}

/// Shares by build.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct BuildShares {
    /// Slim people. Default 0.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub slim: f64,
    /// People of medium build. Default 0.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub medium: f64,
    /// Stout people. Default 0.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub stout: f64,
}

/// Shares by gait.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct GaitShares {
    /// Short steps. Default 0.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub short: f64,
    /// Medium steps. Default 0.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub medium: f64,
    /// Long steps. Default 0.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub long: f64,
}

/// A trait by its shares: name in recipes, shares in the order of the kinds, base of the sequence that spreads them.
type Order = (&'static str, Option<[f64; 3]>, u32);

impl LooksConfig {
    fn orders(&self) -> [Order; 3] {
        let bags = self.bags.as_ref().map(|it| [it.none, it.backpack, it.shoulder_bag]);
        let builds = self.builds.as_ref().map(|it| [it.slim, it.medium, it.stout]);
        let gaits = self.gaits.as_ref().map(|it| [it.short, it.medium, it.long]);
        [("bags", bags, 2), ("builds", builds, 3), ("gaits", gaits, 5)]
    }

    /// Checks the shares; the message names the rule, the first part the table that breaks it.
    ///
    /// # Errors
    /// Shares that are negative or do not add up to 1.
    pub fn check(&self) -> Result<(), (&'static str, String)> {
        for (name, shares, _) in self.orders() {
            let Some(shares) = shares else { continue };
            let sum: f64 = shares.iter().sum();
            if let Some(share) = shares.iter().find(|share| share.is_nan() || **share < 0.0) {
                return Err((name, format!("a share is `{share}`; it must be at least `0`")));
            }
            if (sum - 1.0).abs() > 1e-6 {
                return Err((name, format!("the shares add up to `{sum}`; they must add up to `1`")));
            }
        }
        Ok(())
    }

    /// Traits that person number `place` is to have: exactly the shares in every long run of people.
    fn ordered(&self, place: u32, seed: &Seed) -> [Option<usize>; 3] {
        self.orders().map(|(name, shares, base)| {
            let mut at = (radical_inverse(place, base) + seed.stream(name).unit()).fract();
            let shares = shares?;
            for (kind, share) in shares.iter().enumerate() {
                if at < *share {
                    return Some(kind);
                }
                at -= share;
            }
            shares.iter().rposition(|share| *share > 0.0)
        })
    }
}

/// The digits of a number after the point in reverse order: a sequence that is even from its beginning.
fn radical_inverse(mut number: u32, base: u32) -> f64 {
    let (mut value, mut place) = (0.0, 1.0 / f64::from(base));
    while number > 0 {
        value += f64::from(number % base) * place;
        place /= f64::from(base);
        number /= base;
    }
    value
}

/// Gives all people of a town looks as ordered; `traits` tells them from a seed of looks. Gives a note on what could not be found.
pub fn give_looks(
    traffic: &mut Traffic,
    config: &LooksConfig,
    traits: &dyn Fn(&Seed) -> Traits,
    seed: &Seed,
) -> Option<String> {
    if *config == LooksConfig::default() {
        return None;
    }
    let mut missing = 0;
    let people = traffic.bodies.iter_mut().filter(|body| body.plan.kind.is_person());
    for (place, body) in (0..).zip(people) {
        let ordered = config.ordered(place, seed);
        let has = |looks: &Seed| {
            let Traits { bag, build, gait } = traits(looks);
            let all = [bag as usize, build as usize, gait as usize];
            ordered.iter().zip(all).all(|(wanted, own)| wanted.is_none_or(|wanted| wanted == own))
        };
        let own = body.plan.looks;
        let mut drawn = std::iter::once(own).chain((0..DRAWS).map(|draw| own.child("ordered looks", draw)));
        match drawn.find(has) {
            Some(looks) => body.plan.looks = looks,
            None => missing += 1,
        }
    }
    (missing > 0).then(|| format!("looks: {missing} people do not have the bag, build or gait that was ordered"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_domain::{Bag, BodyBuild, Gait};
    use cosfly_domain::{Body, BodyKind, BodyPlan};
    use cosfly_frames::DVec3;

    fn traits(looks: &Seed) -> Traits {
        let bag = [Bag::None, Bag::Backpack, Bag::Shoulder][usize::from(looks.0[0] % 3)];
        let build = [BodyBuild::Slim, BodyBuild::Medium, BodyBuild::Stout][usize::from(looks.0[1] % 3)];
        let gait = [Gait::Short, Gait::Medium, Gait::Long][usize::from(looks.0[2] % 3)];
        Traits { bag, build, gait }
    }

    fn people(count: u32) -> Traffic {
        let body = |number: u32| {
            let looks = Seed([7; 32]).child("person", u64::from(number));
            let size_m = DVec3::new(0.5, 0.5, 1.7);
            let plan = BodyPlan { source: String::new(), kind: BodyKind::Pedestrian, size_m, looks, group: None };
            Body { plan, first_frame: 0, states: vec![] }
        };
        Traffic { dt_s: 0.5, frames: 0, bodies: (0..count).map(body).collect(), ..Traffic::default() }
    }

    #[test]
    fn shares_are_kept_and_what_has_none_stays_as_it_is() {
        let bags = BagShares { none: 0.5, backpack: 0.2, shoulder_bag: 0.3 };
        let gaits = GaitShares { short: 0.0, medium: 0.25, long: 0.75 };
        let config = LooksConfig { bags: Some(bags), builds: None, gaits: Some(gaits) };
        let mut traffic = people(400);
        assert_eq!(give_looks(&mut traffic, &config, &traits, &Seed([3; 32])), None);
        let count = |is: &dyn Fn(Traits) -> bool| {
            traffic.bodies.iter().filter(|body| is(traits(&body.plan.looks))).count() as f64 / 400.0
        };
        let close = |share: f64, to: f64| assert!((share - to).abs() <= 0.01, "{share} {to}");
        close(count(&|it| it.bag == Bag::Backpack), 0.2);
        close(count(&|it| it.bag == Bag::Shoulder), 0.3);
        close(count(&|it| it.gait == Gait::Medium), 0.25);
        assert_eq!(count(&|it| it.gait == Gait::Short), 0.0);
        // More people change nobody before them; without orders nobody changes.
        let mut fewer = people(100);
        give_looks(&mut fewer, &config, &traits, &Seed([3; 32]));
        assert_eq!(fewer.bodies[..], traffic.bodies[..100]);
        let mut free = people(9);
        give_looks(&mut free, &LooksConfig::default(), &traits, &Seed([3; 32]));
        assert_eq!(free.bodies, people(9).bodies);
    }

    #[test]
    fn shares_must_add_up() {
        let stout =
            |slim, stout| LooksConfig { builds: Some(BuildShares { slim, medium: 0.0, stout }), ..Default::default() };
        assert!(stout(0.4, 0.6).check().is_ok());
        assert_eq!(stout(0.5, 0.6).check().unwrap_err().0, "builds");
        assert!(stout(-0.5, 1.5).check().is_err() && stout(f64::NAN, 1.0).check().is_err());
    }
}
