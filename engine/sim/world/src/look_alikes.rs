//! Look-alikes by order: how many of the people who come near a followed person wear the same clothes.

use cosfly_domain::{Body, Traffic, Traits};
use cosfly_frames::{DVec2, Seed};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Fresh draws of clothes that nobody near is to wear, before one is taken as it is.
const DRAWS: u64 = 100;
/// Fresh draws for a look-alike of an own build or gait.
const DRAWS_ALIKE: u64 = 50_000;

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
    /// Whether look-alikes have the build of the followed person; otherwise their own. Default true.
    pub same_build: bool,
    /// Whether look-alikes have the gait of the followed person; otherwise their own. Default true.
    pub same_gait: bool,
    /// Look-alikes are only those who cross the way of the followed person, seen from above, at most so many seconds before or after it.
    /// Default: whoever comes near.
    #[schemars(range(min = 0.0, max = 600.0))]
    pub crossing_s: Option<f64>,
}

/// Clothes by the seeds of looks, as the pictures show them.
#[derive(Clone, Copy)]
pub struct OutfitsBySeed<'a> {
    /// Whether two seeds give the same clothes in words.
    pub alike: &'a dyn Fn(&Seed, &Seed) -> bool,
    /// Bag, build and gait of a seed.
    pub traits: &'a dyn Fn(&Seed) -> Traits,
}

impl Default for LookAlikeConfig {
    fn default() -> Self {
        Self { shares: vec![], within_m: 15.0, same_height: true, same_build: true, same_gait: true, crossing_s: None }
    }
}

impl LookAlikeConfig {
    /// Checks the shares; the message names the rule.
    ///
    /// # Errors
    /// Shares that are negative or do not add up to 1.
    pub fn check(&self) -> Result<(), String> {
        if let Some(share) = self.shares.iter().find(|share| share.is_nan() || **share < 0.0) {
            return Err(format!("a share is `{share}`; it must be at least `0`"));
        }
        let sum: f64 = self.shares.iter().sum();
        if self.shares.is_empty() || (sum - 1.0).abs() <= 1e-6 {
            return Ok(());
        }
        Err(format!("the shares add up to `{sum}`; they must add up to `1`"))
    }

    /// Looks like `target` for somebody who has the looks `own`: the same clothes and bag, build and gait as configured.
    fn like(&self, target: &Seed, own: &Seed, wardrobe: OutfitsBySeed<'_>) -> Option<Seed> {
        if self.same_build && self.same_gait {
            return Some(*target);
        }
        let (theirs, mine) = ((wardrobe.traits)(target), (wardrobe.traits)(own));
        let build = if self.same_build { theirs.build } else { mine.build };
        let gait = if self.same_gait { theirs.gait } else { mine.gait };
        let wanted = Traits { bag: theirs.bag, build, gait };
        let mut drawn = (0..DRAWS_ALIKE).map(|draw| own.child("look-alike", draw));
        drawn.find(|looks| (wardrobe.alike)(looks, target) && (wardrobe.traits)(looks) == wanted)
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
/// Gives a note on what could not be filled.
pub fn dress(
    traffic: &mut Traffic,
    followed: &[u32],
    config: &LookAlikeConfig,
    wardrobe: OutfitsBySeed<'_>,
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
    let alike = wardrobe.alike;
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
            let may = open > 0 && config.crossing_s.is_none_or(|within_s| crosses(traffic, *own, *other, within_s));
            let dressed = if may { config.like(&plan.looks, &looks(traffic, *other), wardrobe) } else { None };
            if let Some(dressed) = dressed {
                traffic.bodies[at].plan.looks = dressed;
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
        let crosses = config.crossing_s.map_or_else(String::new, |within_s| format!(" and crosses within {within_s} s"));
        format!(
            "look-alikes: {ordered} ordered near {} followed people; {missing} missing, nobody else comes within {} m{crosses}; {surplus} more by chance among the followed",
            people.len(),
            config.within_m
        )
    })
}

/// Whether the ways of two bodies cross, seen from above, where they pass at most `within_s` apart.
fn crosses(traffic: &Traffic, own: u32, other: u32, within_s: f64) -> bool {
    let (own, other) = (&traffic.bodies[own as usize], &traffic.bodies[other as usize]);
    let apart = (within_s / traffic.dt_s).ceil().min(f64::from(traffic.frames)) as u32;
    let step = |body: &Body, frame: u32| {
        let place = |frame: u32| body.state(frame).map(|state| state.feet_in_world.truncate());
        place(frame).zip(place(frame + 1))
    };
    (0..traffic.frames).any(|frame| {
        let Some(one) = step(own, frame) else { return false };
        let frames = frame.saturating_sub(apart)..=(frame + apart).min(traffic.frames);
        frames.filter_map(|frame| step(other, frame)).any(|two| segments_cross(one, two))
    })
}

/// Whether two segments in plan meet in one point; those along each other do not.
fn segments_cross((a, b): (DVec2, DVec2), (c, d): (DVec2, DVec2)) -> bool {
    let side = |from: DVec2, to: DVec2, point: DVec2| (to - from).perp_dot(point - from);
    side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
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
    use cosfly_domain::{Bag, BodyBuild, BodyKind, BodyPlan, Gait};
    use cosfly_frames::{DVec3, TargetState};

    /// Seeds that begin with the same letter of three give the same clothes.
    fn alike(a: &Seed, b: &Seed) -> bool {
        a.0[0] % 3 == b.0[0] % 3
    }

    fn traits(looks: &Seed) -> Traits {
        let build = if looks.0[1].is_multiple_of(2) { BodyBuild::Slim } else { BodyBuild::Stout };
        Traits { bag: Bag::None, build, gait: Gait::Medium }
    }

    const WARDROBE: OutfitsBySeed<'_> = OutfitsBySeed { alike: &alike, traits: &traits };

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
        let config = LookAlikeConfig { shares: vec![0.5, 0.25, 0.25], within_m: 9.0, ..LookAlikeConfig::default() };
        let followed: Vec<u32> = (0..16).map(|number| 20 * number + 5).collect();
        let mut traffic = street(400);
        let note = dress(&mut traffic, &followed, &config, WARDROBE, &Seed([3; 32]));
        assert_eq!(note, None);
        let mut counts = [0; 3];
        followed.iter().for_each(|own| counts[count(&traffic, *own, 9.0)] += 1);
        assert_eq!(counts, [8, 4, 4]);
        let lone = LookAlikeConfig { shares: vec![1.0], ..config.clone() };
        let mut traffic = street(400);
        dress(&mut traffic, &followed, &lone, WARDROBE, &Seed([3; 32]));
        assert!(followed.iter().all(|own| count(&traffic, *own, 9.0) == 0));
        let crowded = LookAlikeConfig { shares: vec![0.0, 0.0, 0.0, 1.0], within_m: 2.0, ..config };
        let note =
            dress(&mut street(9), &[4], &crowded, WARDROBE, &Seed([3; 32])).expect("two are near, three were ordered");
        assert!(note.contains("3 ordered near 1 followed people; 1 missing"), "{note}");
    }

    #[test]
    fn look_alikes_may_keep_their_own_build() {
        let config = LookAlikeConfig { shares: vec![0.0, 1.0], same_build: false, ..LookAlikeConfig::default() };
        let mut traffic = street(9);
        let own: Vec<BodyBuild> = traffic.bodies.iter().map(|body| traits(&body.plan.looks).build).collect();
        assert_eq!(dress(&mut traffic, &[4], &config, WARDROBE, &Seed([3; 32])), None);
        let dressed = |number: usize| alike(&traffic.bodies[number].plan.looks, &traffic.bodies[4].plan.looks);
        let likes: Vec<usize> = (0..9).filter(|number| *number != 4 && dressed(*number)).collect();
        assert_eq!(likes.len(), 1);
        assert_eq!(traits(&traffic.bodies[likes[0]].plan.looks).build, own[likes[0]]);
    }

    #[test]
    fn only_those_who_cross_are_dressed_alike_where_that_is_asked_for() {
        let mut traffic = street(3);
        let walk = |body: &mut Body, from: DVec3, by: DVec3| {
            let place = |frame: u32| from + by * f64::from(frame);
            body.states = (0..9)
                .map(|frame| TargetState { feet_in_world: place(frame), heading_rad: 0.0, speed_mps: 1.0 })
                .collect();
        };
        traffic.frames = 9;
        walk(&mut traffic.bodies[0], DVec3::ZERO, DVec3::X);
        walk(&mut traffic.bodies[1], DVec3::new(0.0, 1.0, 0.0), DVec3::X);
        walk(&mut traffic.bodies[2], DVec3::new(4.5, 4.5, 0.0), -DVec3::Y);
        assert!(crosses(&traffic, 0, 2, 0.5) && !crosses(&traffic, 0, 1, 9.0));
        // Who comes two seconds later crosses within two seconds.
        walk(&mut traffic.bodies[2], DVec3::new(0.5, 4.5, 0.0), -DVec3::Y);
        assert!(crosses(&traffic, 0, 2, 2.5) && !crosses(&traffic, 0, 2, 1.0));
        let config = LookAlikeConfig { shares: vec![0.0, 1.0], crossing_s: Some(3.0), ..LookAlikeConfig::default() };
        assert_eq!(dress(&mut traffic, &[0], &config, WARDROBE, &Seed([3; 32])), None);
        let looks = |number: usize| traffic.bodies[number].plan.looks;
        assert!(looks(2) == looks(0) && !alike(&looks(1), &looks(0)));
    }

    #[test]
    fn shares_must_add_up() {
        let config = |shares: &[f64]| LookAlikeConfig { shares: shares.to_vec(), ..LookAlikeConfig::default() };
        assert!(config(&[]).check().is_ok() && config(&[0.2, 0.8]).check().is_ok());
        assert!(config(&[0.2, 0.9]).check().unwrap_err().contains("`1.1"));
        assert!(config(&[-0.5, 1.5]).check().is_err());
    }
}
