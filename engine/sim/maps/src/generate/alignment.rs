//! Reference lines of generated roads: lines, arcs and spirals put end to end. Right-handed map frame, y north.

use cosfly_frames::{DVec2, real};

/// A point with a direction, map frame: metres and radians, counter-clockwise from east.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose2 {
    /// Position.
    pub at: DVec2,
    /// Direction.
    pub heading_rad: f64,
}

impl Pose2 {
    /// Unit vector ahead.
    pub fn ahead(&self) -> DVec2 {
        let (sin, cos) = real::sin_cos(self.heading_rad);
        DVec2::new(cos, sin)
    }

    /// Unit vector to the left.
    pub fn left(&self) -> DVec2 {
        self.ahead().perp()
    }

    /// Moved `ahead_m` forward and `left_m` to the left, with the same direction.
    pub fn moved(&self, ahead_m: f64, left_m: f64) -> Self {
        Self { at: self.at + ahead_m * self.ahead() + left_m * self.left(), heading_rad: self.heading_rad }
    }
}

/// Kinds of pieces; curvature is positive to the left, 1/m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Curve {
    /// Straight.
    Line,
    /// Constant curvature.
    Arc {
        /// 1/radius.
        curvature: f64,
    },
    /// Curvature that changes linearly.
    Spiral {
        /// At the start.
        start: f64,
        /// At the end.
        end: f64,
    },
}

/// One piece of a reference line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// First point and direction.
    pub start: Pose2,
    /// Length along the line, metres.
    pub length_m: f64,
    /// Shape of the curve.
    pub curve: Curve,
}

impl Piece {
    fn heading_at(&self, s_m: f64) -> f64 {
        let turned = match self.curve {
            Curve::Line => 0.0,
            Curve::Arc { curvature } => curvature * s_m,
            Curve::Spiral { start, end } => start * s_m + 0.5 * (end - start) / self.length_m * s_m * s_m,
        };
        self.start.heading_rad + turned
    }

    fn pose_at(&self, s_m: f64) -> Pose2 {
        // Spirals by composite Simpson over the heading: far below a micrometre for the gentle turns of streets.
        const STEPS: usize = 64;
        let heading_rad = self.heading_at(s_m);
        match self.curve {
            Curve::Line => return self.start.moved(s_m, 0.0),
            Curve::Arc { curvature } => {
                let to_center = self.start.left() / curvature;
                let end = Pose2 { at: DVec2::ZERO, heading_rad };
                return Pose2 { at: self.start.at + to_center - end.left() / curvature, heading_rad };
            }
            Curve::Spiral { .. } => {}
        }
        let step = s_m / STEPS as f64;
        let sum = (0..=STEPS).fold(DVec2::ZERO, |sum, i| {
            let weight = if i == 0 || i == STEPS { 1.0 } else { [2.0, 4.0][i % 2] };
            let (sin, cos) = real::sin_cos(self.heading_at(i as f64 * step));
            sum + weight * DVec2::new(cos, sin)
        });
        Pose2 { at: self.start.at + sum * (step / 3.0), heading_rad }
    }
}

/// A whole reference line.
#[derive(Clone, Debug, PartialEq)]
pub struct Alignment {
    start: Pose2,
    /// Pieces, end to end.
    pub pieces: Vec<Piece>,
}

impl Alignment {
    fn from(start: Pose2) -> Self {
        Self { start, pieces: Vec::new() }
    }

    fn then(mut self, curve: Curve, length_m: f64) -> Self {
        if length_m > 1e-9 {
            self.pieces.push(Piece { start: self.end(), length_m, curve });
        }
        self
    }

    /// Straight on for `length_m`.
    pub fn straight(start: Pose2, length_m: f64) -> Self {
        Self::from(start).then(Curve::Line, length_m)
    }

    /// Sideways by `left_m` over `ahead_m`, leaving as it came: four spirals of one length between straight leads.
    pub fn sideways_by_spirals(start: Pose2, ahead_m: f64, left_m: f64, lead_m: f64) -> Self {
        let shape = |turn: f64, spiral_m: f64, from: Pose2| {
            let k = turn / spiral_m;
            [(0.0, k), (k, 0.0), (0.0, -k), (-k, 0.0)]
                .into_iter()
                .fold(Self::from(from), |line, (start, end)| line.then(Curve::Spiral { start, end }, spiral_m))
        };
        let curved_m = ahead_m - 2.0 * lead_m;
        let origin = Pose2 { at: DVec2::ZERO, heading_rad: 0.0 };
        let slope_of = |turn: f64| {
            let end = shape(turn, 1.0, origin).end().at;
            end.y / end.x
        };
        let turn = bisect(0.0, 1.2, left_m.abs() / curved_m, slope_of) * left_m.signum();
        let spiral_m = curved_m / shape(turn, 1.0, origin).end().at.x;
        let mut line = Self::straight(start, lead_m);
        let curve = shape(turn, spiral_m, line.end());
        line.pieces.extend(curve.pieces);
        line.then(Curve::Line, lead_m)
    }

    /// Sideways by `left_m` over `ahead_m`, leaving as it came: two opposite arcs between straight leads.
    pub fn sideways_by_arcs(start: Pose2, ahead_m: f64, left_m: f64, lead_m: f64) -> Self {
        let curved_m = ahead_m - 2.0 * lead_m;
        let turn = 2.0 * real::atan2(left_m, curved_m);
        let radius_m = curved_m / (2.0 * real::sin(turn.abs()).max(1e-12));
        let curvature = turn.signum() / radius_m;
        let arc_m = radius_m * turn.abs();
        Self::straight(start, lead_m)
            .then(Curve::Arc { curvature }, arc_m)
            .then(Curve::Arc { curvature: -curvature }, arc_m)
            .then(Curve::Line, lead_m)
    }

    /// A quarter turn into a place `ahead_m` ahead and `side_m` to the side (left when `left`): lines, an arc, and on
    /// either side of it a spiral that turns by `spiral_rad`. The curve takes at most `leg_m` of either leg.
    pub fn quarter_turn(start: Pose2, ahead_m: f64, side_m: f64, left: bool, leg_m: f64, spiral_rad: f64) -> Self {
        let sign = if left { 1.0 } else { -1.0 };
        let shape = |radius_m: f64, from: Pose2| {
            let k = sign / radius_m;
            let spiral_m = 2.0 * spiral_rad * radius_m;
            Self::from(from)
                .then(Curve::Spiral { start: 0.0, end: k }, spiral_m)
                .then(Curve::Arc { curvature: k }, (real::FRAC_PI_2 - 2.0 * spiral_rad) * radius_m)
                .then(Curve::Spiral { start: k, end: 0.0 }, spiral_m)
        };
        let leg_m = leg_m.min(ahead_m).min(side_m);
        let unit_leg_m = shape(1.0, Pose2 { at: DVec2::ZERO, heading_rad: 0.0 }).end().at.x;
        let mut line = Self::straight(start, ahead_m - leg_m);
        let curve = shape(leg_m / unit_leg_m, line.end());
        line.pieces.extend(curve.pieces);
        line.then(Curve::Line, side_m - leg_m)
    }

    /// Length along the line.
    pub fn length_m(&self) -> f64 {
        self.pieces.iter().map(|piece| piece.length_m).sum()
    }

    /// Last point and direction.
    pub fn end(&self) -> Pose2 {
        self.pieces.last().map_or(self.start, |piece| piece.pose_at(piece.length_m))
    }

    /// The pose at `s_m` along the line (clamped to its ends).
    pub fn pose_at(&self, s_m: f64) -> Pose2 {
        let mut left_m = s_m.max(0.0);
        for piece in &self.pieces {
            if left_m <= piece.length_m {
                return piece.pose_at(left_m);
            }
            left_m -= piece.length_m;
        }
        self.end()
    }

    /// Whether it is one straight line.
    pub fn is_straight(&self) -> bool {
        self.pieces.iter().all(|piece| piece.curve == Curve::Line)
    }
}

/// Argument at which the growing `function` takes `value`.
fn bisect(mut low: f64, mut high: f64, value: f64, function: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if function(middle) < value {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check_ends_at(line: &Alignment, at: DVec2, heading_rad: f64) {
        let end = line.end();
        assert!((end.at - at).length() < 1e-9, "{end:?} instead of {at}");
        assert!(real::wrap_angle_rad(end.heading_rad - heading_rad).abs() < 1e-12, "{end:?}");
        for pair in line.pieces.windows(2) {
            assert!((pair[0].pose_at(pair[0].length_m).at - pair[1].start.at).length() < 1e-12);
        }
        assert!((line.pose_at(line.length_m()).at - at).length() < 1e-9);
    }

    #[test]
    fn curves_end_where_they_were_sent() {
        let start = Pose2 { at: DVec2::new(3.0, -2.0), heading_rad: 0.7 };
        for left_m in [9.0, -14.0] {
            let goal = start.moved(50.0, left_m);
            check_ends_at(&Alignment::sideways_by_spirals(start, 50.0, left_m, 5.0), goal.at, 0.7);
            check_ends_at(&Alignment::sideways_by_arcs(start, 50.0, left_m, 5.0), goal.at, 0.7);
        }
        for (left, sign) in [(true, 1.0), (false, -1.0)] {
            let goal = start.moved(60.0, 55.0 * sign);
            let heading = 0.7 + sign * real::FRAC_PI_2;
            check_ends_at(&Alignment::quarter_turn(start, 60.0, 55.0, left, 45.0, 0.25), goal.at, heading);
            check_ends_at(&Alignment::quarter_turn(start, 60.0, 55.0, left, 100.0, 0.0), goal.at, heading);
        }
    }
}
