//! Compass words. On a CARLA map x points east and y south, so north is -y.

use cosfly_frames::real;
use serde::{Deserialize, Serialize};

/// One of eight directions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[expect(missing_docs, reason = "the names say it")]
pub enum Compass {
    East,
    Southeast,
    South,
    Southwest,
    West,
    Northwest,
    North,
    Northeast,
}

impl Compass {
    /// Clockwise from east, the order of growing yaw.
    pub const ALL: [Self; 8] = [
        Self::East,
        Self::Southeast,
        Self::South,
        Self::Southwest,
        Self::West,
        Self::Northwest,
        Self::North,
        Self::Northeast,
    ];

    /// The direction nearest to a yaw in the world frame (0 = +x = east, positive towards +y = south).
    pub fn of_yaw_rad(yaw_rad: f64) -> Self {
        let eighth = (real::wrap_angle_rad(yaw_rad) / (real::TAU / 8.0)).round();
        Self::ALL[(eighth as i64).rem_euclid(8) as usize]
    }

    /// The English word.
    pub fn english(self) -> &'static str {
        match self {
            Self::East => "east",
            Self::Southeast => "southeast",
            Self::South => "south",
            Self::Southwest => "southwest",
            Self::West => "west",
            Self::Northwest => "northwest",
            Self::North => "north",
            Self::Northeast => "northeast",
        }
    }

    /// The Chinese word.
    pub fn chinese(self) -> &'static str {
        match self {
            Self::East => "东",
            Self::Southeast => "东南",
            Self::South => "南",
            Self::Southwest => "西南",
            Self::West => "西",
            Self::Northwest => "西北",
            Self::North => "北",
            Self::Northeast => "东北",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn minus_y_is_north_and_growing_yaw_turns_clockwise() {
        for (yaw_deg, expected) in [
            (0.0, Compass::East),
            (-90.0, Compass::North),
            (90.0, Compass::South),
            (180.0, Compass::West),
            (-180.0, Compass::West),
            (-44.0, Compass::Northeast),
            (22.0, Compass::East),
            (23.0, Compass::Southeast),
            (630.0, Compass::North),
        ] {
            assert_eq!(Compass::of_yaw_rad(f64::to_radians(yaw_deg)), expected, "{yaw_deg}");
        }
    }
}
