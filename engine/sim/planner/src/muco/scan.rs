//! Visibility from each node of the lattice, and free nodes, one frame at a time.
//!
//! No rays are cast: for one azimuth a box covers an interval of the horizontal ray from the target, and a
//! few comparisons per node say whether the line of sight passes through the box there.

use super::lattice::{Lattice, MAX_RINGS};
use super::node_state::{CLOSE, CLOSE_EXTRA_M, NodeState, UNSAFE};
use cosfly_frames::simd::Level;
use cosfly_frames::{DVec3, TargetState, real, simd_kernel};
use cosfly_surroundings::Surroundings;
use cosfly_surroundings::local::LocalObstacles;
use cosfly_surroundings::solid::Solid;

/// Heights of the body seen along its axis, for a body of 1.75 m, and how many body points each stands for.
pub const BODY_HEIGHTS: [(f64, u32); 5] = [(0.12, 1), (0.5, 1), (1.05, 2), (1.42, 3), (1.7, 1)];

/// Azimuths, and rings, are handled in groups of this many.
const VECTOR: usize = 16;

const CLOSE_BIT: u32 = 1 << 8;
const UNSAFE_BIT: u32 = 1 << 9;

/// Azimuth vectors and body slopes, prepared once per search.
pub struct Scanner<'a> {
    lattice: &'a Lattice,
    /// Cosines and sines of the azimuths, filled up to whole vectors.
    cos: Vec<f32>,
    sin: Vec<f32>,
    body_m: [f32; 5],
    /// Radius and altitude of each ring, filled up to whole vectors, metres.
    radius_m: Vec<f32>,
    altitude_m: Vec<f32>,
    /// Climb per metre from each body height to each ring.
    slopes: [[f32; MAX_RINGS]; 5],
    /// By azimuth and ring.
    marks: Vec<u32>,
    half_group: [f32; 2],
    profiles: Vec<Profile>,
    level: Level,
}

/// One box as seen from the target's feet; metres.
#[derive(Clone, Copy)]
struct Profile {
    /// Centre, turned into the box's axes.
    center: [f32; 2],
    cos: f32,
    sin: f32,
    half: [f32; 2],
    low: f32,
    high: f32,
    /// Middle of the box seen from above, and the radius of a disc around the box when grown most.
    away: [f32; 2],
    reach: f32,
    /// Something may come near it: grown most it does not stay below all nodes.
    closes: bool,
    /// Whether the box hides what is behind it.
    hides: bool,
}

impl<'a> Scanner<'a> {
    /// For a body `height_m` tall.
    pub fn new(lattice: &'a Lattice, height_m: f64) -> Self {
        let padded = lattice.directions.len().next_multiple_of(VECTOR);
        let direction = |azimuth: usize| lattice.directions[azimuth % lattice.directions.len()];
        let body_m = BODY_HEIGHTS.map(|(height, _)| (height * height_m / 1.75) as f32);
        let rings = lattice.rings().next_multiple_of(VECTOR);
        let ring = |ring: usize| lattice.ring_m(ring.min(lattice.rings() - 1));
        let altitude_m: Vec<f32> = (0..rings).map(|r| ring(r).0 as f32).collect();
        let radius_m: Vec<f32> = (0..rings).map(|r| ring(r).1 as f32).collect();
        let slopes = body_m.map(|height| {
            let mut slopes = [0.0; MAX_RINGS];
            for (slope, (altitude, radius)) in slopes.iter_mut().zip(altitude_m.iter().zip(&radius_m)) {
                *slope = (altitude - height) / radius;
            }
            slopes
        });
        Self {
            cos: (0..padded).map(|azimuth| direction(azimuth).x as f32).collect(),
            sin: (0..padded).map(|azimuth| direction(azimuth).y as f32).collect(),
            body_m,
            slopes,
            marks: vec![0; padded * rings],
            radius_m,
            altitude_m,
            half_group: half_group(lattice.directions.len()),
            profiles: Vec::new(),
            level: Level::best(),
            lattice,
        }
    }

    /// This scan with other instructions; for tests.
    pub fn at_level(mut self, level: Level) -> Self {
        self.level = level;
        self
    }

    /// Evaluates one frame into `states` (one per node).
    pub fn evaluate(
        &mut self,
        frame: usize,
        target: &TargetState,
        obstacles: &LocalObstacles<'_>,
        keep_out_m: f64,
        states: &mut [NodeState],
    ) {
        let feet = target.feet_in_world;
        let farthest = self.lattice.radii_m.last().copied().unwrap_or(0.0) + keep_out_m + CLOSE_EXTRA_M;
        self.profiles.clear();
        let lowest = self.lattice.altitudes_m[0];
        let grown = (keep_out_m + CLOSE_EXTRA_M, lowest);
        let view = (lowest, self.lattice.radii_m.last().copied().unwrap_or(0.0));
        let mut add = |solid: &Solid, hides: bool, closes: bool| {
            self.profiles.extend(profile(solid, feet, farthest, grown, (hides, closes)));
        };
        obstacles.still_at(frame).for_each(|solid| add(solid, true, true));
        for moving in obstacles.moving_at(frame) {
            // Seen past where it is; kept clear of wherever it goes until the next frame.
            if moving.may_hide(feet, view) {
                add(&moving.here, true, false);
            }
            let swept = moving.swept();
            if swept.max.z - feet.z + grown.0 >= lowest {
                add(&swept, false, true);
            }
        }
        self.marks.fill(0);
        let shape = Shape {
            cos: &self.cos,
            sin: &self.sin,
            radius: &self.radius_m,
            altitude: &self.altitude_m,
            slopes: &self.slopes,
            body_m: self.body_m,
            grow: [keep_out_m as f32, (keep_out_m + CLOSE_EXTRA_M) as f32],
            farthest: farthest as f32,
            half_group: self.half_group,
            from_above: self.lattice.altitudes_m[0] > f64::from(self.body_m[4]),
        };
        mark_all(self.level, &shape, &self.profiles, &mut self.marks);
        let azimuths = self.lattice.directions.len();
        write_states(self.level, &self.marks, self.radius_m.len(), azimuths, states);
        self.close_below_ground(feet, obstacles, states);
    }

    fn close_below_ground(&self, feet: DVec3, obstacles: &LocalObstacles<'_>, states: &mut [NodeState]) {
        const LEVEL_M: f64 = 0.4;
        if obstacles.highest_ground_m() - feet.z <= LEVEL_M {
            return;
        }
        let lattice = self.lattice;
        let radii = lattice.radii_m.len();
        for (azimuth, direction) in lattice.directions.iter().enumerate() {
            for (r, &radius) in lattice.radii_m.iter().enumerate() {
                let place = feet + *direction * radius;
                let rise = obstacles.ground_z_m(place.x, place.y) - feet.z;
                if rise <= LEVEL_M {
                    continue;
                }
                // The highest altitude stays open on steep slopes, so that a way over them remains.
                let top = lattice.altitudes_m.len() - 1;
                for (h, &altitude) in lattice.altitudes_m.iter().enumerate() {
                    let high_enough = altitude + 0.9 >= rise + lattice.altitudes_m[0];
                    if !(high_enough || h == top && altitude >= rise + 3.0) {
                        states[(h * radii + r) * lattice.directions.len() + azimuth] = UNSAFE;
                    }
                }
            }
        }
    }
}

/// Cosine and sine of half the angle of a group of azimuths around its middle one, at most a right angle: wider
/// groups are always looked at.
fn half_group(azimuths: usize) -> [f32; 2] {
    let half = real::TAU * (VECTOR / 2) as f64 / azimuths as f64;
    if half >= 0.5 * real::PI {
        return [f32::NEG_INFINITY, 0.0];
    }
    let (sin, cos) = real::sin_cos(half);
    [cos as f32, sin as f32]
}

/// `None` when the box is too far away to matter.
fn profile(
    solid: &Solid,
    feet: DVec3,
    farthest_m: f64,
    (grow_m, lowest_m): (f64, f64),
    (hides, closes): (bool, bool),
) -> Option<Profile> {
    let (center, disc) = solid.disc_from_above();
    let away = (center - feet).truncate();
    let reach = farthest_m + disc;
    if away.length_squared() > reach * reach {
        return None;
    }
    let (sin, cos) = solid.turn();
    let half = solid.half_extents_m();
    let closes = closes && solid.max.z - feet.z + grow_m >= lowest_m;
    let grow_m = if closes { grow_m } else { 0.0 };
    Some(Profile {
        center: [(cos * away.x + sin * away.y) as f32, (cos * away.y - sin * away.x) as f32],
        cos: cos as f32,
        sin: sin as f32,
        half: [half.x as f32, half.y as f32],
        low: (solid.min.z - feet.z) as f32,
        high: (solid.max.z - feet.z) as f32,
        away: [away.x as f32, away.y as f32],
        // The corners of a grown box stand out by more than it grows; a little more covers all rounding.
        closes,
        hides,
        reach: (disc + core::f64::consts::SQRT_2 * grow_m) as f32 + 0.1,
    })
}

struct Shape<'a> {
    cos: &'a [f32],
    sin: &'a [f32],
    radius: &'a [f32],
    altitude: &'a [f32],
    slopes: &'a [[f32; MAX_RINGS]; 5],
    body_m: [f32; 5],
    grow: [f32; 2],
    farthest: f32,
    /// All rings are above the body.
    from_above: bool,
    /// Cosine and sine of half the angle that a group of azimuths spans.
    half_group: [f32; 2],
}

/// The least that the middle of a group of azimuths must look along the way to a box for any of them to meet it:
/// `d cos(h + asin(r / d))` with `h` half the group's angle, `d` and `r` the box's distance and reach.
#[inline(always)]
fn least_along(shape: &Shape<'_>, solid: &Profile) -> f32 {
    let [x, y] = solid.away;
    let beyond = x * x + y * y - solid.reach * solid.reach;
    if beyond <= 0.0 {
        return f32::NEG_INFINITY;
    }
    shape.half_group[0] * beyond.sqrt() - shape.half_group[1] * solid.reach
}

/// For 16 azimuths: where the ray enters and leaves the box as it is, grown by the clearance, grown by more.
struct Crossings {
    enter: [[f32; VECTOR]; 3],
    leave: [[f32; VECTOR]; 3],
}

#[inline(always)]
fn least(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[inline(always)]
fn most(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// Slabs of the box across 16 azimuths; a bit for each azimuth that meets the outermost box that matters, in reach.
#[inline(always)]
fn cross(shape: &Shape<'_>, first: usize, solid: &Profile, out: &mut Crossings) -> u32 {
    let (Some(cos), Some(sin)) =
        (shape.cos[first..].first_chunk::<VECTOR>(), shape.sin[first..].first_chunk::<VECTOR>())
    else {
        return 0;
    };
    let grow = [0.0, shape.grow[0], shape.grow[1]];
    let outermost = if solid.closes { 2 } else { 0 };
    let mut hit = [0_u32; VECTOR];
    for j in 0..VECTOR {
        // A ray parallel to a face gets a slope too small to matter instead of a division by zero.
        let steer = |d: f32| if d.abs() < 1e-9 { 1e-9 } else { d };
        let inverse_x = 1.0 / steer(solid.cos * cos[j] + solid.sin * sin[j]);
        let inverse_y = 1.0 / steer(solid.cos * sin[j] - solid.sin * cos[j]);
        let (middle_x, middle_y) = (solid.center[0] * inverse_x, solid.center[1] * inverse_y);
        let (size_x, size_y) = (inverse_x.abs(), inverse_y.abs());
        for (k, grow) in grow.into_iter().enumerate() {
            let (ex, ey) = ((solid.half[0] + grow) * size_x, (solid.half[1] + grow) * size_y);
            out.enter[k][j] = most(most(middle_x - ex, middle_y - ey), 0.0);
            out.leave[k][j] = least(middle_x + ex, middle_y + ey);
        }
    }
    let (enter, leave) = (&out.enter[outermost], &out.leave[outermost]);
    for j in 0..VECTOR {
        let meets = (enter[j] <= leave[j]) & (enter[j] <= shape.farthest);
        hit[j] = u32::from(meets) << j;
    }
    hit.iter().fold(0, |bits, bit| bits | bit)
}

/// Number `group` of the groups of rings. Hidden from the optimiser, which would otherwise handle several groups at a
/// time by gathering single numbers instead of one group as the vector that it is.
#[inline(always)]
fn group(values: &[f32], group: usize) -> &[f32; VECTOR] {
    let start = core::hint::black_box(group) * VECTOR;
    values[start..].first_chunk().unwrap_or(&[0.0; VECTOR])
}

/// Marks the rings of one azimuth that lie in the grown boxes.
#[inline(always)]
fn mark_inside(shape: &Shape<'_>, solid: &Profile, along: [(f32, f32); 2], marks: &mut [u32]) {
    let (low, high) = (shape.grow.map(|grow| solid.low - grow), shape.grow.map(|grow| solid.high + grow));
    for (g, marks) in marks.as_chunks_mut::<VECTOR>().0.iter_mut().enumerate() {
        let (radius, altitude) = (group(shape.radius, g), group(shape.altitude, g));
        let mut found = [0_u32; VECTOR];
        for j in 0..VECTOR {
            let inside = |k: usize| {
                (radius[j] >= along[k].0)
                    & (radius[j] <= along[k].1)
                    & (altitude[j] >= low[k])
                    & (altitude[j] <= high[k])
            };
            found[j] = if inside(0) { UNSAFE_BIT } else { 0 } | if inside(1) { CLOSE_BIT } else { 0 };
        }
        for j in 0..VECTOR {
            marks[j] |= found[j];
        }
    }
}

/// Marks the rings of one azimuth whose lines of sight pass the box: they climb by their slope per metre from
/// the body point, and the box lies between two heights over the distances `enter` to `leave`.
#[inline(always)]
fn mark_hidden(shape: &Shape<'_>, solid: &Profile, enter: f32, leave: f32, marks: &mut [u32]) {
    for (g, marks) in marks.as_chunks_mut::<VECTOR>().0.iter_mut().enumerate() {
        let radius = group(shape.radius, g);
        let mut found = [0_u32; VECTOR];
        for (k, slopes) in shape.slopes.iter().enumerate() {
            let slope = group(slopes, g);
            let (low, high) = (solid.low - shape.body_m[k], solid.high - shape.body_m[k]);
            for j in 0..VECTOR {
                let (at_enter, at_leave) = (slope[j] * enter, slope[j] * least(leave, radius[j]));
                let hidden =
                    (least(at_enter, at_leave) <= high) & (most(at_enter, at_leave) >= low) & (enter <= radius[j]);
                found[j] |= u32::from(hidden) << k;
            }
        }
        for j in 0..VECTOR {
            marks[j] |= found[j];
        }
    }
}

/// [`mark_hidden`] for a box that stands on or below the lowest body point, seen from above the body: whatever enters
/// it below its top is hidden.
#[inline(always)]
fn mark_behind(shape: &Shape<'_>, solid: &Profile, enter: f32, marks: &mut [u32]) {
    for (g, marks) in marks.as_chunks_mut::<VECTOR>().0.iter_mut().enumerate() {
        let radius = group(shape.radius, g);
        let mut found = [0_u32; VECTOR];
        for (k, slopes) in shape.slopes.iter().enumerate() {
            let slope = group(slopes, g);
            let high = solid.high - shape.body_m[k];
            for j in 0..VECTOR {
                let hidden = (slope[j] * enter <= high) & (enter <= radius[j]);
                found[j] |= u32::from(hidden) << k;
            }
        }
        for j in 0..VECTOR {
            marks[j] |= found[j];
        }
    }
}

simd_kernel! {
    /// Marks every node (azimuth * rings + ring): bits 0..5 a hidden body height, bit 8 close, bit 9 unsafe.
    fn mark_all(shape: &Shape<'_>, solids: &[Profile], marks: &mut [u32]) {
        let rings = shape.radius.len();
        let mut crossings = Crossings { enter: [[0.0; VECTOR]; 3], leave: [[0.0; VECTOR]; 3] };
        for solid in solids {
            let least_along = least_along(shape, solid);
            for first in (0..shape.cos.len()).step_by(VECTOR) {
                let middle = first + VECTOR / 2;
                if solid.away[0] * shape.cos[middle] + solid.away[1] * shape.sin[middle] < least_along {
                    continue;
                }
                let mut bits = cross(shape, first, solid, &mut crossings);
                while bits != 0 {
                    let j = bits.trailing_zeros() as usize;
                    bits &= bits - 1;
                    let row = &mut marks[(first + j) * rings..(first + j + 1) * rings];
                    let along = |k: usize| (crossings.enter[k][j], crossings.leave[k][j]);
                    if solid.closes {
                        mark_inside(shape, solid, [along(1), along(2)], row);
                    }
                    let (enter, leave) = along(0);
                    let stands = shape.from_above && solid.low <= shape.body_m[0];
                    match (solid.hides && enter <= leave, stands) {
                        (true, true) => mark_behind(shape, solid, enter, row),
                        (true, false) => mark_hidden(shape, solid, enter, leave, row),
                        (false, _) => (),
                    }
                }
            }
        }
    }
}

simd_kernel! {
    /// Counts what the marks (by azimuth and ring) say, into states by ring and azimuth.
    fn write_states(marks: &[u32], rings: usize, azimuths: usize, states: &mut [NodeState]) {
        for (azimuth, marks) in marks.chunks_exact(rings).enumerate().take(azimuths) {
            for (group, marks) in marks.as_chunks::<VECTOR>().0.iter().enumerate() {
                let mut found = [0_u8; VECTOR];
                for j in 0..VECTOR {
                    let mut hidden = 0_u32;
                    for (k, (_, count)) in BODY_HEIGHTS.iter().enumerate() {
                        hidden = hidden.wrapping_add(if marks[j] & (1 << k) != 0 { *count } else { 0 });
                    }
                    let close = if marks[j] & CLOSE_BIT != 0 { u32::from(CLOSE) } else { 0 };
                    found[j] = if marks[j] & UNSAFE_BIT != 0 { UNSAFE } else { (hidden | close) as u8 };
                }
                let first = group * VECTOR * azimuths + azimuth;
                for (found, state) in found.iter().zip(states.iter_mut().skip(first).step_by(azimuths)) {
                    *state = *found;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests;
