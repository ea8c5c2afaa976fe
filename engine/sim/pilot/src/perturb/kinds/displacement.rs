//! Displacements of drone and aim: drawn, and for the drone kept away from obstacles.

use crate::perturb::sizes::OffsetRange;
use cosfly_frames::{DVec3, real};
use cosfly_random::RandomStream;
use cosfly_surroundings::exact::ExactMap;

/// Kept beyond the asked clearance, so that rounding cannot take it away again, metres.
const ROUNDING_M: f64 = 1e-6;

/// Fresh draws of a displacement that is not free, before it is shortened.
const DRAWS: usize = 8;

/// Shares of the drawn lengths that are tried at last.
const SHARES: [f64; 4] = [0.75, 0.5, 0.25, 0.125];

/// Places where a displaced drone may be. World frame, metres.
pub(super) struct Corridor<'a> {
    /// All unsimplified boxes, and those that move.
    pub map: ExactMap<'a>,
    /// Frame at which the drone is displaced.
    pub frame: usize,
    /// Distance from obstacles along the whole swept path.
    pub clearance_m: f64,
    /// Lowest height.
    pub lowest_z_m: f64,
    /// Position of the twin one frame before.
    pub before: Option<DVec3>,
    /// Position of the expert one frame later: the twin must always be able to return there.
    pub after: Option<DVec3>,
}

impl Corridor<'_> {
    fn holds(&self, position: DVec3) -> bool {
        let kept_m = self.clearance_m + ROUNDING_M;
        let (frame, map) = (self.frame, self.map);
        let here = |to: DVec3| map.segment_clearance(frame, position, to, kept_m) >= kept_m;
        let is_reached = match self.before {
            Some(before) => map.segment_clearance(frame - 1, before, position, kept_m) >= kept_m,
            None => here(position),
        };
        position.z >= self.lowest_z_m && is_reached && self.after.is_none_or(here)
    }
}

/// A displacement of the drone that is free: fresh draws first, then shorter ones, then none.
pub(super) fn free_offset(
    corridor: &Corridor<'_>,
    from: DVec3,
    range: &OffsetRange,
    mut stream: RandomStream,
) -> DVec3 {
    let mut drawn = [DVec3::ZERO; DRAWS];
    for offset in &mut drawn {
        *offset = stream.uniform(range.min_m, range.max_m) * direction_on_sphere(&mut stream);
        if corridor.holds(from + *offset) {
            return *offset;
        }
    }
    for share in SHARES {
        if let Some(offset) = drawn.iter().map(|offset| share * *offset).find(|offset| corridor.holds(from + *offset)) {
            return offset;
        }
    }
    DVec3::ZERO
}

/// Uniform on the unit sphere (Archimedes: z is uniform).
fn direction_on_sphere(stream: &mut RandomStream) -> DVec3 {
    let z = stream.uniform(-1.0, 1.0);
    let (sin, cos) = real::sin_cos(stream.uniform(-real::PI, real::PI));
    let radius = (1.0 - z * z).max(0.0).sqrt();
    DVec3::new(radius * cos, radius * sin, z)
}

/// A horizontal displacement of the aim, uniform in direction.
pub(super) fn horizontal_offset(range: &OffsetRange, mut stream: RandomStream) -> DVec3 {
    let length = stream.uniform(range.min_m, range.max_m);
    let (sin, cos) = real::sin_cos(stream.uniform(-real::PI, real::PI));
    DVec3::new(length * cos, length * sin, 0.0)
}
