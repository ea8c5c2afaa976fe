//! Bounds of a body and of all that it may darken or light, in the world and on the screen.

use crate::shade::headlights;
use cosfly_figures::BodyFigure;
use cosfly_frames::{DVec2, DVec3};
use cosfly_materials::far_light::FarLight;
use cosfly_raster::eye::Eye;
use cosfly_raster::nearer::Nearer;
use cosfly_raster::visibility::{NEAR_M, Screen};
use std::ops::Range;

/// Shadows are looked for on ground that lies at most this far below the feet, metres.
const DROP_M: f64 = 8.0;
/// Shading looks this far around a point, metres.
const MARGIN_M: f64 = 0.5;
/// People whose bodies are less high than this are left out, pixels.
pub const LEAST_HEIGHT_PX: f64 = 1.0;

/// A part of the screen: left, top, right and bottom edge, pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Reach(pub [f64; 4]);

impl Reach {
    pub const EVERYWHERE: Self = Self([f64::NEG_INFINITY, f64::NEG_INFINITY, f64::INFINITY, f64::INFINITY]);
    pub const NOWHERE: Self = Self([f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY]);

    /// Around points in body axes; everywhere, when one is not ahead of the camera.
    fn around(screen: &Screen, points: impl Iterator<Item = DVec3>) -> Self {
        let mut edges = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
        for point in points {
            if point.x < NEAR_M || !point.is_finite() {
                return Self::EVERYWHERE;
            }
            let [u, v] = screen.point(point);
            edges = [edges[0].min(u), edges[1].min(v), edges[2].max(u), edges[3].max(v)];
        }
        Self(edges)
    }

    /// First column and row of pixels that it holds any part of, and the ones past the last.
    pub fn pixels(&self) -> [i32; 4] {
        let [left, top, right, bottom] = self.0;
        [left.floor() as i32, top.floor() as i32, right.ceil() as i32, bottom.ceil() as i32]
    }

    /// Whether it holds a pixel of these rows.
    pub fn meets_rows(&self, rows: Range<usize>) -> bool {
        self.0[1] < rows.end as f64 && self.0[3] > rows.start as f64
    }
}

/// An upright box around a body, its shadow left out.
pub(crate) struct Bounds {
    low: DVec3,
    high: DVec3,
    foot_m: f64,
    /// Ground that its lamps light, from the body on: along x and y to either side, metres.
    lit_m: [DVec2; 2],
}

impl Bounds {
    pub fn new(figure: &BodyFigure) -> Self {
        let (low, high) = figure.bounds_in_world();
        Self { low, high, foot_m: figure.state.feet_in_world.z, lit_m: headlights::reach_m(figure) }
    }

    pub fn is_in_view(&self, eye: &Eye, screen: &Screen) -> bool {
        eye.order_if_seen(screen, 0.5 * (self.low + self.high), 0.5 * (self.high - self.low)).is_some()
    }

    pub fn height_px(&self, figure: &BodyFigure, eye: &Eye, screen: &Screen) -> f64 {
        let away_m = (eye.position_in_world - eye.position_in_world.clamp(self.low, self.high)).length();
        screen.focal_px * figure.body.height_m(figure.height_m) / away_m.max(NEAR_M)
    }

    /// Whether the body is large enough to be drawn, and it, its shadow or the light of its lamps may be in view.
    pub fn may_matter(&self, figure: &BodyFigure, eye: &Eye, screen: &Screen, far: FarLight) -> bool {
        self.height_px(figure, eye, screen) >= LEAST_HEIGHT_PX && self.with_shadow(far).is_in_view(eye, screen)
    }

    /// Way along the sun's rays down to the lowest ground that counts.
    fn fall(&self, from_m: f64, to_sun: DVec3) -> DVec3 {
        Self::fall_to(self.foot_m - DROP_M, from_m, to_sun)
    }

    /// Way along the sun's rays from one height down to another, metres.
    fn fall_to(lowest_m: f64, from_m: f64, to_sun: DVec3) -> DVec3 {
        -to_sun * ((from_m - lowest_m).max(0.0) / to_sun.z.max(0.02))
    }

    /// The box and the ground that its lamps light.
    fn with_lamps(&self, far: FarLight) -> Self {
        let [before, beyond] = if far.is_night { self.lit_m } else { [DVec2::ZERO; 2] };
        Self { low: self.low - before.extend(0.0), high: self.high + beyond.extend(0.0), ..*self }
    }

    pub fn with_shadow(&self, far: FarLight) -> Self {
        let (below, tip) = (self.fall(self.low.z, far.to_sun), self.fall(self.high.z, far.to_sun));
        let lit = self.with_lamps(far);
        Self {
            low: lit.low.min(self.low + below).min(self.low + tip),
            high: lit.high.max(self.high + below).max(self.high + tip),
            ..*self
        }
    }

    fn corners(&self, margin_m: f64) -> impl Iterator<Item = DVec3> {
        let ends = [self.low - margin_m, self.high + margin_m];
        (0..8).map(move |k| DVec3::new(ends[k & 1].x, ends[k >> 1 & 1].y, ends[k >> 2].z))
    }

    /// The body and all that it may darken or light: its box, and the same box at the end of the sun's rays.
    pub fn reach(&self, eye: &Eye, screen: &Screen, far: FarLight) -> Reach {
        let lit = self.with_lamps(far);
        let corners = lit.corners(MARGIN_M).flat_map(|corner| [corner, corner + self.fall(corner.z, far.to_sun)]);
        Reach::around(screen, corners.map(|corner| eye.see(corner)))
    }

    /// Corners of a hull of the body and all that it may darken or light above `lowest_m`.
    pub fn hull(&self, lowest_m: f64, far: FarLight) -> [DVec3; 16] {
        let lowest_m = lowest_m.max(self.foot_m - DROP_M);
        let mut hull = [DVec3::ZERO; 16];
        for (pair, corner) in hull.chunks_exact_mut(2).zip(self.with_lamps(far).corners(MARGIN_M)) {
            pair.copy_from_slice(&[corner, corner + Self::fall_to(lowest_m - MARGIN_M, corner.z, far.to_sun)]);
        }
        hull
    }

    pub fn is_hidden(&self, eye: &Eye, screen: &Screen, drawn: &Nearer) -> bool {
        let Reach([left, top, right, bottom]) = Reach::around(screen, self.corners(0.0).map(|corner| eye.see(corner)));
        let nearest_m = self.corners(0.0).map(|corner| eye.see(corner).x).fold(f64::INFINITY, f64::min);
        nearest_m >= NEAR_M && drawn.hides([left, top], [right, bottom], 1.0 / nearest_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_domain::{BodyKind, Camera};
    use cosfly_figures::{BodyShape, Posture, figure_triangles};
    use cosfly_frames::{Pose, Seed, TargetState};

    #[test]
    fn a_body_and_its_shadow_stay_within_reach() {
        let camera = Camera { width: 640, height: 480, horizontal_fov_rad: 1.4 };
        let screen = Screen::new(&camera);
        let eye = Eye::new(&Pose::looking_at(DVec3::new(-12.0, 3.0, 9.0), DVec3::new(0.0, 0.0, 1.0)));
        for step in 0..24 {
            let turn = f64::from(step) * 0.7;
            let figure = BodyFigure {
                state: TargetState { feet_in_world: DVec3::new(0.3, -1.0, 0.2), heading_rad: turn, speed_mps: 1.6 },
                height_m: 1.8,
                radius_m: 0.3,
                clothes_seed: Seed([step as u8; 32]),
                gait_phase_rad: 1.3 * turn,
                body: match step % 3 {
                    0 => BodyShape::Person { umbrella: step % 2 == 0, posture: Posture::Upright },
                    1 => BodyShape::Vehicle { kind: BodyKind::Bus, size_m: DVec3::new(5.0, 2.5, 3.0) },
                    _ => BodyShape::Vehicle { kind: BodyKind::Bicycle, size_m: DVec3::new(1.8, 0.65, 1.75) },
                },
            };
            let to_sun = DVec3::new(libm::cos(turn), libm::sin(turn), 0.3 + 0.1 * turn).normalize();
            let bounds = Bounds::new(&figure);
            let far = FarLight { to_sun, is_night: step % 2 == 0 };
            let Reach([left, top, right, bottom]) = bounds.reach(&eye, &screen, far);
            let shaded = bounds.with_shadow(far);
            for corner in figure_triangles(&figure).into_iter().flatten() {
                let tip = corner - to_sun * ((corner.z + 1.0) / to_sun.z);
                for point in [corner, 0.5 * (corner + tip), tip] {
                    let [u, v] = screen.point(eye.see(point));
                    assert!((left..right).contains(&u) && (top..bottom).contains(&v), "{step}: {u} {v}");
                    assert!(point.cmpge(shaded.low - 1e-9).all() && point.cmple(shaded.high + 1e-9).all(), "{step}");
                }
            }
        }
    }

    #[test]
    fn reach_is_tested_by_pixels() {
        let reach = Reach([10.5, 4.0, 20.0, 6.5]);
        assert!(reach.meets_rows(6..7) && !reach.meets_rows(7..9) && !reach.meets_rows(0..4));
        assert_eq!(reach.pixels(), [10, 4, 20, 7]);
        assert!(Reach::EVERYWHERE.meets_rows(0..1));
        assert_eq!(Reach::EVERYWHERE.pixels(), [i32::MIN, i32::MIN, i32::MAX, i32::MAX]);
    }
}
