//! [`Curve`]: places between recorded ones.

use super::RecordedTrack;
use cosfly_frames::DVec2;

/// Cubic Hermite curve through places with times; the velocity at each is the central difference.
#[derive(Debug)]
pub(super) struct Curve {
    knots: Vec<(f64, DVec2)>,
    /// Span of the last time asked for.
    span: usize,
}

impl Curve {
    /// A curve through at least two places with rising times.
    pub fn new(knots: Vec<(f64, DVec2)>) -> Self {
        Self { knots, span: 0 }
    }

    /// Place and velocity at a time, held at the ends. Times are asked for in rising order.
    pub fn at(&mut self, time_s: f64) -> (DVec2, DVec2) {
        let knots = &self.knots;
        while self.span + 2 < knots.len() && knots[self.span + 1].0 <= time_s {
            self.span += 1;
        }
        let velocity = |knot: usize| {
            let (before, after) = (knots[knot.saturating_sub(1)], knots[(knot + 1).min(knots.len() - 1)]);
            (after.1 - before.1) / (after.0 - before.0)
        };
        let ((from_s, from), (to_s, to)) = (knots[self.span], knots[self.span + 1]);
        let length_s = to_s - from_s;
        let u = ((time_s - from_s) / length_s).clamp(0.0, 1.0);
        let (start, end) = (velocity(self.span) * length_s, velocity(self.span + 1) * length_s);
        // place(u) = from + start u + square u^2 + cube u^3
        let square = 3.0 * (to - from) - 2.0 * start - end;
        let cube = start + end - 2.0 * (to - from);
        let place = from + u * (start + u * (square + u * cube));
        (place, (start + u * (2.0 * square + 3.0 * u * cube)) / length_s)
    }
}

impl RecordedTrack {
    /// Places every `dt_s` seconds from the first time at or after `from_s` that is a multiple of `dt_s` from there: the
    /// number of the first, and the places. By the axes of the file.
    pub fn sampled(&self, from_s: f64, dt_s: f64) -> (u32, Vec<DVec2>) {
        let (Some(first), Some(last)) = (self.points.first(), self.points.last()) else { return (0, vec![]) };
        let number = |time_s: f64| (time_s - from_s) / dt_s;
        let (first, end) = ((number(first.time_s) - 1e-9).ceil().max(0.0), (number(last.time_s) + 1e-9).floor() + 1.0);
        if first >= end || self.points.len() < 2 {
            return (0, vec![]);
        }
        let mut curve = Curve::new(self.points.iter().map(|point| (point.time_s, point.at)).collect());
        let places = (first as u32..end as u32).map(|frame| curve.at(from_s + f64::from(frame) * dt_s).0);
        (first as u32, places.collect())
    }
}
