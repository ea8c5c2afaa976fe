//! A town as a scan whose truth is known: `photograph OUT.ply [TOWN.xodr] [X Y RADIUS_M]` writes splats, and `OUT.obj` beside them.
//!
//! Pictures from a ring of places around a point of the world become flat splats in the frame of the map: with `up_axis = "z"` they
//! stand over the same town, and over that of the mesh, whose corners have colours by label. Without a map file, a small invented town.

#[path = "../tests/meshed/mod.rs"]
mod meshed;
#[path = "../tests/photographed/mod.rs"]
mod photographed;
#[path = "../tests/small_town/mod.rs"]
mod small_town;

use cosfly_domain::Camera;
use cosfly_frames::{DVec3, Pose, Seed, real};
use cosfly_maps::MapConfig;
use cosfly_render::Scene;

/// Places of the ring, and their heights over the ground, metres.
const AROUND: u32 = 12;
const HEIGHTS_M: [f64; 3] = [3.0, 9.0, 25.0];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1).peekable();
    let out = arguments.next().ok_or("usage: photograph OUT.ply [TOWN.xodr] [X Y RADIUS_M]")?;
    let map = arguments.next_if(|argument| argument.ends_with(".xodr"));
    let numbers = arguments.map(|argument| argument.parse::<f64>()).collect::<Result<Vec<_>, _>>()?;
    let &[x, y, radius_m] = numbers.first_chunk::<3>().unwrap_or(&[-8.0, 13.5, 25.0]);
    let town = match &map {
        None => small_town::small_town(2, 1),
        Some(path) => {
            cosfly_maps::read_town(&std::fs::read(path)?, &MapConfig::default(), Seed([5; 32]))
                .map_err(|error| format!("{path}: {error}"))?
                .0
        }
    };
    let scene = Scene::new(&town, Seed([1; 32]));
    let camera = Camera { width: 960, height: 640, horizontal_fov_rad: 1.4 };
    let middle = DVec3::new(x, y, 1.0);
    let pose = |(number, height_m): (u32, f64)| {
        let (sin, cos) = real::sin_cos(real::TAU * f64::from(number) / f64::from(AROUND));
        Pose::looking_at(middle + DVec3::new(radius_m * cos, radius_m * sin, height_m), middle)
    };
    let poses: Vec<Pose> =
        HEIGHTS_M.into_iter().flat_map(|height_m| (0..AROUND).map(move |number| pose((number, height_m)))).collect();
    let splats = photographed::splats_of(&scene, camera, &poses, 0.05);
    std::fs::write(&out, cosfly_splats::to_ply(&splats))?;
    let triangles = scene.triangles();
    std::fs::write(std::path::Path::new(&out).with_extension("obj"), meshed::obj_of(&triangles))?;
    println!("{} splats, {} triangles", splats.len(), triangles.len());
    Ok(())
}
