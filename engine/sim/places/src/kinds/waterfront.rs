//! `waterfront`: a promenade with trees, piers, a beach and boats along the water, tall houses behind it.

use super::around::Around;
use super::houses::{Houses, scatter};
use super::kind::{Key, PlaceKind, PlaceSettings};
use super::mesh::{Mesh, distances_m};
use super::pavements::Furniture;
use super::shore::Shore;
use crate::geometry::{convex_core, inset, rectangle};
use crate::lot::Lot;
use crate::net::plan::Profile;
use crate::site::{Site, Surface};
use crate::things::ThingKind;
use cosfly_frames::{DVec2, RandomStream, Seed, real};

/// The kind.
pub const KIND: PlaceKind = PlaceKind {
    name: "waterfront",
    doc: "A promenade with trees, piers and a beach, tall houses behind it",
    keys: &[
        Key { name: "size_m", doc: "Length of the promenade, metres", range: [240.0, 900.0], default: 420.0 },
        Key { name: "promenade_m", doc: "Width of the promenade, metres", range: [8.0, 30.0], default: 15.0 },
        Key { name: "piers", doc: "Piers into the water", range: [0.0, 6.0], default: 3.0 },
    ],
    build,
};

const ESPLANADE: Profile = Profile { lanes: 1, lane_m: 3.5, sidewalk_m: 3.6, corner_m: 5.0 };
/// Paths go so far onto the ground that they lead to, metres.
const ONTO_M: f64 = 0.5;
/// Share of the promenade that is along the beach.
const BEACH_SHARE: f64 = 0.32;
const BEACH_M: f64 = 24.0;
const PIER_M: DVec2 = DVec2::new(4.0, 42.0);

fn build(settings: &PlaceSettings, seed: Seed) -> Site {
    let mut stream = seed.stream("streets");
    let size_m = settings.get("size_m");
    let mesh = Mesh {
        columns_m: distances_m(size_m, 105.0, 0.12, &mut stream),
        rows_m: vec![stream.uniform(78.0, 96.0).round(), stream.uniform(78.0, 96.0).round()],
        heading_rad: stream.uniform(-0.8, 0.8),
        jitter_m: 0.0,
        bend_m: 0.0,
    };
    let mut site = Site::of(&mesh.plan(&mut stream, |_| Some(ESPLANADE)));
    let shore = Shore::south_of(&site, &mesh);
    promenade(&mut site, &shore, settings, &mut seed.stream("promenade"));
    for (number, block) in site.blocks().iter().enumerate() {
        let mut stream = seed.child("block", number as u64).stream("houses");
        for front in &block.fronts {
            houses([11.0, 22.0]).along(&mut site, front, &mut stream);
        }
        scatter(&mut site, &inset(&convex_core(&block.outline), 16.0), 14, [1.6, 3.0], &mut stream);
    }
    let mut stream = seed.stream("edge");
    for face in site.faces.clone().iter().filter(|face| !face.is_enclosed) {
        for front in &face.fronts {
            houses([8.0, 15.0]).along(&mut site, front, &mut stream);
        }
    }
    Furniture { tree_share: 0.6, crown_m: 2.3, lamp_m: 6.5 }.put(&mut site, &mut seed.stream("pavements"));
    Around { fields: 0, trees: 320, rows: 2, eaves_m: [6.0, 12.0] }.put(&mut site, seed);
    site
}

fn houses(eaves_m: [f64; 2]) -> Houses {
    Houses {
        in_a_row: [1, 2],
        width_m: [12.0, 18.0],
        depth_m: [11.0, 13.0],
        setback_m: [0.8, 1.6],
        gap_m: [0.6, 3.0],
        eaves_m,
        garden_m: 0.0,
        density: 0.95,
        hedges: 0.0,
        cars: 0.0,
        drive_onto_m: 0.0,
        trees: 0.0,
    }
}

/// The promenade with what stands on it, piers, a railing between them, the beach and the water.
fn promenade(site: &mut Site, shore: &Shore, settings: &PlaceSettings, stream: &mut RandomStream) {
    let (wide_m, length_m) = (settings.get("promenade_m"), shore.length_m);
    let heading_rad = real::atan2(shore.along.y, shore.along.x);
    let mut at_m = 8.0 - 0.5 * length_m;
    while at_m < 0.5 * length_m - 8.0 {
        site.plant(shore.at(at_m, 2.2), stream.uniform(1.9, 2.4), stream);
        let stands = [(0.45, ThingKind::Bench, [0.9, 0.25], 0.8), (0.2, ThingKind::Stall, [1.6, 1.1], 2.5)];
        for (number, (share, kind, half_m, height_m)) in stands.into_iter().enumerate() {
            if stream.chance(share) {
                let center = shore.at(at_m + 4.0, 2.2 + 2.4 * number as f64);
                site.stand(kind, Lot { center, half_m: half_m.into(), heading_rad }, height_m, 0.2);
            }
        }
        at_m += stream.uniform(8.5, 10.5);
    }
    site.walk_on(&shore.belt(-ONTO_M, wide_m, 0.0), Surface::Paving);
    let beach_side = if stream.chance(0.5) { 1.0 } else { -1.0 };
    let beach_m = BEACH_SHARE * length_m;
    let beach = shore.at(0.5 * beach_side * (length_m - beach_m), wide_m - ONTO_M);
    // Piers and the railing take the rest of the promenade.
    let rest_m = length_m - beach_m;
    let from_m = if beach_side > 0.0 { -0.5 * length_m } else { 0.5 * length_m - rest_m };
    let count = settings.get("piers").floor();
    let piers: Vec<f64> = (0..count as usize).map(|pier| from_m + (pier as f64 + 0.5) / count * rest_m).collect();
    for pier_m in &piers {
        site.walk_on(&rectangle(shore.at(*pier_m, wide_m - ONTO_M), shore.along, PIER_M), Surface::Paving);
        boats(site, shore, [*pier_m, wide_m], stream);
    }
    let mut start_m = from_m + 0.4;
    for end_m in piers.iter().map(|pier_m| pier_m - 0.5 * PIER_M.x - 0.3).chain([from_m + rest_m - 0.8]) {
        site.enclose(ThingKind::Fence, [shore.at(start_m, wide_m + 0.4), shore.at(end_m, wide_m + 0.4)], 0.1, 1.1);
        start_m = end_m + PIER_M.x + 0.6;
    }
    site.walk_on(&rectangle(beach, shore.along, DVec2::new(beach_m, BEACH_M)), Surface::Gravel);
    shore.water(site, wide_m + 0.6);
}

/// Boats on both sides of a pier.
fn boats(site: &mut Site, shore: &Shore, [pier_m, wide_m]: [f64; 2], stream: &mut RandomStream) {
    for berth in 0..4 {
        for side in [-1.0, 1.0] {
            if stream.chance(0.65) {
                let size_m = DVec2::new(stream.uniform(6.0, 11.0), stream.uniform(2.2, 3.2));
                let along_m = pier_m + side * (0.5 * PIER_M.x + 0.6 + 0.5 * size_m.x);
                shore.boat(site, along_m, wide_m + 8.0 + 8.5 * f64::from(berth), size_m, stream.uniform(1.2, 2.4));
            }
        }
    }
}
