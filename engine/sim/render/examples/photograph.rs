//! A town as a scan whose truth is known: `photograph OUT.ply [TOWN.xodr] [X Y RADIUS_M]` writes splats, and `OUT.obj` beside them.
//!
//! Pictures from a ring of places around a point of the world become flat splats in the frame of the map: with `up_axis = "z"` they
//! stand over the same town, and over that of the mesh. Without a map file, a small invented town.

#[path = "../tests/photographed/mod.rs"]
mod photographed;
#[path = "../tests/small_town/mod.rs"]
mod small_town;

use cosfly_domain::{Camera, SemanticLabel};
use cosfly_frames::{DVec3, Pose, Seed, real};
use cosfly_maps::MapConfig;
use cosfly_render::{Scene, SceneTriangle};
use std::collections::BTreeMap;
use std::fmt::Write;

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
    std::fs::write(std::path::Path::new(&out).with_extension("obj"), mesh(&triangles))?;
    println!("{} splats, {} triangles", splats.len(), triangles.len());
    Ok(())
}

/// Triangles as OBJ (y up), thing by thing, with names that readers of meshes know.
fn mesh(triangles: &[SceneTriangle]) -> String {
    let mut things: BTreeMap<(u8, u32), Vec<&SceneTriangle>> = BTreeMap::new();
    triangles.iter().for_each(|triangle| things.entry((triangle.label, triangle.instance)).or_default().push(triangle));
    let (mut text, mut corners) = (String::from("# metres, y up\n"), 0);
    for ((label, instance), triangles) in things {
        let word = WORDS.iter().find(|(known, _)| known.id() == label).map_or("thing", |(_, word)| word);
        let _ = writeln!(text, "o {word}_{instance}");
        for triangle in triangles {
            for corner in triangle.corners_in_world {
                let _ = writeln!(text, "v {:.4} {:.4} {:.4}", corner.x, corner.z, corner.y);
            }
            let _ = writeln!(text, "f {} {} {}", corners + 1, corners + 2, corners + 3);
            corners += 3;
        }
    }
    text
}

/// Words of labels.
const WORDS: [(SemanticLabel, &str); 10] = [
    (SemanticLabel::Roads, "road"),
    (SemanticLabel::RoadLine, "roadline"),
    (SemanticLabel::SideWalks, "sidewalk"),
    (SemanticLabel::Building, "building"),
    (SemanticLabel::Wall, "wall"),
    (SemanticLabel::Fence, "fence"),
    (SemanticLabel::Pole, "pole"),
    (SemanticLabel::Vegetation, "tree"),
    (SemanticLabel::Terrain, "terrain"),
    (SemanticLabel::Car, "parked"),
];
