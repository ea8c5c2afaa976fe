//! `campus`: large buildings of wings between lawns, paths that cross, a park with a lake.

use super::around::Around;
use super::houses::{playground, scatter};
use super::kind::{Key, PlaceKind, PlaceSettings};
use super::mesh::Mesh;
use super::pavements::Furniture;
use crate::geometry::{convex_core, disc, inset, long_axis, middle, reach_m};
use crate::lot::Lot;
use crate::net::plan::Profile;
use crate::site::{Site, Surface};
use crate::things::ThingKind;
use cosfly_frames::{DVec2, RandomStream, Seed, real};

/// The kind.
pub const KIND: PlaceKind = PlaceKind {
    name: "campus",
    doc: "Large buildings between lawns, paths that cross, a park with a lake",
    keys: &[
        Key { name: "size_m", doc: "Width of the place, metres", range: [280.0, 800.0], default: 400.0 },
        Key { name: "storeys", doc: "Usual number of storeys", range: [1.0, 8.0], default: 4.0 },
        Key { name: "tree_share", doc: "Trees on the lawns, 1 is many", range: [0.0, 1.0], default: 0.6 },
    ],
    build,
};

/// Paths end so far on the pavement, metres.
const ONTO_PAVEMENT_M: f64 = 0.5;
const ROAD: Profile = Profile { lanes: 1, lane_m: 3.25, sidewalk_m: 3.0, corner_m: 6.0 };

fn build(settings: &PlaceSettings, seed: Seed) -> Site {
    let mut stream = seed.stream("streets");
    let size_m = settings.get("size_m");
    let share = stream.uniform(0.42, 0.58);
    let mesh = Mesh {
        columns_m: vec![(share * size_m).round(), ((1.0 - share) * size_m).round()],
        rows_m: vec![(0.45 * size_m).round(), (0.4 * size_m).round()],
        heading_rad: stream.uniform(-0.7, 0.7),
        jitter_m: 6.0,
        bend_m: 0.0,
    };
    let mut site = Site::of(&mesh.plan(&mut stream, |_| Some(ROAD)));
    for (number, block) in site.blocks().iter().enumerate() {
        let mut stream = seed.child("block", number as u64).stream("lawns");
        let core = convex_core(&block.outline);
        let trees = (100.0 * settings.get("tree_share")) as usize;
        if number == 0 {
            park(&mut site, &core, &mut stream);
            scatter(&mut site, &inset(&core, 1.0), 3 * trees, [2.0, 4.5], &mut stream);
        } else {
            quadrangle(&mut site, &core, settings.get("storeys"), &mut stream);
            scatter(&mut site, &inset(&core, 1.0), trees, [2.0, 4.0], &mut stream);
        }
    }
    Furniture { tree_share: 0.8, crown_m: 2.6, lamp_m: 5.5 }.put(&mut site, &mut seed.stream("pavements"));
    Around { fields: 0, trees: 700, rows: 1, eaves_m: [6.0, 12.0] }.put(&mut site, seed);
    site
}

/// Paths from side to side and from corner to corner, a building of wings in each quarter.
fn quadrangle(site: &mut Site, core: &[DVec2], storeys: f64, stream: &mut RandomStream) {
    let (along, size_m) = long_axis(core);
    let (at, across) = (middle(core), along.perp());
    for direction in [along, -along, across, -across] {
        let end = at + (reach_m(core, at, direction) + ONTO_PAVEMENT_M) * direction;
        site.path(&[at, end], 3.4, Surface::Paving);
    }
    site.walk_on(&disc(at, 11.0, 20), Surface::Paving);
    let heading_rad = real::atan2(along.y, along.x);
    let statue = at + stream.uniform(-3.0, 3.0) * along;
    site.things.push(crate::things::GeneratedThing::on_lot(
        ThingKind::Fountain,
        Lot { center: statue, half_m: DVec2::splat(1.4), heading_rad },
        2.6,
    ));
    for (x, y) in [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)] {
        let quarter = at + 0.25 * size_m.x * x * along + 0.25 * size_m.y * y * across;
        let room_m = 0.5 * size_m - 9.0;
        let height_m = 3.6 * (storeys * stream.uniform(0.6, 1.4)).round().max(1.0) + 1.0;
        let shape = wings(room_m.min(DVec2::splat(70.0)) * stream.uniform(0.72, 0.9), 13.0, stream);
        // The court of the wings opens to the middle of the quadrangle.
        let place = |point: DVec2| quarter - point.x * x * along - point.y * y * across;
        let mut plan: Vec<DVec2> = shape.into_iter().map(place).collect();
        if x * y < 0.0 {
            plan.reverse();
        }
        site.build(&plan, height_m, 0.0, 1.5);
    }
}

/// The outline of an L or a U around the origin, counter-clockwise; its court opens to larger x and y.
fn wings(size_m: DVec2, thick_m: f64, stream: &mut RandomStream) -> Vec<DVec2> {
    let half = 0.5 * size_m;
    let t = thick_m.min(0.4 * size_m.min_element());
    let corners: &[(f64, f64)] = if stream.chance(0.5) {
        &[
            (-half.x, -half.y),
            (half.x, -half.y),
            (half.x, -half.y + t),
            (-half.x + t, -half.y + t),
            (-half.x + t, half.y),
            (-half.x, half.y),
        ]
    } else {
        &[
            (-half.x, -half.y),
            (half.x, -half.y),
            (half.x, half.y),
            (half.x - t, half.y),
            (half.x - t, -half.y + t),
            (-half.x + t, -half.y + t),
            (-half.x + t, half.y),
            (-half.x, half.y),
        ]
    };
    corners.iter().map(|(x, y)| DVec2::new(*x, *y)).collect()
}

/// A lake, a path around it, and paths from it to all sides.
fn park(site: &mut Site, core: &[DVec2], stream: &mut RandomStream) {
    let (along, size_m) = long_axis(core);
    let at = middle(core) + stream.uniform(-0.06, 0.06) * size_m.x * along;
    let radius_m = 0.2 * size_m.min_element();
    let phase_rad = stream.uniform(0.0, 6.0);
    let ring = |grown_m: f64| -> Vec<DVec2> {
        let radius = |corner: usize| {
            radius_m
                * (1.0
                    + 0.22 * real::sin(2.0 * real::PI * corner as f64 / 16.0 + phase_rad)
                    + 0.1 * real::sin(6.0 * real::PI * corner as f64 / 32.0))
        };
        disc(DVec2::ZERO, 1.0, 32)
            .iter()
            .enumerate()
            .map(|(corner, way)| at + (radius(corner) + grown_m) * *way)
            .collect()
    };
    let lake = ring(0.0);
    site.surface(&lake, Surface::Water);
    site.take(&lake);
    let mut walk = ring(6.0);
    walk.push(walk[0]);
    site.path(&walk, 2.6, Surface::Gravel);
    for spoke in 0..6 {
        let corner = walk[spoke * 32 / 6];
        let direction = (corner - at).normalize();
        let end = at + (reach_m(core, at, direction) + ONTO_PAVEMENT_M) * direction;
        let bend = corner.lerp(end, 0.5) + stream.uniform(-7.0, 7.0) * direction.perp();
        site.path(&[corner - 0.3 * direction, bend, end], 2.4, Surface::Gravel);
    }
    playground(site, at + 0.36 * size_m.x * along + 0.05 * size_m.y * along.perp(), along);
    for bench in (1..32).step_by(5) {
        let way = (walk[bench] - at).normalize();
        let center = walk[bench] + 2.0 * way;
        let lot = Lot { center, half_m: DVec2::new(0.25, 0.9), heading_rad: real::atan2(way.y, way.x) };
        site.stand(ThingKind::Bench, lot, 0.8, 0.1);
    }
}
