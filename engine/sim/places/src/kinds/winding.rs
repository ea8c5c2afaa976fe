//! A net of curved streets that grows street by street: each new one leaves an older one and keeps its distance from all others.

use crate::net::network::{acute_ends, short_streets};
use crate::net::plan::{Profile, StreetPlan};
use cosfly_frames::{DVec2, real};

/// Distance between the points of a curve, metres.
const STEP_M: f64 = 2.0;
/// Length of the straight parts that a street is laid in, the least, metres.
const LEG_M: f64 = 20.0;
/// Distance of junctions along a street, metres.
const JUNCTIONS_M: f64 = 58.0;
/// Distance of the middles of two streets beside each other, metres.
const APART_M: f64 = 58.0;
/// A street that leaves another is so far away from it after each metre, metres.
const LEAVING: f64 = 0.65;
/// Largest turn of a street over [`LEG_M`], radians.
const TURN_RAD: f64 = 0.75;
/// Radius of bends: arcs meet halfway between their corners, metres.
const BEND_M: f64 = 500.0;

/// A curve with points every [`STEP_M`].
#[derive(Clone)]
struct Curve {
    points: Vec<DVec2>,
    /// Whether the last point leads on to the first.
    is_closed: bool,
    profile: Profile,
    /// Points where streets meet, with their nodes of the plan.
    junctions: Vec<(usize, usize)>,
}

/// A place beside a curve: the number of the curve and of its point, and the side, 1 for left and -1 for right.
#[derive(Clone, Copy, Debug)]
pub struct Beside {
    /// Number of the curve, in the order in which they were made.
    pub curve: usize,
    /// Number of the point.
    pub point: usize,
    /// The side.
    pub side: f64,
}

/// A net that grows.
#[derive(Clone, Default)]
pub struct Winding {
    curves: Vec<Curve>,
    plan: StreetPlan,
    /// Discs that no street enters: middles and radii, metres.
    kept: Vec<(DVec2, f64)>,
}

impl Winding {
    /// A net of one ring through some points.
    pub fn ring(points: &[DVec2], profile: Profile) -> Self {
        let mut around = points.to_vec();
        around.extend(points.first());
        let mut points = spaced(&around);
        points.pop();
        let ring = Curve { points, is_closed: true, profile, junctions: Vec::new() };
        Self { curves: vec![ring], ..Self::default() }
    }

    /// Keeps later streets off a disc.
    pub fn keep_off(&mut self, center: DVec2, radius_m: f64) {
        self.kept.push((center, radius_m));
    }

    /// Number of curves.
    pub fn count(&self) -> usize {
        self.curves.len()
    }

    /// Number of points of a curve.
    pub fn points(&self, curve: usize) -> usize {
        self.curves[curve].points.len()
    }

    /// Point and unit vector away from a curve.
    pub fn leave(&self, at: Beside) -> (DVec2, DVec2) {
        let curve = &self.curves[at.curve];
        let count = curve.points.len();
        let [before, after] = if curve.is_closed {
            [(at.point + count - 1) % count, (at.point + 1) % count]
        } else {
            [at.point.saturating_sub(1), (at.point + 1).min(count - 1)]
        };
        let along = (curve.points[after] - curve.points[before]).normalize();
        (curve.points[at.point], at.side * along.perp())
    }

    /// Distance from a point to the nearest street, metres.
    pub fn distance_m(&self, at: DVec2) -> f64 {
        let points = self.curves.iter().flat_map(|curve| &curve.points);
        points.map(|point| point.distance(at)).fold(f64::INFINITY, f64::min)
    }

    /// A street from one place beside a curve to another, in a bow whose tangents are `reach_m` long, if it has room.
    pub fn bow(&mut self, ends: [Beside; 2], reach_m: f64, profile: Profile) -> bool {
        let [(from, out), (to, back)] = ends.map(|end| self.leave(end));
        let corners = [from, from + reach_m * out, to + reach_m * back, to];
        let bow: Vec<DVec2> = (0..=80).map(|share| bezier(corners, f64::from(share) / 80.0)).collect();
        let points = spaced(&bow);
        let fits = ends.iter().all(|end| self.may_join(*end)) && self.is_apart_from_itself(ends, points.len());
        if !fits || !self.has_room(&points, true) {
            return false;
        }
        self.if_sound(|net| {
            let nodes = ends.map(|end| net.join(end));
            net.add(points, profile, nodes);
        })
    }

    /// A street that leaves a curve and ends after so many metres, turned by `turn_rad`, if it has room.
    pub fn dead_end(&mut self, from: Beside, [length_m, lean_rad, turn_rad]: [f64; 3], profile: Profile) -> bool {
        let (start, out) = self.leave(from);
        let steps = (length_m / STEP_M).round() as usize;
        let (mut at, mut points) = (start, vec![start]);
        for step in 0..steps {
            let share = (step as f64 + 0.5) / steps as f64;
            // It leaves and ends straight, and turns between.
            let eased = share * share * (3.0 - 2.0 * share);
            let (sin, cos) = real::sin_cos(lean_rad + turn_rad * eased);
            at += STEP_M * DVec2::new(cos, sin).rotate(out);
            points.push(at);
        }
        if !self.may_join(from) || !self.has_room(&points, false) {
            return false;
        }
        self.if_sound(|net| {
            let end = net.plan.node(at);
            let nodes = [net.join(from), end];
            net.add(points, profile, nodes);
        })
    }

    /// The plan of all streets.
    pub fn into_plan(mut self) -> StreetPlan {
        self.plan.bend_m = Some(BEND_M);
        for curve in &self.curves {
            let mut junctions = curve.junctions.clone();
            junctions.sort_unstable();
            let count = curve.points.len();
            if curve.is_closed {
                junctions.extend(junctions.first().map(|(point, node)| (point + count, *node)));
            }
            for pair in junctions.windows(2) {
                let [(from, start), (to, end)] = [pair[0], pair[1]];
                let legs = ((to - from) as f64 * STEP_M / LEG_M).floor().max(2.0) as usize;
                let bend = |leg: usize| curve.points[(from + (to - from) * leg / legs) % count];
                self.plan.bent(start, (1..legs).map(bend).collect(), end, curve.profile);
            }
        }
        self.plan
    }

    /// Makes a change, unless streets would meet at too small an angle or be too short for their junctions.
    fn if_sound(&mut self, change: impl FnOnce(&mut Self)) -> bool {
        let before = self.clone();
        change(self);
        let plan = self.clone().into_plan();
        let is_sound = acute_ends(&plan).is_empty() && short_streets(&plan).is_empty();
        if !is_sound {
            *self = before;
        }
        is_sound
    }

    fn add(&mut self, points: Vec<DVec2>, profile: Profile, [start, end]: [usize; 2]) {
        let junctions = vec![(0, start), (points.len() - 1, end)];
        self.curves.push(Curve { points, is_closed: false, profile, junctions });
    }

    /// Whether no junction of the curve is near.
    fn may_join(&self, at: Beside) -> bool {
        let curve = &self.curves[at.curve];
        curve.junctions.iter().all(|(point, _)| curve.between_m(*point, at.point) >= JUNCTIONS_M)
    }

    /// Whether the ends of a bow do not meet, nor close a piece of land too small for houses.
    fn is_apart_from_itself(&self, [from, to]: [Beside; 2], length: usize) -> bool {
        let between_m = self.curves[from.curve].between_m(from.point, to.point);
        length as f64 * STEP_M > 2.0 * APART_M && (from.curve != to.curve || between_m >= 1.5 * APART_M)
    }

    /// A node of the plan at a place of a curve.
    fn join(&mut self, at: Beside) -> usize {
        let node = self.plan.node(self.curves[at.curve].points[at.point]);
        self.curves[at.curve].junctions.push((at.point, node));
        node
    }

    /// Whether a new street turns gently and keeps its distance from all others, from itself and from what is kept.
    fn has_room(&self, points: &[DVec2], joins_at_end: bool) -> bool {
        let leg = (LEG_M / STEP_M) as usize;
        let way = |at: usize| points[at + 1] - points[at];
        let turn_rad = |at: usize| real::atan2(way(at).perp_dot(way(at + leg)), way(at).dot(way(at + leg))).abs();
        if (0..points.len().saturating_sub(leg + 1)).any(|at| turn_rad(at) > TURN_RAD) {
            return false;
        }
        (0..points.len()).step_by(3).chain([points.len() - 1]).all(|at| {
            let to_end = if joins_at_end { at.min(points.len() - 1 - at) } else { at };
            let wanted_m = APART_M.min(LEAVING * STEP_M * to_end as f64);
            let of_itself =
                points.iter().enumerate().filter(|(other, _)| other.abs_diff(at) as f64 * STEP_M > 2.0 * APART_M);
            self.distance_m(points[at]) >= wanted_m
                && of_itself.map(|(_, other)| other).all(|other| other.distance(points[at]) >= 0.9 * APART_M)
                && self.kept.iter().all(|(center, radius_m)| center.distance(points[at]) >= *radius_m)
        })
    }
}

impl Curve {
    /// Way along the curve between two of its points, the shorter one, metres.
    fn between_m(&self, one: usize, other: usize) -> f64 {
        let steps = one.abs_diff(other);
        STEP_M * if self.is_closed { steps.min(self.points.len() - steps) } else { steps } as f64
    }
}

/// A point of a cubic curve.
fn bezier([a, b, c, d]: [DVec2; 4], share: f64) -> DVec2 {
    let [ab, bc, cd] = [a.lerp(b, share), b.lerp(c, share), c.lerp(d, share)];
    ab.lerp(bc, share).lerp(bc.lerp(cd, share), share)
}

/// Points along a line, about [`STEP_M`] apart, with both ends.
fn spaced(line: &[DVec2]) -> Vec<DVec2> {
    let length_m: f64 = line.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    let count = (length_m / STEP_M).round().max(1.0);
    let (mut points, mut begin_m) = (Vec::new(), 0.0);
    for pair in line.windows(2) {
        let leg_m = pair[0].distance(pair[1]);
        while (points.len() as f64) < count && points.len() as f64 * length_m / count <= begin_m + leg_m {
            let share = (points.len() as f64 * length_m / count - begin_m) / leg_m.max(1e-9);
            points.push(pair[0].lerp(pair[1], share));
        }
        begin_m += leg_m;
    }
    points.extend(line.last());
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::disc;

    const STREET: Profile = Profile { lanes: 1, lane_m: 3.0, sidewalk_m: 2.0, corner_m: 4.0 };

    fn beside(point: usize, side: f64) -> Beside {
        Beside { curve: 0, point, side }
    }

    #[test]
    fn streets_keep_their_distance_and_the_plan_holds_all_of_them() {
        let mut net = Winding::ring(&disc(DVec2::ZERO, 200.0, 360), STREET);
        assert!((net.points(0) as f64 * STEP_M - 400.0 * real::PI).abs() < 2.0);
        let half = net.points(0) / 2;
        assert!(net.bow([beside(0, 1.0), beside(half, 1.0)], 150.0, STREET), "across");
        assert!(!net.dead_end(beside(3, -1.0), [80.0, 0.0, 0.0], STREET), "beside a junction");
        assert!(!net.dead_end(beside(half / 2, 1.0), [180.0, 0.0, 0.0], STREET), "into the street across");
        net.keep_off(DVec2::new(0.0, 100.0), 30.0);
        assert!(!net.dead_end(beside(half / 2, 1.0), [80.0, 0.0, 0.0], STREET), "into what is kept");
        assert!(net.dead_end(beside(half / 2, -1.0), [80.0, 0.1, 0.5], STREET), "out");
        assert!(net.bow([beside(half + 60, -1.0), beside(half + 150, -1.0)], 150.0, STREET), "a crescent");
        assert!(net.distance_m(DVec2::ZERO) < 2.0);
        let plan = net.into_plan();
        // Five junctions on the ring cut it in five; the street across, the dead end and the crescent are whole.
        assert_eq!((plan.nodes.len(), plan.links.len()), (6, 8));
        let legs = plan
            .links
            .iter()
            .flat_map(|link| plan.points(link).windows(2).map(|leg| leg[0].distance(leg[1])).collect::<Vec<_>>());
        assert!(legs.fold(f64::INFINITY, f64::min) > 0.9 * LEG_M);
    }

    #[test]
    fn points_of_a_line_are_evenly_spaced_and_hold_its_ends() {
        let points = spaced(&[DVec2::ZERO, DVec2::new(5.0, 0.0), DVec2::new(5.0, 6.0)]);
        assert_eq!(points.len(), 7);
        assert!(points[6] == DVec2::new(5.0, 6.0) && points[1].distance(DVec2::new(11.0 / 6.0, 0.0)) < 1e-9);
    }
}
