//! Upright boxes around figures, for who is in view and who may hide whom.

use crate::body_figure::BodyFigure;
use crate::body_shape::BodyShape;
use cosfly_frames::DVec3;

/// Limbs swing this far from the upright axis, in body heights.
const REACH_PER_HEIGHT: f64 = 0.45;
/// Umbrellas end below this height, in body heights.
const UMBRELLA_PER_HEIGHT: f64 = 1.25;
/// Vehicles stay within their boxes and this margin, metres.
const VEHICLE_MARGIN_M: f64 = 0.02;

impl BodyFigure {
    /// Lowest and highest corner of an upright box around the figure, in the world frame, metres.
    pub fn bounds_in_world(&self) -> (DVec3, DVec3) {
        let feet = self.state.feet_in_world;
        if let BodyShape::Vehicle { size_m, .. } = self.body {
            let half = BodyShape::half_bounds_m(size_m, self.state.heading_rad) + VEHICLE_MARGIN_M;
            return ((feet - half).with_z(feet.z - VEHICLE_MARGIN_M), (feet + half).with_z(feet.z + 2.0 * half.z));
        }
        let side = (REACH_PER_HEIGHT * self.height_m).max(3.0 * self.radius_m.clamp(0.1, 2.0));
        let top = if self.body.has_umbrella() { UMBRELLA_PER_HEIGHT } else { 1.05 };
        let (below, above) = (0.05 * self.height_m, top * self.height_m);
        (feet - DVec3::new(side, side, below), feet + DVec3::new(side, side, above))
    }
}
