//! Solid boxes of things that a map gives by their outline and heights.

use crate::cover::cover_polygon;
use cosfly_frames::DVec2;
use cosfly_geometry::OrientedBox;

/// Ground that a building covers, plan view in the world frame, metres. Rings either way round, first corner not repeated.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Footprint {
    /// Outer ring.
    pub outer: Vec<DVec2>,
    /// Courtyards.
    pub holes: Vec<Vec<DVec2>>,
}

/// Shape of a roof above the eaves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Roof {
    /// Level.
    #[default]
    Flat,
    /// Two planes that meet in a ridge along `ridge_yaw_rad` (x towards y); none means along the longer side.
    Gabled {
        /// Ridge above the eaves, metres.
        rise_m: f64,
        /// Direction of the ridge, radians.
        ridge_yaw_rad: Option<f64>,
    },
    /// Planes that rise from every wall.
    Hipped {
        /// Highest point above the eaves, metres.
        rise_m: f64,
    },
}

/// Boxes whose union covers a building from `base_m` to its roof, heights in the world frame, metres.
pub fn building_boxes(footprint: &Footprint, base_m: f64, eaves_m: f64, roof: Roof) -> Vec<OrientedBox> {
    let top_m = match roof {
        Roof::Flat => eaves_m,
        Roof::Gabled { rise_m, .. } | Roof::Hipped { rise_m } => eaves_m + rise_m,
    };
    let half_height_m = 0.5 * (top_m - base_m);
    let boxes = cover_polygon(&footprint.outer).into_iter().map(|rectangle| OrientedBox {
        center_in_world: rectangle.center.extend(base_m + half_height_m),
        half_extents_m: rectangle.half_extents_m.extend(half_height_m),
        yaw_rad: rectangle.yaw_rad,
    });
    boxes.collect()
}
