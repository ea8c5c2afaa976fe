//! `garden_rows`: curved streets of semi-detached and terraced houses with gardens, hedges, fences and drives.

use super::around::Around;
use super::houses::{Houses, playground, scatter};
use super::kind::{Key, PlaceKind, PlaceSettings};
use super::mesh::{Mesh, distances_m};
use super::pavements::Furniture;
use crate::geometry::{convex_core, long_axis, middle};
use crate::net::plan::Profile;
use crate::site::Site;
use cosfly_frames::Seed;

/// The kind.
pub const KIND: PlaceKind = PlaceKind {
    name: "garden_rows",
    doc: "Curved streets of semi-detached and terraced houses with gardens",
    keys: &[
        Key { name: "size_m", doc: "Width of the place, metres", range: [200.0, 1000.0], default: 380.0 },
        Key {
            name: "terraced_share",
            doc: "Share of the fronts with terraces, not pairs",
            range: [0.0, 1.0],
            default: 0.4,
        },
        Key { name: "tree_share", doc: "Share of the gardens with a tree", range: [0.0, 1.0], default: 0.6 },
    ],
    build,
};

/// Length of the closes that leave the place, metres.
const CLOSE_M: f64 = 85.0;

fn build(settings: &PlaceSettings, seed: Seed) -> Site {
    let mut stream = seed.stream("streets");
    let size_m = settings.get("size_m");
    let mesh = Mesh {
        columns_m: distances_m(size_m, 150.0, 0.15, &mut stream),
        rows_m: distances_m(size_m, 72.0, 0.06, &mut stream),
        heading_rad: stream.uniform(-0.8, 0.8),
        jitter_m: 4.0,
        bend_m: 6.0,
    };
    let profile = Profile { lanes: 1, lane_m: 2.9, sidewalk_m: 2.1, corner_m: 3.5 };
    let mut plan = mesh.plan(&mut stream, |_| Some(profile));
    let columns = mesh.columns_m.len() + 1;
    // Closes with turning circles lead out of the place, from every other row at either side.
    for row in (1..mesh.rows_m.len()).step_by(2) {
        for (edge, inner) in [(row * columns, row * columns + 1), ((row + 1) * columns - 1, (row + 1) * columns - 2)] {
            let out = (plan.nodes[edge] - plan.nodes[inner]).normalize();
            let end = plan.node(plan.nodes[edge] + CLOSE_M * out + stream.uniform(-8.0, 8.0) * out.perp());
            plan.link(edge, end, profile);
        }
    }
    let mut site = Site::of(&plan);
    let blocks = site.blocks();
    let green = stream.index(blocks.len());
    for (number, block) in blocks.iter().enumerate() {
        let mut stream = seed.child("block", number as u64).stream("gardens");
        let core = convex_core(&block.outline);
        if number == green {
            let (along, _) = long_axis(&core);
            playground(&mut site, middle(&core), along);
            scatter(&mut site, &core, 60, [1.8, 4.0], &mut stream);
            continue;
        }
        // Long sides first: they get whole rows.
        let mut fronts = block.fronts.clone();
        fronts.sort_by(|a, b| super::houses::length_m(b).total_cmp(&super::houses::length_m(a)));
        for front in &fronts {
            style(stream.chance(settings.get("terraced_share")), settings).along(&mut site, front, &mut stream);
        }
        scatter(&mut site, &core, 10, [1.4, 3.0], &mut stream);
    }
    let mut stream = seed.stream("edge");
    for face in site.faces.clone().iter().filter(|face| !face.is_enclosed) {
        for front in &face.fronts {
            style(stream.chance(settings.get("terraced_share")), settings).along(&mut site, front, &mut stream);
        }
    }
    Furniture { tree_share: 0.0, crown_m: 1.8, lamp_m: 5.0 }.put(&mut site, &mut seed.stream("pavements"));
    Around { fields: 3, trees: 420, rows: 2, eaves_m: [5.2, 6.2] }.put(&mut site, seed);
    site
}

fn style(is_terraced: bool, settings: &PlaceSettings) -> Houses {
    let pairs = Houses {
        in_a_row: [2, 2],
        width_m: [6.4, 7.4],
        depth_m: [8.5, 9.5],
        setback_m: [5.0, 6.0],
        gap_m: [3.4, 4.6],
        eaves_m: [5.2, 5.8],
        garden_m: 11.0,
        density: 0.97,
        hedges: 0.6,
        cars: 0.75,
        drive_onto_m: 0.0,
        trees: settings.get("tree_share"),
    };
    let terraces = Houses {
        in_a_row: [4, 7],
        width_m: [5.2, 5.8],
        setback_m: [3.0, 3.6],
        gap_m: [2.2, 3.0],
        eaves_m: [5.6, 6.2],
        ..pairs.clone()
    };
    if is_terraced { terraces } else { pairs }
}
