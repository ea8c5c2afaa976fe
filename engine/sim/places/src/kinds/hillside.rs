//! `hillside`: streets along a slope and steep ones up it, houses in steps, terraced gardens, ramps between the streets.

use super::around::Around;
use super::houses::{Houses, length_m, scatter};
use super::kind::{Key, PlaceKind, PlaceSettings};
use super::mesh::{Mesh, distances_m};
use super::pavements::Furniture;
use crate::geometry::{convex_core, long_axis, middle, reach_m};
use crate::net::plan::Profile;
use crate::relief::Relief;
use crate::site::{Site, Surface};
use crate::things::ThingKind;
use cosfly_frames::{DVec2, RandomStream, Seed, real};

/// The kind.
pub const KIND: PlaceKind = PlaceKind {
    name: "hillside",
    doc: "Streets along a slope and up it, houses in steps, terraced gardens, ramps",
    keys: &[
        Key { name: "size_m", doc: "Width of the place, metres", range: [200.0, 800.0], default: 360.0 },
        Key {
            name: "steepest_percent",
            doc: "Steepest slope of the ground, percent; people climb no steeper ones",
            range: [3.0, 16.0],
            default: 12.0,
        },
        Key { name: "tree_share", doc: "Trees in the gardens, 1 is many", range: [0.0, 1.0], default: 0.6 },
    ],
    build,
};

/// Walls of the terraces lie so far from the middle of a block, metres; their height, metres.
const TERRACES_M: [f64; 3] = [-4.2, 0.0, 4.2];
const WALL_M: f64 = 0.9;
/// Half the width of ramps, metres.
const RAMP_M: f64 = 1.3;

fn build(settings: &PlaceSettings, seed: Seed) -> Site {
    let mut stream = seed.stream("streets");
    let size_m = settings.get("size_m");
    let mesh = Mesh {
        columns_m: distances_m(size_m, 170.0, 0.12, &mut stream),
        rows_m: distances_m(size_m, 74.0, 0.05, &mut stream),
        heading_rad: stream.uniform(-0.8, 0.8),
        jitter_m: 3.0,
        bend_m: 7.0,
    };
    let profile = Profile { lanes: 1, lane_m: 2.8, sidewalk_m: 2.0, corner_m: 3.0 };
    let mut site = Site::of(&mesh.plan(&mut stream, |_| Some(profile)));
    let (sin, cos) = real::sin_cos(mesh.heading_rad);
    let up = DVec2::new(-sin, cos);
    let steepest = 0.01 * settings.get("steepest_percent");
    site.network.relief = Relief::rising(up, steepest, stream.uniform(-real::PI, real::PI));
    let houses = houses(settings.get("tree_share"));
    for (number, block) in site.blocks().iter().enumerate() {
        let mut stream = seed.child("block", number as u64).stream("gardens");
        let core = convex_core(&block.outline);
        terraces(&mut site, &core, &mut stream);
        let mut fronts = block.fronts.clone();
        fronts.sort_by(|a, b| length_m(b).total_cmp(&length_m(a)));
        for front in &fronts {
            houses.along(&mut site, front, &mut stream);
        }
        scatter(&mut site, &core, (40.0 * settings.get("tree_share")) as usize, [1.3, 2.4], &mut stream);
    }
    let mut stream = seed.stream("edge");
    for face in site.faces.clone().iter().filter(|face| !face.is_enclosed) {
        for front in &face.fronts {
            houses.along(&mut site, front, &mut stream);
        }
    }
    Furniture { tree_share: 0.0, crown_m: 1.8, lamp_m: 4.5 }.put(&mut site, &mut seed.stream("pavements"));
    Around { fields: 5, trees: 900, rows: 1, eaves_m: [4.5, 7.0] }.put(&mut site, seed);
    site
}

/// A ramp with railings up through the middle of a block, and low walls along the slope on either side of it.
fn terraces(site: &mut Site, core: &[DVec2], stream: &mut RandomStream) {
    let (axis, size_m) = long_axis(core);
    let at = middle(core) + stream.uniform(-0.15, 0.15) * size_m.x * axis;
    let [back, ahead] = [-axis.perp(), axis.perp()].map(|way| at + (reach_m(core, at, way) + 0.5) * way);
    site.path(&[back, ahead], 2.0 * RAMP_M, Surface::Paving);
    for side in [-1.0, 1.0] {
        let inward = 2.0 * (ahead - back).normalize();
        let beside = side * (RAMP_M + 0.25) * axis;
        site.enclose(ThingKind::Fence, [back + inward + beside, ahead - inward + beside], 0.08, 1.0);
        for out_m in TERRACES_M {
            let from = at + 2.2 * side * axis + out_m * axis.perp();
            let length_m = reach_m(core, from, side * axis) - 17.0;
            site.enclose(ThingKind::Wall, [from, from + length_m.max(0.0) * side * axis], 0.4, WALL_M);
        }
    }
}

fn houses(trees: f64) -> Houses {
    Houses {
        in_a_row: [1, 2],
        width_m: [7.5, 10.0],
        depth_m: [8.5, 9.5],
        setback_m: [2.6, 3.6],
        gap_m: [3.4, 7.0],
        eaves_m: [5.0, 6.4],
        garden_m: 11.0,
        density: 0.95,
        hedges: 0.5,
        cars: 0.5,
        drive_onto_m: 0.0,
        trees,
    }
}
