//! Flat faces in the world frame: normals, cutting at a height, outlines in plan.

use cosfly_frames::{DVec2, DVec3};

/// Faces that lean less from the vertical are walls, vertical part of the unit normal.
const WALL_NORMAL: f64 = 0.1;

/// A polygon in space, world frame, metres; the outer ring first.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Face {
    pub(super) rings: Vec<Vec<DVec3>>,
}

impl Face {
    /// Twice the area as a vector along the normal.
    fn normal(&self) -> DVec3 {
        let Some((first, ring)) = self.rings.first().and_then(|ring| ring.split_first()) else { return DVec3::ZERO };
        ring.windows(2).map(|pair| (pair[0] - *first).cross(pair[1] - *first)).sum()
    }

    /// Share of the normal that is vertical; 0 for walls and for faces without an area.
    pub(super) fn level_share(&self) -> f64 {
        let normal = self.normal();
        if normal.length() < 1e-9 { 0.0 } else { normal.z.abs() / normal.length() }
    }

    pub(super) fn is_wall(&self) -> bool {
        self.level_share() < WALL_NORMAL
    }

    pub(super) fn corners(&self) -> impl Iterator<Item = DVec3> {
        self.rings.iter().flatten().copied()
    }

    /// The face with all corners at one height.
    pub(super) fn levelled(&self, height_m: f64) -> Self {
        let ring = |ring: &Vec<DVec3>| ring.iter().map(|corner| corner.with_z(height_m)).collect();
        Self { rings: self.rings.iter().map(ring).collect() }
    }

    pub(super) fn highest_m(&self) -> f64 {
        self.corners().map(|corner| corner.z).fold(f64::NEG_INFINITY, f64::max)
    }

    pub(super) fn lowest_m(&self) -> f64 {
        self.corners().map(|corner| corner.z).fold(f64::INFINITY, f64::min)
    }

    /// Rings in plan of the part above a height. Two faces that share a side get the same corners on it.
    pub(super) fn plan_above(&self, height_m: f64) -> Vec<Vec<DVec2>> {
        self.rings.iter().map(|ring| plan_above(ring, height_m)).collect()
    }

    /// Height of the face's plane over a point of the plan.
    pub(super) fn height_m(&self, at: DVec2) -> f64 {
        let normal = self.normal();
        let Some(first) = self.rings.first().and_then(|ring| ring.first()) else { return 0.0 };
        if normal.z.abs() < 1e-9 {
            return first.z;
        }
        first.z - normal.truncate().dot(at - first.truncate()) / normal.z
    }
}

fn plan_above(ring: &[DVec3], height_m: f64) -> Vec<DVec2> {
    let mut out = Vec::with_capacity(ring.len() + 2);
    for i in 0..ring.len() {
        let (a, b) = (ring[i], ring[(i + 1) % ring.len()]);
        if a.z >= height_m {
            out.push(a.truncate());
        }
        if (a.z >= height_m) != (b.z >= height_m) {
            let (low, high) = if a.z < b.z { (a, b) } else { (b, a) };
            out.push(low.truncate().lerp(high.truncate(), (height_m - low.z) / (high.z - low.z)));
        }
    }
    out
}

/// All faces' rings in plan: outer rings, holes.
pub(super) fn plan_of(rings_of_faces: &[Vec<Vec<DVec2>>]) -> (Vec<&[DVec2]>, Vec<&[DVec2]>) {
    let (mut outer, mut holes) = (Vec::new(), Vec::new());
    for rings in rings_of_faces {
        for (index, ring) in rings.iter().enumerate().filter(|(_, ring)| ring.len() > 2) {
            if index == 0 { outer.push(ring.as_slice()) } else { holes.push(ring.as_slice()) }
        }
    }
    (outer, holes)
}
