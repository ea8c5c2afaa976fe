//! Normals of sheet and glass as light sees them: between the corners of a triangle they turn evenly.

use super::geometry::View;
use super::setting::Seen;
use crate::faces::FaceSource;
use cosfly_materials::lanes::PendingFours;
use cosfly_materials::vector::Vec3;

/// From the first pixel of a four to its middle, pixels.
const MIDDLE: f32 = 1.5;
/// Least cosine between a normal and the way to the camera.
const GRAZING: f32 = 0.02;

/// The normals of a triangle.
#[derive(Clone, Copy)]
pub(super) struct Curve {
    /// First corner, metres.
    corner: Vec3,
    /// Its normal.
    normal: Vec3,
    /// Changes of the normal towards both other corners.
    changes: [Vec3; 2],
    /// A way times these is how far it leads towards both other corners.
    shares: [Vec3; 2],
}

impl Curve {
    /// The normals of a face of a vehicle; none of flat faces.
    pub fn of(seen: &Seen<'_>, face: u32) -> Option<Self> {
        let FaceSource::Figure { look, triangle, .. } = seen.faces.get(face as usize)?.source else { return None };
        let person = seen.people.members.get(seen.people.looks.get(look as usize)?.person as usize)?;
        let number = person.triangles.start + triangle as usize;
        let triangle = seen.people.triangles.get(number).filter(|_| person.triangles.contains(&number))?;
        let [normal, second, third] = triangle.corner_normals.map(|[x, y, z]| Vec3::new(x, y, z));
        if normal == second && normal == third {
            return None;
        }
        let [corner, right, left] = triangle.corners_in_world;
        let (right, left) = (right - corner, left - corner);
        let (rr, rl, ll) = (right.dot(right), right.dot(left), left.dot(left));
        let area2 = rr * ll - rl * rl;
        if area2 <= 1e-12 {
            return None;
        }
        let shares = [(right * ll - left * rl) / area2, (left * rr - right * rl) / area2].map(Vec3::from);
        Some(Self { corner: corner.into(), normal, changes: [second - normal, third - normal], shares })
    }

    /// Turns the normals of fours on the stage.
    pub fn bend(&self, view: &View, stage: &mut PendingFours, first: usize, fours: usize) {
        for four in first..first + fours {
            let ray = view.ray(stage.u[four] + MIDDLE, stage.v[four]);
            let inverse = stage.inverse[four];
            let depth = 1.0 / (inverse + stage.across[four] * MIDDLE).max(0.25 * inverse);
            let way = view.position + ray * depth - self.corner;
            let [right, left] = self.shares.map(|share| way.dot(share));
            let (right, left) = (right.clamp(0.0, 1.0), left.clamp(0.0, 1.0));
            let bent = (self.normal + self.changes[0] * right + self.changes[1] * left).unit();
            // No normal looks away from the camera that sees it.
            let ray = ray.unit();
            let normal = (bent - ray * (bent.dot(ray) + GRAZING).max(0.0)).unit();
            let [x, y, z] = &mut stage.normal;
            (x[four], y[four], z[four]) = (normal.x, normal.y, normal.z);
        }
    }
}
