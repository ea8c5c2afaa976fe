//! `industrial`: wide streets, halls and tanks in fenced yards, and a port with a quay where containers are stacked.

use super::around::Around;
use super::car_park::CarPark;
use super::kind::{Key, PlaceKind, PlaceSettings};
use super::mesh::{Mesh, distances_m};
use super::pavements::Furniture;
use super::shore::Shore;
use crate::geometry::{convex_core, cut, disc, edges, inset, long_axis, middle, rectangle};
use crate::lot::Lot;
use crate::net::plan::Profile;
use crate::site::{Site, Surface};
use crate::things::ThingKind;
use cosfly_frames::{DVec2, RandomStream, Seed, real};

/// The kind.
pub const KIND: PlaceKind = PlaceKind {
    name: "industrial",
    doc: "Halls and tanks in fenced yards, wide streets, a port with containers",
    keys: &[
        Key { name: "size_m", doc: "Width of the place, metres", range: [260.0, 900.0], default: 420.0 },
        Key { name: "height_m", doc: "Usual height of the halls, metres", range: [5.0, 20.0], default: 9.0 },
        Key {
            name: "containers",
            doc: "Share of the places on the quay that are taken",
            range: [0.0, 1.0],
            default: 0.7,
        },
    ],
    build,
};

const ROAD: Profile = Profile { lanes: 1, lane_m: 3.75, sidewalk_m: 2.6, corner_m: 8.0 };
/// Length and width of a container, metres.
const CONTAINER_M: DVec2 = DVec2::new(12.2, 2.44);
const CONTAINER_HEIGHT_M: f64 = 2.6;
/// Depth of the quay, metres.
const QUAY_M: f64 = 44.0;
/// Yards are split until they are smaller, square metres.
const YARD_M2: f64 = 7000.0;

fn build(settings: &PlaceSettings, seed: Seed) -> Site {
    let mut stream = seed.stream("streets");
    let size_m = settings.get("size_m");
    let mesh = Mesh {
        columns_m: distances_m(size_m, 190.0, 0.15, &mut stream),
        rows_m: distances_m(0.75 * size_m, 150.0, 0.12, &mut stream),
        heading_rad: stream.uniform(-0.7, 0.7),
        jitter_m: 0.0,
        bend_m: 0.0,
    };
    let mut site = Site::of(&mesh.plan(&mut stream, |_| Some(ROAD)));
    for (number, block) in site.blocks().iter().enumerate() {
        let mut stream = seed.child("block", number as u64).stream("yards");
        let core = inset(&convex_core(&block.outline), 1.0);
        yards(&mut site, core, settings.get("height_m"), &mut stream);
    }
    let shore = Shore::south_of(&site, &mesh);
    quay(&mut site, &shore, settings.get("containers"), &mut seed.stream("quay"));
    let mut stream = seed.stream("edge");
    for face in site.faces.clone().iter().filter(|face| !face.is_enclosed) {
        for front in &face.fronts {
            let [from, to] = front.ends();
            let Some(along) = (to - from).try_normalize() else { continue };
            let belt = rectangle(from.lerp(to, 0.5) + 2.0 * along.perp(), along, DVec2::new(from.distance(to), 62.0));
            if site.is_free(&belt, 0.5, 0.5) {
                yards(&mut site, belt, settings.get("height_m"), &mut stream);
            }
        }
    }
    Furniture { tree_share: 0.15, crown_m: 2.4, lamp_m: 9.0 }.put(&mut site, &mut seed.stream("pavements"));
    Around { fields: 3, trees: 420, rows: 0, eaves_m: [0.0; 2] }.put(&mut site, seed);
    site
}

/// Yards on a piece of land, split until they are small.
fn yards(site: &mut Site, land: Vec<DVec2>, height_m: f64, stream: &mut RandomStream) {
    let (axis, size_m) = long_axis(&land);
    if size_m.x * size_m.y > YARD_M2 * stream.uniform(0.7, 1.4) {
        let at = middle(&land) + stream.uniform(-0.12, 0.12) * size_m.x * axis;
        for along in [axis.perp(), -axis.perp()] {
            yards(site, cut(&land, at, along), height_m, stream);
        }
        return;
    }
    let plan = inset(&land, 0.8);
    if plan.len() < 3 || size_m.y < 20.0 {
        return;
    }
    site.surface(&plan, Surface::Asphalt);
    let open = stream.index(plan.len());
    for (number, [a, b]) in edges(&plan).enumerate() {
        let step = (b - a).normalize();
        let end = if number == open { a.lerp(b, 0.55) } else { b - 0.3 * step };
        site.enclose(ThingKind::Fence, [a + 0.3 * step, end], 0.1, 2.2);
    }
    let (at, across) = (middle(&plan), axis.perp());
    let height_m = (10.0 * height_m * stream.uniform(0.7, 1.5)).round() / 10.0;
    if stream.chance(0.2) {
        tanks(site, at, axis, size_m, height_m, stream);
        return;
    }
    let hall_m = DVec2::new(size_m.x - 16.0, 0.52 * size_m.y);
    let front = at - 0.36 * size_m.y * across;
    let is_sawtooth = stream.chance(0.3);
    site.build(&rectangle(front, axis, hall_m), height_m, if is_sawtooth { 0.12 * hall_m.y } else { 0.0 }, 0.5);
    let behind = front + (hall_m.y + 2.5) * across;
    let lot =
        CarPark { front: behind, along: axis, size_m: DVec2::new(0.5 * hall_m.x, 16.0), filled: 0.5, way_m: None };
    if !lot.put(site, stream) {
        stacks(site, behind + 3.0 * across, axis, DVec2::new(hall_m.x, 0.2 * size_m.y), 0.5, stream);
    }
}

/// Round tanks in a row or two.
fn tanks(site: &mut Site, at: DVec2, axis: DVec2, size_m: DVec2, height_m: f64, stream: &mut RandomStream) {
    let radius_m = stream.uniform(6.0, 9.5);
    let pitch_m = 2.0 * radius_m + 5.0;
    let [columns, rows] = [size_m.x, size_m.y].map(|size_m| ((size_m - 8.0) / pitch_m).floor());
    for row in 0..rows as usize {
        for column in 0..columns as usize {
            let place = DVec2::new(column as f64 - 0.5 * (columns - 1.0), row as f64 - 0.5 * (rows - 1.0)) * pitch_m;
            let tank = disc(at + place.x * axis + place.y * axis.perp(), radius_m, 14);
            site.build(&tank, height_m + 3.0, 0.0, 1.0);
        }
    }
}

/// Stacks of containers in rows along a direction.
fn stacks(site: &mut Site, front: DVec2, along: DVec2, size_m: DVec2, taken: f64, stream: &mut RandomStream) {
    let heading_rad = real::atan2(along.y, along.x);
    let [columns, rows] = [(size_m.x / (CONTAINER_M.x + 1.2)).floor(), (size_m.y / (CONTAINER_M.y + 0.4)).floor()];
    for row in 0..rows as usize {
        for column in 0..columns as usize {
            // Every fourth row stays open for the lifts.
            if row % 4 == 3 || !stream.chance(taken) {
                continue;
            }
            let ahead_m = (column as f64 - 0.5 * (columns - 1.0)) * (CONTAINER_M.x + 1.2);
            let center = front + ahead_m * along + (row as f64 + 0.5) * (CONTAINER_M.y + 0.4) * along.perp();
            let high = 1.0 + stream.index(3) as f64;
            let lot = Lot { center, half_m: 0.5 * CONTAINER_M, heading_rad };
            site.stand(ThingKind::Container, lot, high * CONTAINER_HEIGHT_M, 0.2);
        }
    }
}

/// The quay along the water, with stacks of containers and two ships.
fn quay(site: &mut Site, shore: &Shore, taken: f64, stream: &mut RandomStream) {
    site.surface(&shore.belt(1.5, QUAY_M, 30.0), Surface::Asphalt);
    let fence = shore.line(1.5, shore.length_m - 20.0);
    site.enclose(ThingKind::Fence, [fence[0], fence[0].lerp(fence[1], 0.48)], 0.1, 2.2);
    site.enclose(ThingKind::Fence, [fence[0].lerp(fence[1], 0.52), fence[1]], 0.1, 2.2);
    let stacked_m = DVec2::new(shore.length_m - 40.0, QUAY_M - 16.0);
    stacks(site, shore.at(0.0, 5.0), shore.along, stacked_m, taken, stream);
    site.take(&shore.belt(1.0, QUAY_M, 30.0));
    for side in [-0.27, 0.25] {
        shore.boat(site, side * shore.length_m, QUAY_M + 12.0, DVec2::new(stream.uniform(60.0, 85.0), 13.0), 8.0);
    }
    shore.water(site, QUAY_M);
}
