//! [`Spline`]: a smooth flight along waypoints that keeps the limits of the waypoints between them, too.

use crate::point_mass::Motion;
use cosfly_frames::DVec3;

/// The uniform cubic B-spline whose control points are waypoints at equal times.
///
/// Its velocities are means of the waypoints' first differences, its accelerations of second differences, its jerks are third
/// differences: a flight whose finite differences keep limits keeps them as a spline. The spline passes a waypoint at a sixth of
/// the second difference there (0.25 m at 6 m/s^2 and 0.5 s). Before the first and after the last waypoint the first and last
/// difference go on.
#[derive(Clone, Copy, Debug)]
pub struct Spline<'a> {
    /// Waypoints, world frame, metres; at least one.
    pub waypoints: &'a [DVec3],
    /// Time between waypoints, seconds.
    pub dt_s: f64,
}

impl Spline<'_> {
    /// Motion at a time, seconds from the first waypoint; beyond the last waypoint the flight stands there.
    pub fn at(&self, time_s: f64) -> Motion {
        let Some(last) = self.waypoints.len().checked_sub(1) else { return Motion::default() };
        let place = (time_s / self.dt_s).max(0.0);
        if place >= last as f64 {
            let velocity_in_world = if place == last as f64 { self.slope_at_end() } else { DVec3::ZERO };
            return Motion { position_in_world: self.control(last as i64), velocity_in_world, ..Motion::default() };
        }
        let (knot, t) = (place as i64, place.fract());
        let [a, b, c, d] = [-1, 0, 1, 2].map(|offset| self.control(knot + offset));
        let s = 1.0 - t;
        let (t2, t3) = (t * t, t * t * t);
        let position =
            s * s * s * a + (3.0 * t3 - 6.0 * t2 + 4.0) * b + (-3.0 * t3 + 3.0 * t2 + 3.0 * t + 1.0) * c + t3 * d;
        let velocity = s * s * (b - a) + (1.0 + 2.0 * t - 2.0 * t2) * (c - b) + t2 * (d - c);
        let acceleration = s * (c - 2.0 * b + a) + t * (d - 2.0 * c + b);
        Motion {
            position_in_world: position / 6.0,
            velocity_in_world: velocity / (2.0 * self.dt_s),
            acceleration_in_world: acceleration / (self.dt_s * self.dt_s),
        }
    }

    fn slope_at_end(&self) -> DVec3 {
        let last = self.waypoints.len() as i64 - 1;
        (self.control(last + 1) - self.control(last)) / self.dt_s
    }

    /// Waypoint with a number, which may lie one or two before the first or after the last.
    fn control(&self, number: i64) -> DVec3 {
        let points = self.waypoints;
        let last = points.len() as i64 - 1;
        let inside = points[number.clamp(0, last) as usize];
        match number {
            _ if last == 0 => inside,
            below if below < 0 => inside + below as f64 * (points[1] - points[0]),
            above if above > last => inside + (above - last) as f64 * (inside - points[last as usize - 1]),
            _ => inside,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_frames::Seed;

    #[test]
    fn derivatives_fit_and_limits_of_the_waypoints_hold_between_them() {
        let mut random = Seed([5; 32]).stream("waypoints");
        let waypoints: Vec<DVec3> =
            (0..40).map(|_| DVec3::from_array(core::array::from_fn(|_| random.uniform(-3.0, 3.0)))).collect();
        let spline = Spline { waypoints: &waypoints, dt_s: 0.5 };
        let largest = |order: usize, difference: &dyn Fn(&[DVec3]) -> DVec3| {
            waypoints.windows(order + 1).map(|w| difference(w).length()).fold(0.0, f64::max)
        };
        let speed = largest(1, &|w| (w[1] - w[0]) / 0.5);
        let acceleration = largest(2, &|w| (w[2] - 2.0 * w[1] + w[0]) / 0.25);
        let (mut time_s, h) = (0.013, 1e-4);
        while time_s < 19.4 {
            let [before, here, after] = [time_s - h, time_s, time_s + h].map(|time_s| spline.at(time_s));
            let slope = (after.position_in_world - before.position_in_world) / (2.0 * h);
            assert!((slope - here.velocity_in_world).length() < 1e-5, "{time_s}");
            let bend = (after.velocity_in_world - before.velocity_in_world) / (2.0 * h);
            assert!((bend - here.acceleration_in_world).length() < 1e-2, "{time_s}");
            assert!(here.velocity_in_world.length() <= speed + 1e-9);
            assert!(here.acceleration_in_world.length() <= acceleration + 1e-9);
            time_s += 0.0371;
        }
        let exact = (waypoints[9] + 4.0 * waypoints[10] + waypoints[11]) / 6.0;
        assert!((spline.at(5.0).position_in_world - exact).length() < 1e-12);
    }

    #[test]
    fn a_flight_ends_at_its_last_waypoint() {
        let waypoints = [DVec3::ZERO, DVec3::X, 2.0 * DVec3::X];
        let spline = Spline { waypoints: &waypoints, dt_s: 0.5 };
        assert!((spline.at(1.0).position_in_world - 2.0 * DVec3::X).length() < 1e-12);
        assert!((spline.at(0.999_999).position_in_world - 2.0 * DVec3::X).length() < 1e-5);
        assert_eq!((spline.at(9.0).velocity_in_world, spline.at(-1.0).position_in_world), (DVec3::ZERO, DVec3::ZERO));
        assert_eq!(Spline { waypoints: &waypoints[1..2], dt_s: 0.5 }.at(0.0).position_in_world, DVec3::X);
    }
}
