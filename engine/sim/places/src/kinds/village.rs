//! `village`: a winding main street, lanes that end in the fields, farms, a green with a church and a pond.

use super::around::Around;
use super::houses::Houses;
use super::kind::{Key, PlaceKind, PlaceSettings};
use super::pavements::Furniture;
use crate::geometry::{disc, rectangle};
use crate::net::plan::{Profile, StreetPlan};
use crate::site::{Site, Surface};
use cosfly_frames::{DVec2, RandomStream, Seed, real};

/// The kind.
pub const KIND: PlaceKind = PlaceKind {
    name: "village",
    doc: "A winding street, farms and cottages, a green with a church, fields",
    keys: &[
        Key { name: "length_m", doc: "Length of the main street, metres", range: [250.0, 900.0], default: 420.0 },
        Key { name: "density", doc: "Share of the plots with a house", range: [0.1, 1.0], default: 0.75 },
        Key { name: "fields", doc: "Fields around the village", range: [0.0, 40.0], default: 14.0 },
    ],
    build,
};

const MAIN: Profile = Profile { lanes: 1, lane_m: 3.0, sidewalk_m: 1.8, corner_m: 3.0 };
const LANE: Profile = Profile { lanes: 1, lane_m: 2.6, sidewalk_m: 1.5, corner_m: 2.5 };

fn build(settings: &PlaceSettings, seed: Seed) -> Site {
    let mut stream = seed.stream("streets");
    let mut site = Site::of(&streets(settings.get("length_m"), &mut stream));
    let mut stream = seed.stream("houses");
    green(&mut site, &mut stream);
    let cottages = Houses {
        in_a_row: [1, 1],
        width_m: [8.5, 13.0],
        depth_m: [7.5, 9.5],
        setback_m: [3.5, 9.0],
        gap_m: [5.0, 16.0],
        eaves_m: [3.2, 5.8],
        garden_m: 16.0,
        density: settings.get("density"),
        hedges: 0.5,
        cars: 0.5,
        drive_onto_m: 0.0,
        trees: 0.8,
    };
    let barns = Houses {
        width_m: [16.0, 26.0],
        depth_m: [10.0, 13.0],
        setback_m: [26.0, 34.0],
        gap_m: [18.0, 50.0],
        eaves_m: [4.5, 6.0],
        hedges: 0.0,
        cars: 0.0,
        trees: 0.3,
        garden_m: 3.0,
        ..cottages.clone()
    };
    for houses in [cottages, barns] {
        for face in site.faces.clone() {
            for front in &face.fronts {
                houses.along(&mut site, front, &mut stream);
            }
        }
    }
    Furniture { tree_share: 0.0, crown_m: 2.0, lamp_m: 5.0 }.put(&mut site, &mut seed.stream("pavements"));
    let fields = settings.get("fields") as usize;
    Around { fields, trees: 400, rows: 0, eaves_m: [0.0; 2] }.put(&mut site, seed);
    site
}

/// A main street that winds, a loop around the green, and lanes to either side.
fn streets(length_m: f64, stream: &mut RandomStream) -> StreetPlan {
    let mut plan = StreetPlan::default();
    let step_m = length_m / 4.0;
    let (sin, cos) = real::sin_cos(stream.uniform(-1.5, 1.5));
    let turn = |at: DVec2| DVec2::new(cos, sin).rotate(at);
    let mut side_m = 0.0;
    for at in 0..5 {
        plan.node(turn(DVec2::new((f64::from(at) - 2.0) * step_m, side_m)));
        side_m += stream.uniform(-0.22, 0.22) * step_m;
    }
    for at in 0..4 {
        let [from, to] = [plan.nodes[at], plan.nodes[at + 1]];
        let side = (to - from).normalize().perp();
        let bends = [0.35, 0.65].map(|share| from.lerp(to, share) + stream.uniform(-0.07, 0.07) * step_m * side);
        plan.bent(at, bends.to_vec(), at + 1, MAIN);
    }
    // The loop leaves the main street at its second and third junction.
    let along = (plan.nodes[2] - plan.nodes[1]).normalize();
    let out = 0.75 * step_m.min(110.0) * along.perp();
    let corners = [1, 2].map(|node| plan.nodes[node] + out);
    let ends = corners.map(|corner| plan.node(corner));
    plan.link(1, ends[0], LANE);
    plan.link(ends[0], ends[1], LANE);
    plan.link(ends[1], 2, LANE);
    for (node, away) in [(1, -1.0), (2, -1.0), (3, 1.0), (3, -1.0)] {
        if node == 3 || stream.chance(0.8) {
            let length_m = stream.uniform(70.0, 120.0);
            let end = plan.nodes[node] + away * length_m * along.perp() + stream.uniform(-12.0, 12.0) * along;
            let side = stream.uniform(-8.0, 8.0) * along;
            let bend = plan.nodes[node].lerp(end, 0.55) + side;
            let end = plan.node(end);
            plan.bent(node, vec![bend], end, LANE);
        }
    }
    plan
}

/// The largest block: a church, a pond, paths across the grass.
fn green(site: &mut Site, stream: &mut RandomStream) {
    let Some(block) = site.blocks().into_iter().next() else { return };
    let center = crate::geometry::middle(&crate::geometry::convex_core(&block.outline));
    let ends: Vec<DVec2> = block
        .fronts
        .iter()
        .filter(|front| super::houses::length_m(front) > 20.0)
        .map(|front| {
            let points = &front.points;
            points[points.len() / 2].lerp(points[(points.len() - 1) / 2], 0.5)
        })
        .collect();
    let Some(first) = ends.first() else { return };
    let along = (center - *first).normalize();
    let crossing = center + 3.0 * along;
    for end in &ends {
        let past = *end + 0.6 * (*end - crossing).normalize();
        site.path(&[crossing, past], 2.4, Surface::Gravel);
    }
    site.walk_on(&disc(crossing, 4.0, 12), Surface::Gravel);
    let side = along.perp();
    for (turn, ahead_m) in [(1.0, 15.0), (-1.0, 15.0), (1.0, -15.0), (-1.0, -15.0)] {
        let front = crossing + turn * 5.0 * side + ahead_m * along;
        let nave = rectangle(front, turn * along, DVec2::new(17.0, 8.5));
        let tower = rectangle(front - turn * 11.2 * along + turn * 2.0 * side, turn * along, DVec2::new(5.0, 5.0));
        if site.is_free(&nave, 2.0, 0.6) && site.is_free(&tower, 2.0, 0.6) {
            site.build(&nave, 7.5, 4.5, 0.5);
            site.build(&tower, 17.0, 5.0, 0.05);
            break;
        }
    }
    for radius_m in [11.0, 8.0, 5.5] {
        let angle_rad = stream.uniform(0.0, 6.0);
        let at = crossing - 16.0 * along + stream.uniform(-16.0, 16.0) * side;
        let pond: Vec<DVec2> = disc(DVec2::ZERO, 1.0, 20)
            .iter()
            .enumerate()
            .map(|(corner, way)| at + radius_m * (1.0 + 0.16 * real::sin(corner as f64 * 0.9 + angle_rad)) * *way)
            .collect();
        if site.is_free(&pond, 2.0, 1.0) {
            site.surface(&pond, Surface::Water);
            site.take(&pond);
            break;
        }
    }
}
