//! Builds of people: proportions, hair, coats, bags at the shoulder and gait, drawn from a person's own seed.

use cosfly_domain::{BodyBuild, Gait};
use cosfly_frames::Seed;

/// Bellies deeper than this are stout; mean widths of shoulders and hips below this are slim.
const STOUT_BELLY: f64 = 1.1;
const SLIM_WIDTH: f64 = 0.97;
/// Swings of the legs between these are medium steps.
const MEDIUM_STRIDES: [f64; 2] = [0.95, 1.05];

/// Body and bearing of a person. Factors are relative to the usual figure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Build {
    /// Width of the shoulders.
    pub shoulders: f64,
    /// Width of the hips.
    pub hips: f64,
    /// Depth of the belly.
    pub belly: f64,
    /// How far the shoulders are before the hips, body heights per body height.
    pub lean: f64,
    /// Swing of the legs.
    pub stride: f64,
    /// Swing of the arms.
    pub arm_swing: f64,
    /// Hair or hat.
    pub hair: Hair,
    /// Bearing of the right arm.
    pub right_arm: ArmBearing,
    /// Wears a top that reaches to the thighs.
    pub long_top: bool,
    /// Carries a bag at the right hip, where there is no backpack.
    pub shoulder_bag: bool,
}

/// Hair or hat.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hair {
    /// Ends above the neck.
    Short,
    /// Falls on the shoulders.
    Long,
    /// Tied behind the head.
    Bun,
    /// None: skin.
    Bald,
    /// A cap with a peak, in a colour of clothes.
    Cap,
    /// A hat with a brim all around, in a colour of clothes.
    Hat,
}

/// Bearing of an arm.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ArmBearing {
    /// Swings with the gait.
    Swings,
    /// Rests with the hand in a pocket.
    Pocket,
    /// Holds something before the chest.
    Holds,
    /// Holds a stick or a leash before the hip; no build draws it.
    Leads,
    /// Pushes something before the belly; no build draws it.
    Pushes,
}

impl Build {
    /// The build that a seed draws.
    pub fn draw(seed: &Seed) -> Self {
        let mut stream = seed.stream("build");
        let wide = stream.uniform(0.90, 1.12);
        let shoulders = wide * stream.uniform(0.92, 1.08);
        let hips = wide * stream.uniform(0.92, 1.12);
        let belly = if stream.chance(0.3) { stream.uniform(1.1, 1.5) } else { stream.uniform(0.85, 1.1) };
        let lean = stream.uniform(-0.01, 0.07);
        let [stride, arm_swing] = [[0.85, 1.15], [0.5, 1.3]].map(|[low, high]| stream.uniform(low, high));
        let hair = match stream.unit() {
            share if share < 0.25 => Hair::Long,
            share if share < 0.33 => Hair::Bun,
            share if share < 0.39 => Hair::Bald,
            share if share < 0.47 => Hair::Cap,
            share if share < 0.53 => Hair::Hat,
            _ => Hair::Short,
        };
        let right_arm = match stream.unit() {
            share if share < 0.08 => ArmBearing::Pocket,
            share if share < 0.14 => ArmBearing::Holds,
            _ => ArmBearing::Swings,
        };
        let [long_top, shoulder_bag] = [0.22, 0.20].map(|share| stream.chance(share));
        Self { shoulders, hips, belly, lean, stride, arm_swing, hair, right_arm, long_top, shoulder_bag }
    }
}

impl Build {
    /// The build in words.
    pub fn body_build(&self) -> BodyBuild {
        match self {
            Self { belly, .. } if *belly > STOUT_BELLY => BodyBuild::Stout,
            Self { shoulders, hips, .. } if 0.5 * (shoulders + hips) < SLIM_WIDTH => BodyBuild::Slim,
            _ => BodyBuild::Medium,
        }
    }

    /// The steps in words.
    pub fn gait(&self) -> Gait {
        let [short, long] = MEDIUM_STRIDES;
        match self.stride {
            stride if stride < short => Gait::Short,
            stride if stride > long => Gait::Long,
            _ => Gait::Medium,
        }
    }
}

/// Size of the head relative to a grown person's, by body height: a child of 1.0 m has a head of a fifth of its height.
pub(crate) fn head_size(height_m: f64) -> f64 {
    1.0 + 0.45 * ((1.5 - height_m) / 0.5).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn people_differ_and_nobody_is_outside_the_ranges() {
        let builds: Vec<Build> = (0..500).map(|number| Build::draw(&Seed([9; 32]).child("person", number))).collect();
        let share = |of: &dyn Fn(&Build) -> bool| builds.iter().filter(|build| of(build)).count() as f64 / 500.0;
        assert!((share(&|build| build.hair == Hair::Long) - 0.25).abs() < 0.06);
        assert!((share(&|build| build.right_arm == ArmBearing::Swings) - 0.86).abs() < 0.06);
        assert!((share(&|build| build.long_top) - 0.22).abs() < 0.06);
        assert!((share(&|build| build.body_build() == BodyBuild::Stout) - 0.30).abs() < 0.06);
        let slim = share(&|build| build.body_build() == BodyBuild::Slim);
        assert!((slim - 0.18).abs() < 0.06, "{slim}");
        assert!(builds.iter().all(|build| (0.82..1.26).contains(&build.shoulders) && build.lean.abs() < 0.08));
    }

    #[test]
    fn words_for_builds_and_gaits_have_the_stated_shares() {
        let seed = |number: u64| Seed([9; 32]).child("person", number);
        let builds: Vec<Build> = (0..4000).map(|number| Build::draw(&seed(number))).collect();
        let share = |of: &dyn Fn(&Build) -> bool| builds.iter().filter(|build| of(build)).count() as f64 / 4000.0;
        let gaits = [Gait::Short, Gait::Medium, Gait::Long].map(|gait| share(&|build| build.gait() == gait));
        assert!(gaits.iter().all(|share| (share - 1.0 / 3.0).abs() < 0.03), "{gaits:?}");
        let kinds = [BodyBuild::Slim, BodyBuild::Medium, BodyBuild::Stout];
        let shares = kinds.map(|kind| share(&|build| build.body_build() == kind));
        assert!((0..3).all(|k| (shares[k] - [0.18, 0.52, 0.30][k]).abs() < 0.04), "{shares:?}");
    }

    #[test]
    fn children_have_larger_heads() {
        assert_eq!(head_size(1.75), 1.0);
        assert!(head_size(1.25) > 1.2 && head_size(0.6) < 1.46);
    }
}
