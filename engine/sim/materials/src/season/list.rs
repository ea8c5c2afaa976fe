//! All seasons, each with its row.

use super::row::SeasonRow;
use super::{autumn, summer, winter};
use crate::pattern::draw;
use cosfly_domain::Season;

/// Share of towns that are seen in autumn.
const AUTUMN_SHARE: f32 = 0.2;

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
