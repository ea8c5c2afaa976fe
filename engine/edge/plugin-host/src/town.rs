//! The town as plugins see it.

use cosfly_domain::OrientedBox;
use cosfly_frames::DVec3;

/// Queries of plugins to a town. World frame, metres.
pub trait TownView: Send + Sync {
    /// Where the straight way between two points first meets an obstacle, as a share of the way; `None` where it is free.
    fn first_hit(&self, from: DVec3, to: DVec3) -> Option<f64>;
    /// Distance to the nearest obstacle, at most `within_m`; negative inside one.
    fn distance_m(&self, point: DVec3, within_m: f64) -> f64;
    /// Height of the ground; `None` where there is none.
    fn ground_m(&self, x_m: f64, y_m: f64) -> Option<f64>;
    /// The boxes of all buildings with their buildings' numbers; those of one building follow each other.
    fn buildings(&self) -> Vec<(u32, OrientedBox)>;
}

/// An endless empty plain at height 0: where plugins are checked without a town.
pub struct NoTown;

impl TownView for NoTown {
    fn first_hit(&self, _: DVec3, _: DVec3) -> Option<f64> {
        None
    }

    fn distance_m(&self, _: DVec3, within_m: f64) -> f64 {
        within_m
    }

    fn ground_m(&self, _: f64, _: f64) -> Option<f64> {
        Some(0.0)
    }

    fn buildings(&self) -> Vec<(u32, OrientedBox)> {
        Vec::new()
    }
}
