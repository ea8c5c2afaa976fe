//! The reference line in plan: line, arc, spiral, poly3, paramPoly3 (OpenDRIVE `<planView>`), map frame.

use super::quadrature::integrate;
use cosfly_frames::{DVec2, real};

/// A point of the reference line, map frame (right-handed, y to the north).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanPoint {
    /// Position, metres.
    pub position_in_map: DVec2,
    /// Direction of growing s, counter-clockwise from x, radians.
    pub heading_rad: f64,
}

/// One `<geometry>` record.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanElement {
    /// Start along the road, metres.
    pub start_s_m: f64,
    /// Length, metres.
    pub length_m: f64,
    /// First point.
    pub start: PlanPoint,
    /// Shape of the curve.
    pub curve: Curve,
}

/// The curve of a `<geometry>` record, in the frame of its first point.
#[derive(Clone, Debug, PartialEq)]
pub enum Curve {
    /// Straight.
    Line,
    /// Constant curvature, 1/m, positive to the left.
    Arc {
        /// 1/m.
        curvature_per_m: f64,
    },
    /// Curvature that changes linearly with arc length (clothoid).
    Spiral {
        /// At the start, 1/m.
        start_per_m: f64,
        /// At the end, 1/m.
        end_per_m: f64,
    },
    /// `u(p)`, `v(p)` cubic; `p` is found from the true arc length, whatever `pRange` says about its range:
    /// polynomials only come near unit speed, and s is an arc length. (CARLA and esmini do the same.)
    Cubic {
        /// Coefficients of u.
        u: [f64; 4],
        /// Coefficients of v.
        v: [f64; 4],
        /// Arc length at equally spaced values of the parameter.
        table: ArcLengthTable,
    },
}

/// Arc length of a parametric cubic, to find the parameter of a length.
#[derive(Clone, Debug, PartialEq)]
pub struct ArcLengthTable {
    parameter_end: f64,
    /// The parameter runs from 0 to 1 over the element, not over a length.
    parameter_is_share: bool,
    lengths_m: Vec<f64>,
}

/// Difference between stated and own length, as a share, from which the own one counts.
const LENGTH_MISMATCH: f64 = 1e-3;

const TABLE_STEPS: usize = 64;

impl ArcLengthTable {
    /// The table of a curve for parameters 0 to `parameter_end`.
    fn new(u: &[f64; 4], v: &[f64; 4], parameter_end: f64, parameter_is_share: bool) -> Self {
        let mut lengths_m = vec![0.0];
        for step in 0..TABLE_STEPS {
            let (from, to) = (fraction(step, parameter_end), fraction(step + 1, parameter_end));
            lengths_m.push(lengths_m[step] + arc_length(u, v, from, to));
        }
        Self { parameter_end, parameter_is_share, lengths_m }
    }

    /// The whole length, metres.
    fn total_m(&self) -> f64 {
        self.lengths_m[TABLE_STEPS]
    }

    /// The parameter at which the curve is `length_m` long.
    fn parameter(&self, u: &[f64; 4], v: &[f64; 4], length_m: f64) -> f64 {
        let step = self.lengths_m.partition_point(|known| *known <= length_m).clamp(1, TABLE_STEPS) - 1;
        let (from, to) = (fraction(step, self.parameter_end), fraction(step + 1, self.parameter_end));
        let part_m = self.lengths_m[step + 1] - self.lengths_m[step];
        let wanted_m = length_m - self.lengths_m[step];
        if part_m <= 0.0 {
            return from;
        }
        let mut p = from + (to - from) * (wanted_m / part_m);
        for _ in 0..4 {
            let speed = speed(u, v, p);
            if speed <= 0.0 {
                break;
            }
            p = (p - (arc_length(u, v, from, p) - wanted_m) / speed).clamp(from, to);
        }
        p
    }
}

fn fraction(step: usize, parameter_end: f64) -> f64 {
    parameter_end * (step as f64 / TABLE_STEPS as f64)
}

fn arc_length(u: &[f64; 4], v: &[f64; 4], from: f64, to: f64) -> f64 {
    integrate(from, to, 1, |p| (speed(u, v, p), 0.0)).0
}

fn speed(u: &[f64; 4], v: &[f64; 4], p: f64) -> f64 {
    real::hypot(derivative(u, p), derivative(v, p))
}

fn cubic(c: &[f64; 4], p: f64) -> f64 {
    c[0] + p * (c[1] + p * (c[2] + p * c[3]))
}

fn derivative(c: &[f64; 4], p: f64) -> f64 {
    c[1] + p * (2.0 * c[2] + p * 3.0 * c[3])
}

impl Curve {
    /// `<poly3>`: v over u, u found from the arc length.
    pub fn poly3(v: [f64; 4], length_m: f64) -> Self {
        // The arc is never shorter than its extent along u, so u stays within the length.
        let u = [0.0, 1.0, 0.0, 0.0];
        Self::Cubic { u, v, table: ArcLengthTable::new(&u, &v, length_m, false) }
    }

    /// `<paramPoly3 pRange="normalized">`: parameter 0 to 1 over the element.
    pub fn normalized(u: [f64; 4], v: [f64; 4]) -> Self {
        Self::Cubic { u, v, table: ArcLengthTable::new(&u, &v, 1.0, true) }
    }

    /// `<paramPoly3 pRange="arcLength">`: parameter 0 to about the length of the element.
    pub fn by_arc_length(u: [f64; 4], v: [f64; 4], length_m: f64) -> Self {
        Self::Cubic { u, v, table: ArcLengthTable::new(&u, &v, 1.05 * length_m, false) }
    }

    /// True length of a normalized curve, to compare with the record's `length`; `None` for other kinds.
    pub fn own_length_m(&self) -> Option<f64> {
        match self {
            Self::Cubic { table, .. } if table.parameter_is_share => Some(table.total_m()),
            _ => None,
        }
    }

    /// (u, v, turn) after `ds_m` of an element of `length_m`.
    fn at(&self, ds_m: f64, length_m: f64) -> (f64, f64, f64) {
        match self {
            Self::Line => (ds_m, 0.0, 0.0),
            Self::Arc { curvature_per_m } => arc(*curvature_per_m, ds_m),
            Self::Spiral { start_per_m, end_per_m } => {
                let rate = if length_m > 0.0 { (end_per_m - start_per_m) / length_m } else { 0.0 };
                clothoid(*start_per_m, rate, ds_m)
            }
            Self::Cubic { u, v, table } => {
                // A curve whose length in the file is clearly wrong still ends at its own end, so that no gap opens.
                let share = if table.parameter_is_share && length_m > 0.0 { table.total_m() / length_m } else { 1.0 };
                let scale = if (share - 1.0).abs() > LENGTH_MISMATCH { share } else { 1.0 };
                cubic_point(u, v, table.parameter(u, v, ds_m * scale))
            }
        }
    }
}

fn cubic_point(u: &[f64; 4], v: &[f64; 4], p: f64) -> (f64, f64, f64) {
    (cubic(u, p), cubic(v, p), real::atan2(derivative(v, p), derivative(u, p)))
}

fn arc(curvature_per_m: f64, ds_m: f64) -> (f64, f64, f64) {
    let turn = curvature_per_m * ds_m;
    // sin(x)/x and (1 - cos x)/x without cancellation for nearly straight arcs.
    let half_sin = real::sin(0.5 * turn);
    let along = if turn.abs() < 1e-9 { ds_m } else { real::sin(turn) / curvature_per_m };
    let across = if turn.abs() < 1e-9 { 0.5 * turn * ds_m } else { 2.0 * half_sin * half_sin / curvature_per_m };
    (along, across, turn)
}

/// `integral of (cos, sin)(k0 t + c t^2 / 2)` from 0 to `ds`: one quadrature panel for each radian of turning.
fn clothoid(start_per_m: f64, rate_per_m2: f64, ds_m: f64) -> (f64, f64, f64) {
    const PANELS_AT_MOST: f64 = 4096.0;
    let swing = start_per_m.abs() * ds_m + 0.5 * rate_per_m2.abs() * ds_m * ds_m;
    let panels = swing.ceil().clamp(1.0, PANELS_AT_MOST) as usize;
    let turn = |t: f64| t * (start_per_m + 0.5 * rate_per_m2 * t);
    let (u, v) = integrate(0.0, ds_m, panels, |t| {
        let (sin, cos) = real::sin_cos(turn(t));
        (cos, sin)
    });
    (u, v, turn(ds_m))
}

impl PlanElement {
    /// The point at `s` along the road, held to the element's own range.
    pub fn at(&self, s_m: f64) -> PlanPoint {
        let (u, v, turn) = self.curve.at((s_m - self.start_s_m).clamp(0.0, self.length_m), self.length_m);
        let (sin, cos) = real::sin_cos(self.start.heading_rad);
        PlanPoint {
            position_in_map: self.start.position_in_map + DVec2::new(cos * u - sin * v, sin * u + cos * v),
            heading_rad: self.start.heading_rad + turn,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn element(length_m: f64, curve: Curve) -> PlanElement {
        let start = PlanPoint { position_in_map: DVec2::new(5.0, -3.0), heading_rad: 0.4 };
        PlanElement { start_s_m: 2.0, length_m, start, curve }
    }

    /// Place at `s_m` of the curve, by many small straight steps along the heading, metres.
    fn walked(element: &PlanElement, s_m: f64) -> DVec2 {
        let steps = 40_000;
        let step_m = (s_m - element.start_s_m) / f64::from(steps);
        (0..steps).fold(element.start.position_in_map, |position, i| {
            let (sin, cos) = real::sin_cos(element.at(element.start_s_m + (f64::from(i) + 0.5) * step_m).heading_rad);
            position + step_m * DVec2::new(cos, sin)
        })
    }

    #[test]
    fn every_curve_has_unit_speed_along_its_heading() {
        let bend = [0.0, 1.0, 0.0, -1e-5];
        for (name, curve, length_m) in [
            ("line", Curve::Line, 80.0),
            ("arc", Curve::Arc { curvature_per_m: -0.03 }, 80.0),
            ("nearly straight arc", Curve::Arc { curvature_per_m: 1e-12 }, 80.0),
            ("spiral", Curve::Spiral { start_per_m: -0.02, end_per_m: 0.05 }, 80.0),
            ("tight spiral", Curve::Spiral { start_per_m: 0.0, end_per_m: 1.0 }, 60.0),
            ("poly3", Curve::poly3([0.0, 0.0, 0.01, -1e-4], 40.0), 40.0),
            ("normalized", Curve::normalized([0.0, 50.0, 0.0, -2.0], [0.0, 0.0, 20.0, -5.0]), 0.0),
            ("arc length", Curve::by_arc_length(bend, [0.0, 0.0, 0.01, 0.0], 20.0), 20.0),
        ] {
            let length_m = curve.own_length_m().unwrap_or(length_m);
            let element = element(length_m, curve);
            for share in [0.25, 0.7, 1.0] {
                let s_m = element.start_s_m + share * length_m;
                let error_m = element.at(s_m).position_in_map.distance(walked(&element, s_m));
                // The walk itself is good to about 1e-6 on the tight spiral.
                assert!(error_m < 2e-6, "{name} at {share}: {error_m}");
            }
        }
    }

    #[test]
    fn clothoids_match_the_fresnel_integrals() {
        // C(1.5) and S(1.5) with the pi/2 convention; t = x sqrt(pi/2), curvature 2 t.
        let scale = (0.5 * real::PI).sqrt();
        let length_m = 1.5 / scale * (0.5 * real::PI);
        let (u, v, _) = clothoid(0.0, 2.0, length_m);
        assert!((u / scale - 0.445_261_176_039_821_5).abs() < 1e-12, "{u}");
        assert!((v / scale - 0.697_504_960_082_093_1).abs() < 1e-12, "{v}");
    }

    #[test]
    fn a_normalized_curve_ends_at_its_end_when_its_stated_length_is_wrong() {
        let curve = Curve::normalized([0.0, 10.0, 0.0, 0.0], [0.0; 4]);
        let element = element(10.2, curve);
        let end = element.at(2.0 + 10.2).position_in_map;
        assert!((end.distance(element.start.position_in_map) - 10.0).abs() < 1e-12);
    }
}
