//! Seasons: leaves of trees, and lawns.

use super::pattern::draw;
use super::vector::Vec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Season of leaves and lawns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Season {
    /// Green leaves.
    Summer,
    /// Leaves turn, trees of a town one after the other.
    Autumn,
    /// Trees are bare but for evergreen ones, lawns are pale.
    Winter,
}

/// Share of towns that are seen in autumn.
const AUTUMN_SHARE: f32 = 0.2;

impl Season {
    /// The season in which a town is seen when nobody names one: never winter.
    pub fn of_town(town: u32) -> Self {
        if draw(town, 9) < AUTUMN_SHARE { Self::Autumn } else { Self::Summer }
    }

    /// The season of a name, if there is one.
    pub fn named(name: &str) -> Option<Self> {
        [Self::Summer, Self::Autumn, Self::Winter].into_iter().find(|season| season.name() == name)
    }

    /// The name in recipes and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Summer => "summer",
            Self::Autumn => "autumn",
            Self::Winter => "winter",
        }
    }

    /// Colours of lawns, linear RGB: where they are fresh, and where they are dry.
    pub fn lawn(self) -> [Vec3; 2] {
        match self {
            Self::Summer | Self::Autumn => [Vec3::new(0.084, 0.146, 0.040), Vec3::new(0.200, 0.195, 0.080)],
            Self::Winter => [Vec3::new(0.092, 0.118, 0.046), Vec3::new(0.175, 0.155, 0.088)],
        }
    }

    /// Colours of woods seen from afar, linear RGB: near ones, and those of hills in the distance.
    pub fn woods(self) -> [Vec3; 2] {
        match self {
            Self::Summer => [Vec3::new(0.055, 0.085, 0.035), Vec3::new(0.060, 0.080, 0.045)],
            Self::Autumn => [Vec3::new(0.110, 0.085, 0.034), Vec3::new(0.090, 0.078, 0.044)],
            Self::Winter => [Vec3::new(0.075, 0.066, 0.054), Vec3::new(0.070, 0.066, 0.060)],
        }
    }

    /// Gaps between leaves or twigs that the sun shines through: the values of a noise between which a gap opens, and the share
    /// of the sun's light in an open one.
    pub fn gaps(self) -> [f32; 3] {
        match self {
            Self::Summer | Self::Autumn => [0.52, 0.70, 0.75],
            Self::Winter => [0.30, 0.62, 0.85],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_towns_in_five_are_seen_in_summer() {
        let seasons = (0..5000u32).map(|town| Season::of_town(town.wrapping_mul(0x9e37_79b1)));
        let share = seasons.filter(|of_town| *of_town == Season::Summer).count() as f32 / 5000.0;
        assert!((share - 0.8).abs() < 0.02, "{share}");
    }
}
