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

    /// From `start` to `goal` over the point where their directions meet: lines and one arc.
    pub fn corner(start: Pose2, goal: Pose2) -> Self {
        let (ahead, onward) = (start.ahead(), goal.ahead());
        let (reach, turn_rad) = (goal.at - start.at, real::wrap_angle_rad(goal.heading_rad - start.heading_rad));
        if turn_rad.abs() < 1e-6 {
            return Self::straight(start, reach.dot(ahead));
        }
        let crossed = ahead.perp_dot(onward);
        let legs_m = [reach.perp_dot(onward) / crossed, ahead.perp_dot(reach) / crossed];
        let tangent_m = legs_m[0].min(legs_m[1]);
        Self::straight(start, legs_m[0] - tangent_m)
            .turned(turn_rad, tangent_m)
            .then(Curve::Line, legs_m[1] - tangent_m)
    }

    /// Straight from point to point, each turn an arc of at most `radius_m`; both ends are given without their first
    /// and last metres.
    pub fn through(points: &[DVec2], cut_m: [f64; 2], radius_m: f64) -> Self {
        let legs: Vec<DVec2> = points.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let last = legs.len() - 1;
        let free_m = |leg: usize| {
            let cut_m = if leg == 0 { cut_m[0] } else { 0.0 } + if leg == last { cut_m[1] } else { 0.0 };
            legs[leg].length() - cut_m
        };
        let heading_rad = |leg: usize| real::atan2(legs[leg].y, legs[leg].x);
        let mut line = Self::from(Pose2 { at: points[0], heading_rad: heading_rad(0) }.moved(cut_m[0], 0.0));
        let mut used_m = 0.0;
        for leg in 0..=last {
            let turn_rad = if leg < last { real::wrap_angle_rad(heading_rad(leg + 1) - heading_rad(leg)) } else { 0.0 };
            let room_m = if leg < last { 0.45 * free_m(leg).min(free_m(leg + 1)) } else { 0.0 };
            let tangent_m = (radius_m * real::tan(0.5 * turn_rad.abs())).min(room_m);
            line = line.then(Curve::Line, free_m(leg) - used_m - tangent_m).turned(turn_rad, tangent_m);
            used_m = tangent_m;
        }
        line
    }

    /// A turning circle that comes back to where it began: right by a sixth, left around, right by a sixth.
    pub fn turning_circle(start: Pose2, radius_m: f64) -> Self {
        let sixth = real::PI / 3.0;
        [(-1.0, sixth), (1.0, real::PI + 2.0 * sixth), (-1.0, sixth)].into_iter().fold(
            Self::from(start),
            |line, arc| {
                let (side, turn_rad) = arc;
                line.then(Curve::Arc { curvature: side / radius_m }, radius_m * turn_rad)
            },
        )
    }

    /// Onward by an arc whose tangents have this length.
    fn turned(self, turn_rad: f64, tangent_m: f64) -> Self {
        if turn_rad.abs() < 1e-9 {
            return self;
        }
        let radius_m = tangent_m / real::tan(0.5 * turn_rad.abs());
        self.then(Curve::Arc { curvature: turn_rad.signum() / radius_m.max(1e-9) }, radius_m * turn_rad.abs())
    }

    /// Stations at the ends of all pieces, and in curves at least every 8 degrees.
    pub fn stations_m(&self) -> Vec<f64> {
        const STEP_RAD: f64 = 0.14;
        let (mut all, mut begin_m) = (vec![0.0], 0.0);
        for piece in &self.pieces {
            let turn_rad = (piece.heading_at(piece.length_m) - piece.start.heading_rad).abs();
            let steps = (turn_rad / STEP_RAD).ceil().max(1.0);
            all.extend((1..=steps as usize).map(|step| begin_m + piece.length_m * step as f64 / steps));
            begin_m += piece.length_m;
        }
        all
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
    fn corners_bends_and_turning_circles_end_where_they_were_sent() {
        let start = Pose2 { at: DVec2::new(3.0, -2.0), heading_rad: 0.7 };
        for turn_rad in [-2.0, -0.3, 0.5, 1.9] {
            let bend = start.moved(14.0, 0.0);
            let goal = Pose2 { heading_rad: 0.7 + turn_rad, ..bend }.moved(21.0, 0.0);
            check_ends_at(&Alignment::corner(start, goal), goal.at, goal.heading_rad);
        }
        let points = [[0.0, 0.0], [40.0, 10.0], [60.0, 50.0], [120.0, 50.0]].map(DVec2::from);
        let line = Alignment::through(&points, [5.0, 7.0], 20.0);
        check_ends_at(&line, DVec2::new(113.0, 50.0), 0.0);
        check_ends_at(&Alignment::turning_circle(start, 6.0), start.at, 0.7 + real::PI);
        assert!(line.stations_m().windows(2).all(|pair| pair[0] < pair[1]));
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
