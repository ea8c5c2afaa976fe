//! Splats of a town whose truth is known: pixels of its pictures as flat ellipsoids on the surfaces that they show.

use cosfly_domain::{Camera, FrameImages, Optics};
use cosfly_frames::{DMat3, DQuat, DVec3, Pose};
use cosfly_render::{FrameSetup, Renderer, Scene};
use cosfly_splats::Splat;
use std::collections::BTreeMap;

/// Largest distance of a pixel's neighbours on its surface, sides of cubes: what is seen from afar, another picture shows from near.
const LARGEST: f64 = 4.0;
/// Spread across a surface, metres.
const THIN_M: f32 = 0.01;

/// Splats of what the poses see, in the map's frame (right-handed, z up): the finest in each cube of `cell_m`.
pub fn splats_of(scene: &Scene, camera: Camera, poses: &[Pose], cell_m: f64) -> Vec<Splat> {
    let mut renderer = Renderer::new(camera);
    renderer.set_optics(Optics::IDEAL);
    let weather = cosfly_materials::presets::preset("ClearNoon").expect("a preset");
    let mut finest: BTreeMap<[i32; 3], Splat> = BTreeMap::new();
    let size = |splat: &Splat| splat.spread[0].max(splat.spread[1]);
    for pose in poses {
        let setup = FrameSetup { pose: *pose, weather: &weather, target: None, others: &[] };
        let images = renderer.render(scene, &setup).images;
        for row in 0..camera.height as usize - 1 {
            for column in 0..camera.width as usize - 1 {
                let Some(splat) = splat_at(images, &camera, pose, [column, row]) else { continue };
                if f64::from(size(&splat)) > 0.6 * LARGEST * cell_m {
                    continue;
                }
                let cell = splat.middle.map(|at| (f64::from(at) / cell_m).floor() as i32);
                let own = finest.entry(cell).or_insert(splat);
                if size(&splat) < size(own) {
                    *own = splat;
                }
            }
        }
    }
    finest.into_values().collect()
}

/// The splat of a pixel whose neighbours are of the same surface.
fn splat_at(images: &FrameImages, camera: &Camera, pose: &Pose, [column, row]: [usize; 2]) -> Option<Splat> {
    let width = camera.width as usize;
    let at = row * width + column;
    let beside = [at, at + 1, at + width];
    let is_one = |pixel: &usize| images.instance[*pixel] == images.instance[at] && images.depth_m[*pixel].is_finite();
    if !beside.iter().all(is_one) {
        return None;
    }
    let (centre, focal_px) = ([0.5 * f64::from(camera.width), 0.5 * f64::from(camera.height)], camera.focal_px());
    let in_map = |pixel: usize| {
        let depth_m = f64::from(images.depth_m[pixel]);
        let [u, v] = [pixel % width, pixel / width].map(|place| place as f64 + 0.5);
        let in_body = depth_m * DVec3::new(1.0, (u - centre[0]) / focal_px, (centre[1] - v) / focal_px);
        let in_world = pose.position_in_world + pose.world_from_body() * in_body;
        DVec3::new(in_world.x, -in_world.y, in_world.z)
    };
    let [middle, right, below] = beside.map(in_map);
    let (across, down) = (right - middle, below - middle);
    let first = across.try_normalize()?;
    let normal = first.cross(down).try_normalize()?;
    let second = normal.cross(first);
    let turn = DQuat::from_mat3(&DMat3::from_cols(first, second, normal)).as_quat();
    let spread = [0.6 * across.length() as f32, 0.6 * down.dot(second).abs() as f32, THIN_M];
    let colour = [0, 1, 2].map(|channel| f32::from(images.rgb[3 * at + channel]) / 255.0);
    Some(Splat::plain(middle.as_vec3().to_array(), spread, [turn.w, turn.x, turn.y, turn.z], 0.97, colour))
}
