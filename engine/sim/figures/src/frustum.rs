//! Parts of figures: hexagonal frustums between two rings, and their triangles in the world.

use crate::region::Region;
use cosfly_frames::{DVec3, real};

/// Sides of every frustum.
pub const SIDES: usize = 6;

/// One end of a frustum, in body heights. Its corner `k` lies at `forward + half_forward * cos`, `right + half_side * sin` of
/// `k` turns in [`SIDES`].
#[derive(Clone, Copy)]
#[expect(missing_docs, reason = "the names say it")]
pub struct Ring {
    pub forward: f64,
    pub right: f64,
    /// Below 0 counts as 0.
    pub up: f64,
    pub half_side: f64,
    pub half_forward: f64,
}

pub(crate) fn ring(forward: f64, right: f64, up: f64, half_side: f64, half_forward: f64) -> Ring {
    Ring { forward, right, up, half_side, half_forward }
}

/// Sine and cosine of the direction of each side of a frustum.
pub(crate) fn around() -> [(f64, f64); SIDES] {
    core::array::from_fn(|k| real::sin_cos(real::TAU * k as f64 / SIDES as f64))
}

/// A part of a figure between two level rings.
#[derive(Clone, Copy)]
pub struct FigurePart {
    /// One end.
    pub low: Ring,
    /// The other end.
    pub high: Ring,
    /// Material.
    pub region: Region,
}

/// A triangle of the figure, corners in the world frame.
#[derive(Clone, Copy, Debug)]
pub struct FigureTriangle {
    /// Corners, metres.
    pub corners_in_world: [DVec3; 3],
    /// Away from the part's inside, unit length.
    pub normal_in_world: DVec3,
    /// Normals of the surface at the corners, as light sees it: those of a vehicle's sheet differ from the triangle's own.
    pub corner_normals: [[f32; 3]; 3],
    /// The ends of its part's middle line: the part is round around it.
    pub middle_in_world: [DVec3; 2],
    /// Material.
    pub region: Region,
    /// Owner: index among the people of a frame.
    pub person: u32,
    /// The part of the body that it belongs to.
    pub part: u32,
}

/// Triangles of a figure in the world.
pub(crate) struct Surface<'a> {
    pub feet: DVec3,
    pub forward: DVec3,
    pub right: DVec3,
    pub height: f64,
    /// Sine and cosine of the direction of each side.
    pub around: [(f64, f64); SIDES],
    pub person: u32,
    /// Parts built so far.
    pub parts: u32,
    pub triangles: &'a mut Vec<FigureTriangle>,
}

impl Surface<'_> {
    /// A closed hexagonal frustum between two rings.
    pub(crate) fn part(&mut self, low: Ring, high: Ring, region: Region) {
        let corner = |ring: &Ring, k: usize| {
            let (sin, cos) = self.around[k];
            self.feet
                + self.height
                    * (self.forward * (ring.forward + ring.half_forward * cos)
                        + self.right * (ring.right + ring.half_side * sin)
                        + DVec3::Z * ring.up.max(0.0))
        };
        let center = |ring: &Ring| {
            self.feet
                + self.height * (self.forward * ring.forward + self.right * ring.right + DVec3::Z * ring.up.max(0.0))
        };
        let middle_in_world = [center(&low), center(&high)];
        let inside = 0.5 * (middle_in_world[0] + middle_in_world[1]);
        let mut faces = [[DVec3::ZERO; 3]; 4 * SIDES];
        let [lows, highs] = [&low, &high].map(|ring| core::array::from_fn::<_, SIDES, _>(|k| corner(ring, k)));
        for k in 0..SIDES {
            let next = (k + 1) % SIDES;
            let (a, b, c, d) = (lows[k], lows[next], highs[k], highs[next]);
            faces[4 * k] = [a, b, c];
            faces[4 * k + 1] = [c, b, d];
            faces[4 * k + 2] = [middle_in_world[0], b, a];
            faces[4 * k + 3] = [middle_in_world[1], c, d];
        }
        for corners_in_world in faces {
            let [a, b, c] = corners_in_world;
            let normal = (b - a).cross(c - a).normalize_or_zero();
            let outward = if normal.dot(a - inside) < 0.0 { -normal } else { normal };
            if outward != DVec3::ZERO {
                self.triangles.push(FigureTriangle {
                    corners_in_world,
                    normal_in_world: outward,
                    corner_normals: [outward.as_vec3().to_array(); 3],
                    middle_in_world,
                    region,
                    person: self.person,
                    part: self.parts,
                });
            }
        }
        self.parts += 1;
    }
}
