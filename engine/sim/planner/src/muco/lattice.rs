//! The polar lattice of viewpoints around the moving target: what is seen from where, and what is free.
//!
//! A node is (azimuth, altitude, horizontal radius) around the target's feet in **world** azimuth, so that
//! "stay" moves with the target. No rays are cast: for one azimuth a box covers an interval of the horizontal ray
//! from the target, and a comparison per node says whether the line of sight passes through the box there.

use crate::config::{SearchConfig, ViewConfig};
use crate::obstacles::local::LocalObstacles;
use crate::obstacles::{Surroundings, solid::Solid};
use cosfly_frames::{DVec3, TargetTrack, real};

/// Largest number of (altitude, radius) pairs.
pub const MAX_LANES: usize = 64;

/// Heights of the body seen along its axis, for a body of 1.75 m, and how many body points each stands for.
const BODY_HEIGHTS: [(f64, u8); 5] = [(0.12, 1), (0.5, 1), (1.05, 2), (1.42, 3), (1.7, 1)];

/// State of a node: the number of visible body points (0..=8), [`CLOSE`] when an obstacle is near, or
/// [`UNSAFE`].
pub type NodeState = u8;
/// Set when an obstacle is within the clearance plus [`CLOSE_EXTRA_M`].
pub const CLOSE: NodeState = 0x10;
/// The node is too near an obstacle or the ground.
pub const UNSAFE: NodeState = 0xff;
/// See [`CLOSE`], metres.
const CLOSE_EXTRA_M: f64 = 1.5;

/// The shape of the lattice, the same at every frame.
pub struct Lattice {
    /// Unit vectors of the azimuths.
    pub directions: Vec<DVec3>,
    /// Altitudes above the target's feet, metres, ascending.
    pub altitudes_m: Vec<f64>,
    /// Horizontal radii, metres, ascending.
    pub radii_m: Vec<f64>,
}

impl Lattice {
    /// Spreads altitudes and radii: closer together where views are good (low and near the best distance).
    pub fn new(search: &SearchConfig, view: &ViewConfig) -> Self {
        let azimuths = search.azimuths as usize;
        let directions = (0..azimuths)
            .map(|a| {
                let (sin, cos) = real::sin_cos(real::TAU * a as f64 / azimuths as f64);
                DVec3::new(cos, sin, 0.0)
            })
            .collect();
        // Just above the lowest altitude, so that smoothing need not press against its bound.
        let low = (view.min_altitude_m + 0.5).min(view.max_altitude_m);
        let altitudes_m = spread(search.altitudes as usize, low, view.max_altitude_m, 1.3);
        let radii_m = spread(search.radii as usize, view.min_radius_m, view.max_radius_m, 1.0);
        Self { directions, altitudes_m, radii_m }
    }

    /// (altitude, radius) pairs per azimuth.
    pub fn lanes(&self) -> usize {
        self.altitudes_m.len() * self.radii_m.len()
    }

    /// Nodes per frame; node = azimuth * lanes + altitude * radii + radius.
    pub fn nodes(&self) -> usize {
        self.directions.len() * self.lanes()
    }

    /// (azimuth, altitude, radius) of a node.
    pub fn split(&self, node: usize) -> (usize, usize, usize) {
        let (azimuth, lane) = (node / self.lanes(), node % self.lanes());
        (azimuth, lane / self.radii_m.len(), lane % self.radii_m.len())
    }

    /// Where a node is relative to the target's feet, metres.
    pub fn offset(&self, node: usize) -> DVec3 {
        let (azimuth, altitude, radius) = self.split(node);
        self.directions[azimuth] * self.radii_m[radius] + DVec3::new(0.0, 0.0, self.altitudes_m[altitude])
    }

    /// Evaluates one frame into `states` (one per node).
    pub fn evaluate(
        &self,
        frame: usize,
        track: &TargetTrack,
        obstacles: &LocalObstacles<'_>,
        keep_out_m: f64,
        states: &mut [NodeState],
    ) {
        let mut scan = FrameScan::new(self, track, frame);
        for solid in obstacles.at_frame(frame) {
            scan.add(solid, keep_out_m);
        }
        scan.write(states);
        self.close_below_ground(track.states[frame].feet_in_world, obstacles, states);
    }

    fn close_below_ground(&self, feet: DVec3, obstacles: &LocalObstacles<'_>, states: &mut [NodeState]) {
        let radii = self.radii_m.len();
        for (azimuth, direction) in self.directions.iter().enumerate() {
            for (r, &radius) in self.radii_m.iter().enumerate() {
                let place = feet + *direction * radius;
                let rise = obstacles.ground_z_m(place.x, place.y) - feet.z;
                if rise <= 0.4 {
                    continue;
                }
                // The highest altitude stays open on steep slopes, so that a way over them remains.
                let top = self.altitudes_m.len() - 1;
                for (h, &altitude) in self.altitudes_m.iter().enumerate() {
                    let high_enough = altitude + 0.9 >= rise + self.altitudes_m[0];
                    if !(high_enough || h == top && altitude >= rise + 3.0) {
                        states[azimuth * self.lanes() + h * radii + r] = UNSAFE;
                    }
                }
            }
        }
    }
}

/// `count` numbers from `low` to `high`; a `bend` above 1 crowds them at the low end.
fn spread(count: usize, low: f64, high: f64, bend: f64) -> Vec<f64> {
    if count < 2 {
        return vec![low];
    }
    (0..count).map(|i| low + (high - low) * real::powf(i as f64 / (count - 1) as f64, bend)).collect()
}

/// Per-lane numbers in arrays that compilers turn into vector code.
type Lanes = [f32; MAX_LANES];

struct FrameScan<'a> {
    lattice: &'a Lattice,
    feet: DVec3,
    radius: Lanes,
    altitude: Lanes,
    body: [f64; 5],
    slope: [Lanes; 5],
    /// Per azimuth and lane: bits 0..5 a hidden body height, bit 8 close, bit 9 unsafe.
    marks: Vec<[u32; MAX_LANES]>,
}

const CLOSE_BIT: u32 = 1 << 8;
const UNSAFE_BIT: u32 = 1 << 9;

impl<'a> FrameScan<'a> {
    fn new(lattice: &'a Lattice, track: &TargetTrack, frame: usize) -> Self {
        let body = BODY_HEIGHTS.map(|(height, _)| height * track.height_m / 1.75);
        let mut scan = Self {
            lattice,
            feet: track.states[frame].feet_in_world,
            radius: [1.0; MAX_LANES],
            altitude: [0.0; MAX_LANES],
            body,
            slope: [[0.0; MAX_LANES]; 5],
            marks: vec![[0; MAX_LANES]; lattice.directions.len()],
        };
        let radii = lattice.radii_m.len();
        for lane in 0..lattice.lanes() {
            scan.radius[lane] = lattice.radii_m[lane % radii] as f32;
            scan.altitude[lane] = lattice.altitudes_m[lane / radii] as f32;
            for (slope, height) in scan.slope.iter_mut().zip(body) {
                slope[lane] = (scan.altitude[lane] - height as f32) / scan.radius[lane];
            }
        }
        scan
    }

    fn add(&mut self, solid: &Solid, keep_out_m: f64) {
        let grow = keep_out_m + CLOSE_EXTRA_M;
        let (center, disc) = solid.disc_from_above();
        let (dx, dy) = (center.x - self.feet.x, center.y - self.feet.y);
        let (distance, reach) = (real::hypot(dx, dy), disc + grow * core::f64::consts::SQRT_2);
        let count = self.lattice.directions.len() as i64;
        let (first, last) = if distance <= reach {
            (0, count - 1)
        } else {
            let step = real::TAU / count as f64;
            let (middle, half) = (real::atan2(dy, dx), real::asin(reach / distance));
            (((middle - half) / step).ceil() as i64, ((middle + half) / step).floor() as i64)
        };
        for azimuth in first..=last.min(first + count - 1) {
            self.add_at(solid, azimuth.rem_euclid(count) as usize, keep_out_m);
        }
    }

    fn add_at(&mut self, solid: &Solid, azimuth: usize, keep_out_m: f64) {
        let direction = self.lattice.directions[azimuth];
        let marks = &mut self.marks[azimuth];
        for (grow, bit) in [(keep_out_m, UNSAFE_BIT), (keep_out_m + CLOSE_EXTRA_M, CLOSE_BIT)] {
            let (enter, leave) = solid.crossing_from_above(self.feet, direction, grow);
            if enter <= leave {
                let low = (solid.min.z - self.feet.z - grow) as f32;
                let high = (solid.max.z - self.feet.z + grow) as f32;
                mark_inside(marks, bit, &self.radius, &self.altitude, (enter as f32, leave as f32), (low, high));
            }
        }
        let (enter, leave) = solid.crossing_from_above(self.feet, direction, 0.0);
        if enter > leave {
            return;
        }
        let (low, high) = (solid.min.z - self.feet.z, solid.max.z - self.feet.z);
        for (k, height) in self.body.iter().enumerate() {
            mark_hidden(
                marks,
                1 << k,
                &self.radius,
                &self.slope[k],
                (enter as f32, leave as f32),
                ((low - height) as f32, (high - height) as f32),
            );
        }
    }

    fn write(&self, states: &mut [NodeState]) {
        let lanes = self.lattice.lanes();
        for (marks, out) in self.marks.iter().zip(states.chunks_exact_mut(lanes)) {
            for (&mark, state) in marks.iter().zip(out) {
                let seen: u8 =
                    BODY_HEIGHTS.iter().enumerate().filter(|(k, _)| mark & (1 << k) == 0).map(|(_, body)| body.1).sum();
                *state = if mark & UNSAFE_BIT != 0 {
                    UNSAFE
                } else if mark & CLOSE_BIT != 0 {
                    seen | CLOSE
                } else {
                    seen
                };
            }
        }
    }
}

/// Marks lanes whose node lies in the box: radius in `along`, altitude in `up`.
#[inline]
fn mark_inside(
    marks: &mut [u32; MAX_LANES],
    bit: u32,
    radius: &Lanes,
    altitude: &Lanes,
    along: (f32, f32),
    up: (f32, f32),
) {
    for lane in 0..MAX_LANES {
        let inside =
            (radius[lane] >= along.0) & (radius[lane] <= along.1) & (altitude[lane] >= up.0) & (altitude[lane] <= up.1);
        marks[lane] |= u32::from(inside) * bit;
    }
}

/// Marks lanes whose line of sight passes the box: it climbs by `slope` per metre from the body point, and the
/// box lies between `up` (relative to that point) over the distances `along`.
#[inline]
fn mark_hidden(
    marks: &mut [u32; MAX_LANES],
    bit: u32,
    radius: &Lanes,
    slope: &Lanes,
    along: (f32, f32),
    up: (f32, f32),
) {
    for lane in 0..MAX_LANES {
        let last = if along.1 < radius[lane] { along.1 } else { radius[lane] };
        let (at_enter, at_leave) = (slope[lane] * along.0, slope[lane] * last);
        let (low, high) = if at_enter < at_leave { (at_enter, at_leave) } else { (at_leave, at_enter) };
        let hidden = (along.0 <= radius[lane]) & (low <= up.1) & (high >= up.0);
        marks[lane] |= u32::from(hidden) * bit;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::obstacles::ground::GroundGrid;
    use cosfly_frames::{Seed, TargetState};
    use cosfly_geometry::OrientedBox;

    fn one_frame() -> TargetTrack {
        let state = TargetState { feet_in_world: DVec3::new(3.0, -2.0, 1.0), heading_rad: 0.0, speed_mps: 0.0 };
        TargetTrack { dt_s: 0.5, height_m: 1.75, radius_m: 0.3, states: vec![state] }
    }

    #[test]
    fn every_node_agrees_with_rays_and_grown_boxes() {
        let track = one_frame();
        let feet = track.states[0].feet_in_world;
        let ground = GroundGrid::sample(&track, &|_, _| 1.0, 60.0);
        let lattice = Lattice::new(&SearchConfig::default(), &ViewConfig::default());
        let mut stream = Seed::of_item(2, "lattice", "rays").stream("boxes");
        let (mut wrong, mut hidden_rays, mut closed, mut nodes) = (0, 0, 0, 0);
        for _ in 0..12 {
            let mut v = |low: f64, high: f64| stream.uniform(low, high);
            let boxes: Vec<OrientedBox> = (0..10)
                .map(|_| OrientedBox {
                    center_in_world: DVec3::new(v(-30.0, 30.0), v(-30.0, 30.0), v(0.0, 25.0)),
                    half_extents_m: DVec3::new(v(0.1, 5.0), v(0.1, 5.0), v(0.1, 9.0)),
                    yaw_rad: v(-3.0, 3.0),
                })
                .collect();
            let obstacles = LocalObstacles::filter(&track, &boxes, &ground, 60.0, 8.0);
            let mut states = vec![0; lattice.nodes()];
            lattice.evaluate(0, &track, &obstacles, 1.7, &mut states);
            for (node, &state) in states.iter().enumerate() {
                let position = feet + lattice.offset(node);
                let lit = |height: f64| {
                    let eye = feet + DVec3::Z * height;
                    !obstacles.at_frame(0).any(|solid| solid.meets_segment(eye, position))
                };
                let seen: u8 = BODY_HEIGHTS.iter().filter(|(height, _)| lit(*height)).map(|(_, count)| count).sum();
                let near = obstacles.nearest(0, position, 1.7).is_some();
                assert!(
                    !near || state == UNSAFE,
                    "node {node} is {:?} from a box",
                    obstacles.nearest(0, position, 9.0)
                );
                closed += usize::from(state == UNSAFE);
                hidden_rays += usize::from(seen < 8);
                wrong += usize::from(state != UNSAFE && state & !CLOSE != seen);
                nodes += 1;
            }
        }
        assert!(hidden_rays > 1000 && closed > 300, "{hidden_rays} {closed}");
        assert!(wrong * 1000 < nodes, "{wrong} of {nodes} nodes differ from rays");
    }
}
