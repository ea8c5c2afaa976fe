//! From pixels to places: world points, pixel sizes on the surface, openness to the sky, haze.

use cosfly_frames::simd_kernel;
use cosfly_materials::grid::{GridFrame, GridTables};
use cosfly_materials::lanes::{Block, PendingFours, Shared, WIDE, get, groups, set, three_of};
use cosfly_materials::light::Light;
use cosfly_materials::pattern::{least, most, one_if};
use cosfly_materials::vector::Vec3;

/// The camera for shading, f32.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// Position, metres.
    pub position: Vec3,
    /// Direction through pixel coordinates (0, 0), depth 1.
    pub corner: Vec3,
    /// Change of the direction per pixel to the right.
    pub across: Vec3,
    /// Change of the direction per pixel downwards.
    pub down: Vec3,
    /// Differs from frame to frame.
    pub seed: u32,
}

impl View {
    /// Direction through pixel coordinates, of length 1 along the optical axis.
    #[inline(always)]
    pub fn ray(&self, u: f32, v: f32) -> Vec3 {
        self.corner + self.across * u + self.down * v
    }

    /// Size of a pixel at a distance of 1 along the optical axis.
    #[inline(always)]
    pub fn pixel(&self) -> f32 {
        self.across.dot(self.across).sqrt()
    }
}

/// A face's own horizontal and vertical (x and y on flat ground).
#[derive(Clone, Copy, Debug)]
pub struct FaceAxes {
    /// Horizontal unit vector.
    pub along: Vec3,
    /// The other one.
    pub up: Vec3,
}

simd_kernel! {
    /// Fills in what fours share that follows from pixel, depth and normal; turns normals to the camera.
    pub fn place(shared: &mut [Shared], stage: &PendingFours, view: &View, light: &Light) {
        let view = *view;
        let (haze_start_m, haze_per_m) = (light.haze_start_m, light.haze_per_m);
        for (group, shared) in shared.iter_mut().enumerate() {
            let [u, v] = [&stage.u, &stage.v].map(|row| PendingFours::lane(row, group));
            let [inverse, across, down] =
                [&stage.inverse, &stage.across, &stage.down].map(|row| PendingFours::lane(row, group));
            let [x, y, z] = &stage.normal;
            let normals = [x, y, z].map(|row| PendingFours::lane(row, group));
            for k in 0..WIDE {
                let ray = view.ray(u[k] + MIDDLE, v[k]);
                let depth = 1.0 / inverse_at(inverse[k], across[k], MIDDLE);
                // One pixel aside moves along the ray by as much as depth changes over the plane.
                let (aside, below) = (-depth * depth * across[k], -depth * depth * down[k]);
                let (along, up) = (three_of(&stage.along, group, k), three_of(&stage.up, group, k));
                let [across_along, down_along] = [view.across.dot(along), view.down.dot(along)];
                let [across_up, down_up] = [view.across.dot(up), view.down.dot(up)];
                let (ray_along, ray_up) = (ray.dot(along), ray.dot(up));
                let along_m =
                    (across_along * depth + ray_along * aside).abs() + (down_along * depth + ray_along * below).abs();
                let up_m = (across_up * depth + ray_up * aside).abs() + (down_up * depth + ray_up * below).abs();
                let drawn = Vec3::new(normals[0][k], normals[1][k], normals[2][k]);
                let normal = drawn * (1.0 - 2.0 * one_if(ray.dot(drawn) > 0.0));
                set(&mut shared.ray, k, ray);
                set(&mut shared.middle, k, view.position + ray * depth);
                set(&mut shared.normal, k, normal);
                shared.along_m[k] = along_m;
                shared.up_m[k] = up_m;
                shared.footprint_m[k] = 0.5 * least(along_m + up_m, 4.0 * least(along_m, up_m));
                let far = most(depth * ray.dot(ray).sqrt() - haze_start_m, 0.0);
                shared.kept[k] = fast_exp(-haze_per_m * far);
            }
        }
    }
}

simd_kernel! {
    /// Fills in the place of each pixel.
    pub fn points(shared: &[Shared], blocks: &mut [Block], stage: &PendingFours, view: &View) {
        let view = *view;
        for (group, (shared, four)) in groups(shared, blocks).enumerate() {
            let [u, v] = [&stage.u, &stage.v].map(|row| PendingFours::lane(row, group));
            let [inverse, across] = [&stage.inverse, &stage.across].map(|row| PendingFours::lane(row, group));
            for (pixel, block) in four.iter_mut().enumerate() {
                let aside = pixel as i32 as f32;
                for k in 0..WIDE {
                    let ray = view.ray(u[k] + aside, v[k]);
                    let depth = 1.0 / inverse_at(inverse[k], across[k], aside);
                    set(&mut block.world, k, view.position + ray * depth);
                }
                block.normal = shared.normal;
            }
        }
    }
}

simd_kernel! {
    /// Fills in how much sky and light of lamps places see.
    pub fn open(shared: &mut [Shared], grid: &GridTables, frame: &GridFrame, night: bool) {
        let frame = *frame;
        for shared in shared.iter_mut() {
            for k in 0..WIDE {
                let (middle, normal) = (get(&shared.middle, k), get(&shared.normal, k));
                let off_wall_m = 1.2 * (1.0 - normal.z.abs());
                let cell = frame.place(middle.x + normal.x * off_wall_m, middle.y + normal.y * off_wall_m);
                let (sky, above) = (cell.sky(grid), middle.z - cell.ground_m(grid));
                shared.sky[k] = 0.36 + 0.64 * (sky + (1.0 - sky) * least(most(above * 0.045, 0.0), 0.85));
                shared.lamps[k] = 0.0;
            }
            if night {
                for k in 0..WIDE {
                    let (middle, normal) = (get(&shared.middle, k), get(&shared.normal, k));
                    let off_wall_m = 1.2 * (1.0 - normal.z.abs());
                    let cell = frame.place(middle.x + normal.x * off_wall_m, middle.y + normal.y * off_wall_m);
                    let above = middle.z - cell.ground_m(grid);
                    shared.lamps[k] = cell.lamps(grid) * most(1.0 - above * 0.11, 0.0);
                }
            }
        }
    }
}

/// From the first pixel of a four to its middle, pixels.
const MIDDLE: f32 = 1.5;

/// Inverse depth so many pixels to the right; where a four reaches beyond its face, never beyond the horizon.
#[inline(always)]
fn inverse_at(inverse: f32, across: f32, pixels: f32) -> f32 {
    most(inverse + across * pixels, 0.25 * inverse)
}

/// e^x for x <= 0, to about 1e-4: (1 + x/256)^256.
#[inline(always)]
pub fn fast_exp(x: f32) -> f32 {
    let mut base = most(1.0 + x * (1.0 / 256.0), 0.0);
    for _ in 0..8 {
        base *= base;
    }
    base
}
