//! Seasons in colours: leaves of trees, and lawns.

use super::pattern::draw;
use super::vector::Vec3;
use cosfly_domain::Season;

/// Share of towns that are seen in autumn.
const AUTUMN_SHARE: f32 = 0.2;

/// The season in which a town is seen when nobody names one: never winter.
pub fn of_town(town: u32) -> Season {
    if draw(town, 9) < AUTUMN_SHARE { Season::Autumn } else { Season::Summer }
}

/// Colours of lawns, linear RGB: where they are fresh, and where they are dry.
pub fn lawn(season: Season) -> [Vec3; 2] {
    match season {
        Season::Summer | Season::Autumn => [Vec3::new(0.084, 0.146, 0.040), Vec3::new(0.200, 0.195, 0.080)],
        Season::Winter => [Vec3::new(0.092, 0.118, 0.046), Vec3::new(0.175, 0.155, 0.088)],
    }
}

/// Colours of woods seen from afar, linear RGB: near ones, and those of hills in the distance.
pub fn woods(season: Season) -> [Vec3; 2] {
    match season {
        Season::Summer => [Vec3::new(0.055, 0.085, 0.035), Vec3::new(0.060, 0.080, 0.045)],
        Season::Autumn => [Vec3::new(0.110, 0.085, 0.034), Vec3::new(0.090, 0.078, 0.044)],
        Season::Winter => [Vec3::new(0.075, 0.066, 0.054), Vec3::new(0.070, 0.066, 0.060)],
    }
}

/// Gaps between leaves or twigs that the sun shines through: the values of a noise between which a gap opens, and the share
/// of the sun's light in an open one.
pub fn gaps(season: Season) -> [f32; 3] {
    match season {
        Season::Summer | Season::Autumn => [0.52, 0.70, 0.75],
        Season::Winter => [0.30, 0.62, 0.85],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_towns_in_five_are_seen_in_summer() {
        let seasons = (0..5000u32).map(|town| of_town(town.wrapping_mul(0x9e37_79b1)));
        let share = seasons.filter(|of_town| *of_town == Season::Summer).count() as f32 / 5000.0;
        assert!((share - 0.8).abs() < 0.02, "{share}");
    }
}
