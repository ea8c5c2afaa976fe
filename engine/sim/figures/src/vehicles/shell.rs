//! Sheet and glass of a vehicle: a grid of points from sill to roof and tail to nose, mirrored, with smooth normals.

use super::model::Model;
use crate::region::Region;
use cosfly_frames::DVec3;

/// Points of a cross-section from the sill to the middle of the roof.
pub(super) const POINTS: usize = 8;
/// Most cross-sections of a shell.
pub(super) const MOST_SECTIONS: usize = 20;
/// Faces round into each other where the cosine of their angle is greater.
const SMOOTH: f64 = 0.72;
/// Point of a cross-section along which sheet is creased: its faces do not round into each other there.
const CREASED: usize = 2;

/// The right half of a body, own axes, metres: cross-sections from tail to nose.
pub(super) struct Shell {
    pub points: [[DVec3; POINTS]; MOST_SECTIONS],
    /// Materials of the faces between a cross-section and the next one, upwards; the glass of none rounds into sheet.
    pub regions: [[Region; POINTS - 1]; MOST_SECTIONS],
    pub count: usize,
}

impl Shell {
    /// Draws both halves and the flat ends.
    pub fn draw(&self, model: &mut Model<'_>) {
        let faces = self.count.min(MOST_SECTIONS).saturating_sub(1);
        let mut normals = [[DVec3::ZERO; POINTS - 1]; MOST_SECTIONS];
        for (along, row) in normals.iter_mut().enumerate().take(faces) {
            for (up, normal) in row.iter_mut().enumerate() {
                let [a, b, c, d] = self.corners(along, up);
                *normal = (d - b).cross(c - a);
            }
        }
        for along in 0..faces {
            for up in 0..POINTS - 1 {
                let corners = self.corners(along, up);
                let own = normals[along][up].normalize_or_zero();
                let places = [(along, up), (along + 1, up), (along + 1, up + 1), (along, up + 1)];
                let smooth = places.map(|place| self.smooth(&normals[..faces], (along, up), own, place));
                for side in [1.0, -1.0] {
                    let turn = |v: DVec3| DVec3::new(v.x, side * v.y, v.z);
                    let (corners, smooth) = (corners.map(turn), smooth.map(turn));
                    for [i, j, k] in [[0, 1, 2], [0, 2, 3]] {
                        let flat = (corners[k] - corners[i]).cross(corners[j] - corners[i]) * side;
                        if flat.length_squared() > 1e-12 {
                            let corners = [corners[i], corners[j], corners[k]];
                            let flat = flat.normalize();
                            // Where sheet is warped, a triangle is flat.
                            let bent = |n: usize| if smooth[n].dot(flat) > 0.4 { smooth[n] } else { flat };
                            model.triangle(self.regions[along][up], corners, flat, [i, j, k].map(bent));
                        }
                    }
                }
            }
        }
        for end in [0, faces] {
            self.close(model, end);
        }
    }

    /// Corners of a face: two of a cross-section and the next one, upwards.
    fn corners(&self, along: usize, up: usize) -> [DVec3; 4] {
        let (near, far) = (&self.points[along], &self.points[along + 1]);
        [near[up], far[up], far[up + 1], near[up + 1]]
    }

    /// The normal at a point as a face sees it: that of all faces around it which are nearly in one plane with the face.
    fn smooth(
        &self,
        normals: &[[DVec3; POINTS - 1]],
        face: (usize, usize),
        own: DVec3,
        (along, up): (usize, usize),
    ) -> DVec3 {
        let is_glass = |(along, up): (usize, usize)| self.regions[along][up] == Region::Glass;
        let mut sum = own * 1e-9;
        for (back, down) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let place = (along.wrapping_sub(back), up.wrapping_sub(down));
            let Some(normal) = normals.get(place.0).and_then(|row| row.get(place.1)) else { continue };
            let is_beyond = up == CREASED && place.1 != face.1;
            if is_glass(place) == is_glass(face) && !is_beyond && normal.normalize_or_zero().dot(own) > SMOOTH {
                sum += *normal;
            }
        }
        // In the middle, both halves meet.
        let sum = if up == POINTS - 1 { sum.with_y(0.0) } else { sum };
        let sum = sum.normalize_or_zero();
        if sum == DVec3::ZERO { own } else { sum }
    }

    /// The flat end at a cross-section, in level strips.
    fn close(&self, model: &mut Model<'_>, end: usize) {
        let section = &self.points[end];
        let inside = DVec3::new(0.0, 0.0, section[2].z);
        let left = section.map(|point| point.with_y(-point.y));
        for up in 0..POINTS - 2 {
            model.face(Region::Paint, &[section[up], section[up + 1], left[up + 1], left[up]], inside);
        }
        model.face(Region::Paint, &[section[POINTS - 2], section[POINTS - 1], left[POINTS - 2]], inside);
    }
}
