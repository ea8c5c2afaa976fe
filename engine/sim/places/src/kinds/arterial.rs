//! `arterial`: two wide roads that cross, slab blocks on lawns behind them, car parks, a supermarket.

use super::around::Around;
use super::car_park::CarPark;
use super::houses::{playground, scatter};
use super::kind::{Key, PlaceKind, PlaceSettings};
use super::mesh::Mesh;
use super::pavements::Furniture;
use crate::geometry::{convex_core, inset, long_axis, middle, reach_m, rectangle};
use crate::net::plan::Profile;
use crate::site::{Site, Surface};
use cosfly_frames::{DVec2, RandomStream, Seed};

/// The kind.
pub const KIND: PlaceKind = PlaceKind {
    name: "arterial",
    doc: "Two wide roads that cross, slab blocks on lawns, car parks",
    keys: &[
        Key { name: "size_m", doc: "Width of the place, metres", range: [280.0, 800.0], default: 400.0 },
        Key { name: "storeys", doc: "Usual number of storeys of the slabs", range: [3.0, 20.0], default: 9.0 },
        Key { name: "tree_share", doc: "Trees on the lawns, 1 is many", range: [0.0, 1.0], default: 0.6 },
    ],
    build,
};

const WIDE: Profile = Profile { lanes: 2, lane_m: 3.5, sidewalk_m: 4.6, corner_m: 6.0 };
const SIDE: Profile = Profile { lanes: 1, lane_m: 3.25, sidewalk_m: 2.8, corner_m: 4.0 };
const STOREY_M: f64 = 2.9;

fn build(settings: &PlaceSettings, seed: Seed) -> Site {
    let mut stream = seed.stream("streets");
    let half_m = 0.5 * settings.get("size_m");
    let mut pair = || {
        let shift = stream.uniform(0.86, 1.14);
        vec![(half_m * shift).round(), (half_m * (2.0 - shift)).round()]
    };
    let (columns_m, rows_m) = (pair(), pair());
    let mesh = Mesh { columns_m, rows_m, heading_rad: stream.uniform(-0.7, 0.7), jitter_m: 0.0, bend_m: 0.0 };
    let mut site = Site::of(&mesh.plan(&mut stream, |place| Some(if place.number == 1 { WIDE } else { SIDE })));
    for (number, block) in site.blocks().iter().enumerate() {
        let mut stream = seed.child("block", number as u64).stream("slabs");
        let core = convex_core(&block.outline);
        let center = site.middle();
        slabs(&mut site, &core, center, settings, &mut stream);
        let trees = (110.0 * settings.get("tree_share")) as usize;
        scatter(&mut site, &inset(&core, 1.0), trees, [2.0, 4.0], &mut stream);
    }
    let mut stream = seed.stream("edge");
    for face in site.faces.clone().iter().filter(|face| !face.is_enclosed) {
        for front in &face.fronts {
            edge(&mut site, front.ends(), &mut stream);
        }
    }
    Furniture { tree_share: 0.6, crown_m: 2.8, lamp_m: 8.5 }.put(&mut site, &mut seed.stream("pavements"));
    Around { fields: 0, trees: 420, rows: 2, eaves_m: [8.0, 16.0] }.put(&mut site, seed);
    site
}

/// A block: a path through the middle, slabs across it in parallel, a car park and a flat hall by the junction.
fn slabs(site: &mut Site, core: &[DVec2], center: DVec2, settings: &PlaceSettings, stream: &mut RandomStream) {
    let (axis, size_m) = long_axis(core);
    let (along, size_m) =
        if stream.chance(0.5) { (axis, size_m) } else { (axis.perp(), DVec2::new(size_m.y, size_m.x)) };
    let at = middle(core);
    for direction in [along, -along, along.perp(), -along.perp()] {
        site.path(&[at, at + (reach_m(core, at, direction) + 0.5) * direction], 2.8, Surface::Paving);
    }
    let to_junction = center - at;
    let quarter = DVec2::new(along.dot(to_junction).signum(), along.perp().dot(to_junction).signum());
    let by_junction = at + 0.25 * size_m.x * quarter.x * along + 0.25 * size_m.y * quarter.y * along.perp();
    if stream.chance(0.6) {
        hall(site, by_junction, along, 0.5 * size_m, stream);
    }
    let far = at - 0.27 * size_m.x * quarter.x * along - 0.25 * size_m.y * quarter.y * along.perp();
    playground(site, far, along);
    let depth_m = stream.uniform(11.5, 13.5);
    let pitch_m = depth_m + stream.uniform(22.0, 30.0);
    let count = ((size_m.x - 12.0) / pitch_m).floor().max(1.0);
    for slab in 0..count as usize {
        let across = along.perp();
        let from_west_m = (slab as f64 + 0.5 - 0.5 * count) * size_m.x / count;
        for side in [1.0, -1.0] {
            let length_m = (0.5 * size_m.y - 14.0).min(stream.uniform(44.0, 66.0));
            let storeys = (settings.get("storeys") * stream.uniform(0.6, 1.3)).round();
            let middle = at + from_west_m * along + side * (0.25 * size_m.y + 0.5) * across;
            let plan = rectangle(middle + 0.5 * depth_m * along, across, DVec2::new(length_m, depth_m));
            if length_m > 16.0 {
                site.build(&plan, STOREY_M * storeys + 1.0, 0.0, 3.0);
            }
        }
    }
}

/// A flat hall and its car park.
fn hall(site: &mut Site, at: DVec2, along: DVec2, room_m: DVec2, stream: &mut RandomStream) {
    let across = along.perp();
    let size_m = DVec2::new((room_m.x - 18.0).min(52.0), 0.4 * (room_m.y - 14.0).min(50.0));
    let plan = rectangle(at + 1.5 * across, along, size_m);
    let lot = rectangle(at - (size_m.y + 1.5) * across, along, size_m);
    if size_m.min_element() < 12.0 || !site.is_free(&lot, 1.0, 0.5) || !site.build(&plan, 6.5, 0.0, 0.5) {
        return;
    }
    CarPark { front: at - (size_m.y + 1.5) * across, along, size_m, filled: 0.65, way_m: None }.put(site, stream);
}

/// Long houses on the far side of the outermost streets.
fn edge(site: &mut Site, [from, to]: [DVec2; 2], stream: &mut RandomStream) {
    let Some(along) = (to - from).try_normalize() else { return };
    let mut at_m = 12.0;
    while at_m < from.distance(to) - 30.0 {
        let length_m = stream.uniform(26.0, 48.0);
        let front = from + (at_m + 0.5 * length_m) * along + stream.uniform(5.0, 9.0) * along.perp();
        let storeys = 3.0 + stream.index(3) as f64;
        site.build(&rectangle(front, along, DVec2::new(length_m, 12.0)), STOREY_M * storeys + 0.8, 0.0, 4.0);
        at_m += length_m + stream.uniform(12.0, 24.0);
    }
}
