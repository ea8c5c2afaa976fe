//! Look-alikes by order: how many of the people who come near a followed person wear the same clothes.

use crate::body::Body;
use crate::traffic::Traffic;
use cosfly_frames::Seed;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Fresh draws of clothes that nobody near is to wear, before one is taken as it is.
const DRAWS: u64 = 100;

/// People who are dressed like a followed person, in stated shares. Without shares, chance decides as for everybody.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct LookAlikeConfig {
    /// Shares of the followed people with 0, 1, 2 ... look-alikes near them, such as `[0.5, 0.3, 0.2]`; `[1.0]`: nobody near is
    /// dressed like them. They must add up to 1. Default: empty, chance decides.
    #[schemars(length(max = 20))]
    pub shares: Vec<f64>,
    /// Somebody who comes within this distance of the followed person is near, metres. Default 15.
    #[schemars(range(min = 0.5, max = 200.0))]
    pub within_m: f64,
    /// Whether look-alikes are as tall as the followed person. Default true.
    pub same_height: bool,
}

impl Default for LookAlikeConfig {
    fn default() -> Self {
        Self { shares: vec![], within_m: 15.0, same_height: true }
    }
}

impl LookAlikeConfig {
    /// Checks the shares; the message names the rule.
    ///
    /// # Errors
    /// Shares that are negative or do not add up to 1.
    pub fn check(&self) -> Result<(), String> {
        let sum: f64 = self.shares.iter().sum();
        let is_sound = self.shares.iter().all(|share| *share >= 0.0) && (sum - 1.0).abs() <= 1e-6;
        if self.shares.is_empty() || is_sound {
            return Ok(());
        }
        Err(format!("the shares add up to `{sum}`; they must not be negative and add up to `1`"))
    }

    /// Number of look-alikes of the followed person number `place` of all: exactly the shares in every long run of people, in an
    /// order that the seed mixes.
    fn ordered(&self, place: usize, seed: &Seed) -> usize {
        // Van der Corput's sequence is even from the beginning; the shift differs from seed to seed.
        let even = (place as u32).reverse_bits() as f64 / f64::from(u32::MAX);
        let mut at = (even + seed.stream("shift").unit()).fract();
        for (count, share) in self.shares.iter().enumerate() {
            if at < *share {
                return count;
            }
            at -= share;
        }
        self.shares.iter().rposition(|share| *share > 0.0).unwrap_or(0)
    }
}

/// Dresses people like those of `followed` whom they come near, as often as ordered, and everybody else near them otherwise.
/// `alike` tells whether two seeds of looks give the same clothes in words. Gives a note on what could not be filled.
pub fn dress(
    traffic: &mut Traffic,
    followed: &[u32],
    config: &LookAlikeConfig,
    alike: &dyn Fn(&Seed, &Seed) -> bool,
    seed: &Seed,
) -> Option<String> {
    if config.shares.is_empty() {
        return None;
    }
    let people: Vec<u32> =
        followed.iter().copied().filter(|it| traffic.bodies[*it as usize].plan.kind.is_person()).collect();
    let all_near: Vec<Vec<u32>> = people.iter().map(|own| nearest_first(traffic, *own, config.within_m)).collect();
    let mut is_fixed = vec![false; traffic.bodies.len()];
    people.iter().for_each(|own| is_fixed[*own as usize] = true);
    let (mut ordered, mut missing, mut surplus) = (0, 0, 0);
    for (place, (own, near)) in people.iter().zip(&all_near).enumerate() {
        let plan = traffic.bodies[*own as usize].plan.clone();
        let looks = |traffic: &Traffic, other: u32| traffic.bodies[other as usize].plan.looks;
        let wanted = config.ordered(place, seed);
        ordered += wanted;
        let by_chance =
            near.iter().filter(|it| is_fixed[**it as usize] && alike(&looks(traffic, **it), &plan.looks)).count();
        surplus += by_chance.saturating_sub(wanted);
        let mut open = wanted.saturating_sub(by_chance);
        for other in near {
            let at = *other as usize;
            if is_fixed[at] {
                continue;
            }
            if open > 0 {
                traffic.bodies[at].plan.looks = plan.looks;
                if config.same_height {
                    traffic.bodies[at].plan.size_m.z = plan.size_m.z;
                }
                is_fixed[at] = true;
                open -= 1;
            } else if alike(&looks(traffic, *other), &plan.looks) {
                let meets = people.iter().zip(&all_near).filter(|it| it.1.contains(other));
                let avoided: Vec<Seed> = meets.map(|it| looks(traffic, *it.0)).collect();
                let own_looks = looks(traffic, *other);
                let mut fresh = (0..DRAWS).map(|draw| own_looks.child("other clothes", draw));
                let chosen = fresh.find(|looks| avoided.iter().all(|it| !alike(looks, it)));
                traffic.bodies[at].plan.looks = chosen.unwrap_or(own_looks);
            }
        }
        missing += open;
    }
    let is_short = missing > 0 || surplus > 0;
    is_short.then(|| {
        format!(
            "look-alikes: {ordered} ordered near {} followed people; {missing} missing, nobody else comes within {} m; {surplus} more by chance among the followed",
            people.len(),
            config.within_m
        )
    })
}

/// People who come within a distance of a body, the one who comes nearest first.
fn nearest_first(traffic: &Traffic, own: u32, within_m: f64) -> Vec<u32> {
    let body = &traffic.bodies[own as usize];
    let least_m = |other: &Body| {
        let away = |frame: u32| {
            let (a, b) = (body.state(frame)?, other.state(frame)?);
            Some((a.feet_in_world - b.feet_in_world).truncate().length())
        };
        (0..traffic.frames).filter_map(away).fold(f64::INFINITY, f64::min)
    };
    let others = (0..).zip(&traffic.bodies).filter(|(number, other)| *number != own && other.plan.kind.is_person());
    let mut near: Vec<(f64, u32)> =
        others.map(|(number, other)| (least_m(other), number)).filter(|it| it.0 <= within_m).collect();
    near.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    near.into_iter().map(|it| it.1).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BodyKind, BodyPlan};
    use cosfly_frames::{DVec3, TargetState};

    /// Seeds that begin with the same letter of three give the same clothes.
    fn alike(a: &Seed, b: &Seed) -> bool {
        a.0[0] % 3 == b.0[0] % 3
    }

    fn street(people: u32) -> Traffic {
        let body = |number: u32| {
            let feet_in_world = DVec3::new(2.0 * f64::from(number), 0.0, 0.0);
            let plan = BodyPlan {
                source: String::new(),
                kind: BodyKind::Pedestrian,
                size_m: DVec3::new(0.5, 0.5, 1.5 + 0.01 * f64::from(number)),
                looks: Seed([number as u8; 32]),
                group: None,
            };
            Body { plan, first_frame: 0, states: vec![TargetState { feet_in_world, heading_rad: 0.0, speed_mps: 0.0 }] }
        };
        Traffic { dt_s: 0.5, frames: 1, bodies: (0..people).map(body).collect(), ..Traffic::default() }
    }

    fn count(traffic: &Traffic, own: u32, within_m: f64) -> usize {
        let looks = |number: u32| traffic.bodies[number as usize].plan.looks;
        nearest_first(traffic, own, within_m).into_iter().filter(|it| alike(&looks(*it), &looks(own))).count()
    }

    #[test]
    fn shares_are_kept_and_nobody_else_is_dressed_alike() {
        let config = LookAlikeConfig { shares: vec![0.5, 0.25, 0.25], within_m: 9.0, same_height: true };
        let followed: Vec<u32> = (0..16).map(|number| 20 * number + 5).collect();
        let mut traffic = street(400);
        let note = dress(&mut traffic, &followed, &config, &alike, &Seed([3; 32]));
        assert_eq!(note, None);
        let mut counts = [0; 3];
        followed.iter().for_each(|own| counts[count(&traffic, *own, 9.0)] += 1);
        assert_eq!(counts, [8, 4, 4]);
        let lone = LookAlikeConfig { shares: vec![1.0], ..config.clone() };
        let mut traffic = street(400);
        dress(&mut traffic, &followed, &lone, &alike, &Seed([3; 32]));
        assert!(followed.iter().all(|own| count(&traffic, *own, 9.0) == 0));
        let crowded = LookAlikeConfig { shares: vec![0.0, 0.0, 0.0, 1.0], within_m: 2.0, ..config };
        let note =
            dress(&mut street(9), &[4], &crowded, &alike, &Seed([3; 32])).expect("two are near, three were ordered");
        assert!(note.contains("3 ordered near 1 followed people; 1 missing"), "{note}");
    }

    #[test]
    fn shares_must_add_up() {
        let config = |shares: &[f64]| LookAlikeConfig { shares: shares.to_vec(), ..LookAlikeConfig::default() };
        assert!(config(&[]).check().is_ok() && config(&[0.2, 0.8]).check().is_ok());
        assert!(config(&[0.2, 0.9]).check().unwrap_err().contains("`1.1"));
        assert!(config(&[-0.5, 1.5]).check().is_err());
    }
}
