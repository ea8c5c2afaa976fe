//! [`SeasonRow`], and the list of rows.

use super::{autumn, summer, winter};
use crate::pattern::draw;
use crate::vector::Vec3;
use cosfly_domain::Season;

/// Share of towns that are seen in autumn.
const AUTUMN_SHARE: f32 = 0.2;

/// The look of a season. Colours are linear RGB.
#[derive(Debug)]
pub struct SeasonRow {
    /// Lawns, where they are fresh and where they are dry.
    pub lawn: [Vec3; 2],
    /// Woods seen from afar: near ones, and those of hills in the distance.
    pub woods: [Vec3; 2],
    /// Gaps between leaves or twigs that the sun shines through: the values of a noise between which a gap opens, and the share of
    /// the sun's light in an open one.
    pub gaps: [f32; 3],
    /// Factor of the colour of green leaves.
    pub leaf: Vec3,
    /// Leaves that turn, tree by tree: of an even draw from 0 to 1, slope and offset of the share that has turned.
    pub turned: Option<[f32; 2]>,
    /// Whether trees and bushes are bare, evergreen ones left out.
    pub is_bare: bool,
}

/// The look of a season.
pub fn row(season: Season) -> &'static SeasonRow {
    match season {
        Season::Summer => &summer::ROW,
        Season::Autumn => &autumn::ROW,
        Season::Winter => &winter::ROW,
    }
}

/// The season in which a town is seen when nobody names one: summer, or autumn in one town of five.
pub fn of_town(town: u32) -> Season {
    if draw(town, 9) < AUTUMN_SHARE { Season::Autumn } else { Season::Summer }
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
