//! `terraces`: long rows of houses wall to wall, each row higher than the one before it, walls between them, and steps
//! that lead up through the rows. The ground itself is level.

use super::around::Around;
use super::houses::{Houses, length_m, scatter};
use super::kind::{Key, PlaceKind, PlaceSettings};
use super::mesh::{Mesh, distances_m};
use super::pavements::Furniture;
use crate::geometry::{convex_core, inset, long_axis, middle, reach_m};
use crate::net::plan::Profile;
use crate::site::{Site, Surface};
use crate::things::ThingKind;
use cosfly_frames::{DVec2, RandomStream, Seed, real};

/// The kind.
pub const KIND: PlaceKind = PlaceKind {
    name: "terraces",
    doc: "Long rows of houses that rise like a hillside, walls, steps between them",
    keys: &[
        Key { name: "size_m", doc: "Width of the place, metres", range: [200.0, 800.0], default: 340.0 },
        Key { name: "row_m", doc: "Distance of the streets, metres", range: [50.0, 80.0], default: 58.0 },
        Key { name: "rise_m", doc: "Height of houses from row to row, metres", range: [0.0, 4.0], default: 1.8 },
    ],
    build,
};

/// Height of the walls of the lowest row, metres.
const LOWEST_EAVES_M: f64 = 5.0;
/// Highest walls of houses, metres.
const HIGHEST_EAVES_M: f64 = 24.0;

fn build(settings: &PlaceSettings, seed: Seed) -> Site {
    let mut stream = seed.stream("streets");
    let (size_m, row_m) = (settings.get("size_m"), settings.get("row_m"));
    let mesh = Mesh {
        columns_m: distances_m(size_m, 170.0, 0.1, &mut stream),
        rows_m: distances_m(size_m, row_m, 0.05, &mut stream),
        heading_rad: stream.uniform(-0.8, 0.8),
        jitter_m: 2.5,
        bend_m: 5.0,
    };
    let profile = Profile { lanes: 1, lane_m: 2.75, sidewalk_m: 2.0, corner_m: 2.5 };
    let mut site = Site::of(&mesh.plan(&mut stream, |_| Some(profile)));
    let (sin, cos) = real::sin_cos(mesh.heading_rad);
    let slope = Slope {
        up: DVec2::new(-sin, cos),
        half_m: 0.5 * mesh.rows_m.iter().sum::<f64>(),
        row_m,
        rise_m: settings.get("rise_m"),
    };
    for (number, block) in site.blocks().iter().enumerate() {
        let mut stream = seed.child("block", number as u64).stream("rows");
        let core = convex_core(&block.outline);
        steps(&mut site, &core, &mut stream);
        let mut fronts = block.fronts.clone();
        fronts.sort_by(|a, b| length_m(b).total_cmp(&length_m(a)));
        for front in &fronts {
            slope.houses(front.ends()).along(&mut site, front, &mut stream);
        }
        scatter(&mut site, &inset(&core, 3.0), 16, [1.4, 2.4], &mut stream);
    }
    let mut stream = seed.stream("edge");
    for face in site.faces.clone().iter().filter(|face| !face.is_enclosed) {
        for front in &face.fronts {
            slope.houses(front.ends()).along(&mut site, front, &mut stream);
        }
    }
    Furniture { tree_share: 0.0, crown_m: 1.8, lamp_m: 4.5 }.put(&mut site, &mut seed.stream("pavements"));
    Around { fields: 4, trees: 500, rows: 1, eaves_m: [5.0, 8.0] }.put(&mut site, seed);
    site
}

/// How houses grow from row to row.
struct Slope {
    up: DVec2,
    half_m: f64,
    row_m: f64,
    rise_m: f64,
}

impl Slope {
    /// Houses of a front.
    fn houses(&self, [from, to]: [DVec2; 2]) -> Houses {
        let rows = ((0.5 * (from + to)).dot(self.up) + self.half_m) / self.row_m;
        let eaves_m = (LOWEST_EAVES_M + self.rise_m * rows.round().max(0.0)).min(HIGHEST_EAVES_M);
        Houses {
            in_a_row: [3, 6],
            width_m: [5.4, 6.6],
            depth_m: [8.5, 9.5],
            setback_m: [1.4, 2.0],
            gap_m: [2.6, 4.0],
            eaves_m: [eaves_m, eaves_m + 0.6],
            garden_m: 7.0,
            density: 0.98,
            hedges: 0.0,
            cars: 0.0,
            drive_onto_m: 0.0,
            trees: 0.3,
        }
    }
}

/// Steps across the middle of a block, and a wall along it on either side of them.
fn steps(site: &mut Site, core: &[DVec2], stream: &mut RandomStream) {
    let (axis, size_m) = long_axis(core);
    let at = middle(core) + stream.uniform(-0.12, 0.12) * size_m.x * axis;
    let [back, ahead] = [-axis.perp(), axis.perp()].map(|way| at + (reach_m(core, at, way) + 0.5) * way);
    site.path(&[back, ahead], 2.6, Surface::Paving);
    for side in [-1.0, 1.0] {
        let from = at + 2.0 * side * axis;
        let length_m = reach_m(core, at, side * axis) - 16.0;
        site.enclose(ThingKind::Wall, [from, at + length_m.max(0.0) * side * axis], 0.5, 2.2);
    }
}
