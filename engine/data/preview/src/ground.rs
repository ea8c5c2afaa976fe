//! The ground as the camera saw it: labels of pixels brought back to the plane through their depths.

use cosfly_domain::SemanticLabel;
use cosfly_frames::DVec3;
use cosfly_plot::canvas::ChartColour;
use cosfly_read::{LoggedFrame, PublishedFlight};
use std::collections::BTreeMap;

/// Side of a cell, metres.
pub const CELL_M: f64 = 0.25;
/// Pixels whose place is looked at, per frame and axis.
const SAMPLES: usize = 420;
/// Ground that is farther away is left out: a pixel covers too much of it.
const REACH_M: f32 = 90.0;

/// Labelled cells of the ground.
#[derive(Default)]
pub struct SeenGround {
    /// By column and row of the world's x and y: the label seen from nearest, and from how near.
    cells: BTreeMap<(i32, i32), (f32, u8)>,
}

impl SeenGround {
    /// Adds what one frame shows.
    pub fn add(&mut self, flight: &PublishedFlight, frame: &LoggedFrame) {
        let (width, height) = (frame.width as usize, frame.height as usize);
        let step = |side: usize| (side / SAMPLES).max(1);
        for v in (0..height).step_by(step(height)) {
            for u in (0..width).step_by(step(width)) {
                let at = v * width + u;
                let (depth, label) = (frame.depth_m[at], frame.semantic[at]);
                if depth > REACH_M || colour(label).is_none() {
                    continue;
                }
                let seen = (u as f64 + 0.5, v as f64 + 0.5);
                let Some(ray) = flight.lens.ray(&flight.camera, seen) else { continue };
                let ray = frame.map_from_optical * DVec3::new(ray.y, -ray.z, ray.x);
                let point = frame.camera_in_map + ray * f64::from(depth);
                // The map's y is minus the world's.
                let cell = [point.x / CELL_M, -point.y / CELL_M].map(|it| it.floor() as i32);
                let nearest = self.cells.entry((cell[0], cell[1])).or_insert((f32::INFINITY, label));
                if depth < nearest.0 {
                    *nearest = (depth, label);
                }
            }
        }
    }

    /// The colour at a point of the world, if it or a neighbour was seen.
    pub fn colour_at(&self, x_m: f64, y_m: f64) -> Option<ChartColour> {
        const AROUND: [(i32, i32); 9] = [(0, 0), (1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (-1, -1), (1, -1), (-1, 1)];
        let (column, row) = ((x_m / CELL_M).floor() as i32, (y_m / CELL_M).floor() as i32);
        let found = AROUND.iter().find_map(|(dx, dy)| self.cells.get(&(column + dx, row + dy)));
        found.and_then(|(_, label)| colour(*label))
    }
}

/// The plan's colour of a label of the ground; none for what stands on it.
fn colour(label: u8) -> Option<ChartColour> {
    Some(match SemanticLabel::ALL.get(usize::from(label))? {
        SemanticLabel::Roads => [150, 152, 158],
        SemanticLabel::RoadLine => [236, 236, 230],
        SemanticLabel::SideWalks => [205, 200, 190],
        SemanticLabel::Terrain => [176, 196, 150],
        SemanticLabel::Ground | SemanticLabel::Other => [214, 206, 188],
        SemanticLabel::Water => [150, 185, 214],
        SemanticLabel::RailTrack | SemanticLabel::Bridge => [180, 170, 165],
        _ => return None,
    })
}
