//! [`Patch`]: a flat convex part of a town's surface, with the raster of its picture.

use cosfly_frames::{DVec2, DVec3, Pose, real};

/// Most pixels along a side: longer patches have larger pixels.
const MOST_SIDE: f64 = 2048.0;
/// Pixels around a patch: textures are read a little beyond its edge.
const MARGIN: f64 = 1.0;

/// A flat convex part of a town's surface, and its picture.
pub struct Patch {
    /// Corners, metres.
    pub corners_in_world: Vec<DVec3>,
    /// CARLA label id.
    pub label: u8,
    /// Instance id; 0 for ground.
    pub instance: u32,
    /// Which of two layers of ground in one place lies on top: the greater one.
    pub lift: f64,
    /// Attitude of a camera that looks straight at it.
    pub attitude: Pose,
    /// Upper left corner of the raster, metres.
    pub corner_in_world: DVec3,
    /// Directions of rows and of columns, unit length.
    pub axes: [DVec3; 2],
    /// Side of a pixel, metres.
    pub texel_m: f64,
    /// Pixels across and down.
    pub size: [usize; 2],
    /// sRGB, row by row; empty until it is painted.
    pub rgb: Vec<[u8; 3]>,
}

impl Patch {
    /// A patch with a unit normal to the side that is seen; none where the corners span no surface.
    pub fn new(corners_in_world: Vec<DVec3>, normal: DVec3, texel_m: f64) -> Option<Self> {
        let sides = corners_in_world.iter().zip(corners_in_world.iter().cycle().skip(1)).map(|(from, to)| *to - *from);
        let longest = sides.max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()))?;
        let right = longest.reject_from_normalized(normal).try_normalize()?;
        let attitude = attitude(-normal, right);
        let axes = attitude.world_from_body();
        let axes = [axes.y_axis, -axes.z_axis];
        let first = corners_in_world[0];
        let places = || corners_in_world.iter().map(|corner| DVec2::from(axes.map(|axis| axis.dot(*corner - first))));
        let low = places().fold(DVec2::INFINITY, DVec2::min);
        let extent = places().fold(DVec2::NEG_INFINITY, DVec2::max) - low;
        if !(extent.is_finite() && extent.min_element() > 1e-6) {
            return None;
        }
        let texel_m = texel_m.max(extent.max_element() / (MOST_SIDE - 2.0 * MARGIN));
        let corner = low - MARGIN * texel_m;
        let size = [extent.x, extent.y].map(|length| (length / texel_m + 2.0 * MARGIN).ceil() as usize);
        let corner_in_world = first + axes[0] * corner.x + axes[1] * corner.y;
        let (label, instance, lift, rgb) = (0, 0, 0.0, vec![]);
        Some(Self { corners_in_world, label, instance, lift, attitude, corner_in_world, axes, texel_m, size, rgb })
    }

    /// The place of a pixel coordinate, metres.
    pub fn in_world(&self, [across, down]: [f64; 2]) -> DVec3 {
        self.corner_in_world + (self.axes[0] * across + self.axes[1] * down) * self.texel_m
    }

    /// The pixel coordinate of a place.
    pub fn in_picture(&self, point_in_world: DVec3) -> [f64; 2] {
        self.axes.map(|axis| axis.dot(point_in_world - self.corner_in_world) / self.texel_m)
    }

    /// Pixels whose centres lie in the patch, as numbers of its raster.
    pub fn covered(&self) -> Vec<usize> {
        let corners: Vec<DVec2> = self.corners_in_world.iter().map(|it| DVec2::from(self.in_picture(*it))).collect();
        let sides: Vec<[DVec2; 2]> =
            (0..corners.len()).map(|at| [corners[at], corners[(at + 1) % corners.len()]]).collect();
        let turn = |[from, to]: [DVec2; 2], point: DVec2| (to - from).perp_dot(point - from);
        let sign = sides.iter().map(|side| turn(*side, corners[0])).sum::<f64>();
        let sign = if sign == 0.0 { turn(sides[0], corners[2 % corners.len()]).signum() } else { sign.signum() };
        let is_inside = |pixel: &usize| {
            let [column, row] = [pixel % self.size[0], pixel / self.size[0]].map(|at| at as f64 + 0.5);
            sides.iter().all(|side| sign * turn(*side, DVec2::new(column, row)) >= 0.0)
        };
        (0..self.size[0] * self.size[1]).filter(is_inside).collect()
    }

    /// Mean colour of a square of pixels, 0 to 1.
    pub fn mean_srgb(&self, [left, top]: [usize; 2], side: usize) -> [f32; 3] {
        let pixels = (top..top + side).flat_map(|row| &self.rgb[row * self.size[0] + left..][..side]);
        let sum = pixels.fold([0; 3], |sum, pixel| [0, 1, 2].map(|k| sum[k] + u32::from(pixel[k])));
        sum.map(|sum| sum as f32 / (255 * side * side) as f32)
    }

    /// The place of a pixel's centre, metres.
    pub fn pixel_in_world(&self, pixel: usize) -> DVec3 {
        self.in_world([pixel % self.size[0], pixel / self.size[0]].map(|at| at as f64 + 0.5))
    }
}

/// The attitude of a camera by its axis and by the direction to its right, both unit length.
fn attitude(forward: DVec3, right: DVec3) -> Pose {
    let upright = Pose::looking_at(DVec3::ZERO, forward);
    let axes = upright.world_from_body();
    Pose { roll_rad: real::atan2(-right.dot(axes.z_axis), right.dot(axes.y_axis)), ..upright }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_lie_along_the_longest_side_and_cover_the_patch() {
        for normal in [DVec3::Z, -DVec3::Y, DVec3::new(0.6, 0.0, 0.8)] {
            let along = normal.any_orthonormal_vector();
            let across = normal.cross(along);
            let corner = DVec3::new(10.0, -4.0, 3.0);
            let corners = vec![corner, corner + 4.0 * along, corner + 4.0 * along + across, corner + across];
            let patch = Patch::new(corners, normal, 0.1).expect("a surface");
            assert!((40..=43).contains(&patch.size[0]) && (10..=13).contains(&patch.size[1]), "{:?}", patch.size);
            let covered = patch.covered();
            assert!((380..=420).contains(&covered.len()), "{}", covered.len());
            for pixel in covered {
                assert!((patch.pixel_in_world(pixel) - corner).dot(normal).abs() < 1e-9);
            }
            let [u, v] = patch.in_picture(patch.in_world([7.0, 2.5]));
            assert!((u - 7.0).abs() < 1e-9 && (v - 2.5).abs() < 1e-9);
        }
        assert!(Patch::new(vec![DVec3::ZERO; 3], DVec3::Z, 0.1).is_none());
    }
}
