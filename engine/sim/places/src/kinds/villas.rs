//! `villas`: winding streets of large houses far apart, behind hedges and walls, with old trees, pools and drives.

use super::around::Around;
use super::houses::{Houses, scatter};
use super::kind::{Key, PlaceKind, PlaceSettings};
use super::mesh::{Mesh, distances_m};
use super::pavements::Furniture;
use super::sports::sports_field;
use crate::geometry::{bounds, contains, convex_core, grown, inset, long_axis, rectangle};
use crate::net::plan::Profile;
use crate::site::{Site, Surface};
use cosfly_frames::{DVec2, RandomStream, Seed, real};

/// The kind.
pub const KIND: PlaceKind = PlaceKind {
    name: "villas",
    doc: "Winding streets of large houses in gardens, hedges, old trees, pools",
    keys: &[
        Key { name: "size_m", doc: "Width of the place, metres", range: [220.0, 900.0], default: 400.0 },
        Key { name: "tree_share", doc: "Trees in the gardens, 1 is many", range: [0.0, 1.0], default: 0.6 },
        Key { name: "pools", doc: "Pools of a block, at most", range: [0.0, 12.0], default: 4.0 },
    ],
    build,
};

fn build(settings: &PlaceSettings, seed: Seed) -> Site {
    let mut stream = seed.stream("streets");
    let size_m = settings.get("size_m");
    let mesh = Mesh {
        columns_m: distances_m(size_m, 135.0, 0.15, &mut stream),
        rows_m: distances_m(size_m, 105.0, 0.1, &mut stream),
        heading_rad: stream.uniform(-0.8, 0.8),
        jitter_m: 8.0,
        bend_m: 10.0,
    };
    let profile = Profile { lanes: 1, lane_m: 3.0, sidewalk_m: 2.8, corner_m: 5.0 };
    let mut site = Site::of(&mesh.plan(&mut stream, |_| Some(profile)));
    let houses = Houses {
        in_a_row: [1, 1],
        width_m: [12.0, 18.0],
        depth_m: [10.0, 13.5],
        setback_m: [7.0, 13.0],
        gap_m: [9.0, 16.0],
        eaves_m: [4.5, 7.5],
        garden_m: 17.0,
        density: 0.93,
        hedges: 0.85,
        cars: 0.7,
        drive_onto_m: 0.0,
        trees: 0.9,
    };
    let blocks = site.blocks();
    for (number, block) in blocks.iter().enumerate() {
        let mut stream = seed.child("block", number as u64).stream("gardens");
        let core = convex_core(&block.outline);
        for front in &block.fronts {
            houses.along(&mut site, front, &mut stream);
        }
        if number == 0 {
            let (along, _) = long_axis(&core);
            sports_field(&mut site, crate::geometry::middle(&core), along, DVec2::new(23.8, 11.0), true);
        }
        pools(&mut site, &core, settings.get("pools") as usize, &mut stream);
        scatter(&mut site, &inset(&core, 2.0), (90.0 * settings.get("tree_share")) as usize, [2.2, 4.8], &mut stream);
    }
    let mut stream = seed.stream("edge");
    for face in site.faces.clone().iter().filter(|face| !face.is_enclosed) {
        for front in &face.fronts {
            houses.along(&mut site, front, &mut stream);
        }
    }
    Furniture { tree_share: 0.35, crown_m: 2.6, lamp_m: 5.0 }.put(&mut site, &mut seed.stream("pavements"));
    Around { fields: 2, trees: 700, rows: 1, eaves_m: [5.0, 7.5] }.put(&mut site, seed);
    site
}

/// Pools with slabs around them, where gardens have room.
fn pools(site: &mut Site, core: &[DVec2], count: usize, stream: &mut RandomStream) {
    let [low, high] = bounds(core);
    for _ in 0..count {
        let at = DVec2::new(stream.uniform(low.x, high.x), stream.uniform(low.y, high.y));
        let (sin, cos) = real::sin_cos(stream.uniform(0.0, real::PI));
        let pool = rectangle(at, DVec2::new(cos, sin), DVec2::new(9.0, 4.2));
        let slabs = grown(&pool, 1.5);
        if contains(core, at) && site.is_free(&slabs, 3.0, 0.5) {
            site.surface(&slabs, Surface::Paving);
            site.surface(&pool, Surface::Water);
            site.take(&slabs);
        }
    }
}
