//! `perimeter_blocks`: straight streets, houses wall to wall around courtyards, one block a park (Barcelona, Berlin).

use super::around::Around;
use super::houses::{playground, scatter};
use super::kind::{Key, PlaceKind, PlaceSettings};
use super::mesh::{Mesh, distances_m};
use super::pavements::Furniture;
use crate::geometry::{convex_core, edges, inset, long_axis, meeting, middle, reach_m, rectangle};
use crate::lot::Lot;
use crate::net::plan::Profile;
use crate::site::{Site, Surface};
use crate::things::ThingKind;
use cosfly_frames::{DVec2, RandomStream, Seed, real};

/// The kind.
pub const KIND: PlaceKind = PlaceKind {
    name: "perimeter_blocks",
    doc: "Straight streets, houses wall to wall around courtyards",
    keys: &[
        Key { name: "size_m", doc: "Width of the place, metres", range: [220.0, 1000.0], default: 420.0 },
        Key { name: "block_m", doc: "Distance of the streets, metres", range: [80.0, 160.0], default: 105.0 },
        Key { name: "storeys", doc: "Usual number of storeys", range: [2.0, 10.0], default: 5.0 },
    ],
    build,
};

const STOREY_M: f64 = 3.3;

fn build(settings: &PlaceSettings, seed: Seed) -> Site {
    let mut stream = seed.stream("streets");
    let (size_m, block_m) = (settings.get("size_m"), settings.get("block_m"));
    let mesh = Mesh {
        columns_m: distances_m(size_m, block_m, 0.12, &mut stream),
        rows_m: distances_m(size_m, block_m, 0.12, &mut stream),
        heading_rad: stream.uniform(-0.6, 0.6),
        jitter_m: 0.0,
        bend_m: 0.0,
    };
    let corner_m = stream.uniform(2.5, 9.0).round();
    let profile = Profile { lanes: 1, lane_m: 3.5, sidewalk_m: 4.2, corner_m };
    let mut site = Site::of(&mesh.plan(&mut stream, |_| Some(profile)));
    site.network.has_lawn = false;
    let style = Style {
        depth_m: stream.uniform(11.0, 13.5),
        storeys: settings.get("storeys"),
        roof_m: if stream.chance(0.5) { stream.uniform(2.2, 3.6) } else { 0.0 },
    };
    let blocks = site.blocks();
    let park = stream.index(blocks.len());
    for (number, block) in blocks.iter().enumerate() {
        let mut stream = seed.child("block", number as u64).stream("houses");
        let core = inset(&convex_core(&block.outline), 0.7);
        if number == park && blocks.len() > 1 {
            square(&mut site, &core, &mut stream);
        } else {
            style.block(&mut site, &core, &mut stream);
        }
    }
    let mut stream = seed.stream("edge");
    for face in site.faces.clone().iter().filter(|face| !face.is_enclosed) {
        for front in &face.fronts {
            style.edge(&mut site, front.ends(), &mut stream);
        }
    }
    Furniture { tree_share: 0.7, crown_m: 2.4, lamp_m: 7.0 }.put(&mut site, &mut seed.stream("pavements"));
    Around { fields: 0, trees: 300, rows: 2, eaves_m: [10.0, 17.0] }.put(&mut site, seed);
    site
}

/// Houses of one place.
struct Style {
    depth_m: f64,
    storeys: f64,
    roof_m: f64,
}

impl Style {
    fn height_m(&self, stream: &mut RandomStream) -> f64 {
        let storeys = (self.storeys + stream.uniform(-1.2, 1.2)).round().max(1.0);
        (10.0 * (STOREY_M * storeys + 0.6)).round() / 10.0
    }

    /// A block: corner houses, rows between them, wings and trees in the courtyard.
    fn block(&self, site: &mut Site, core: &[DVec2], stream: &mut RandomStream) {
        let sides: Vec<[DVec2; 2]> = edges(core).filter(|[a, b]| a.distance(*b) > 15.0).collect();
        let along: Vec<DVec2> = sides.iter().map(|[a, b]| (*b - *a).normalize()).collect();
        let count = sides.len();
        // What the corner houses take of each side, at its start and end.
        let mut rest = sides.clone();
        for at in 0..count {
            let next = (at + 1) % count;
            let corner = meeting([sides[at][0], along[at]], [sides[next][0], along[next]]);
            let turn_rad = real::atan2(along[at].perp_dot(along[next]), along[at].dot(along[next]));
            let opening = 0.5 * (real::PI - turn_rad.abs());
            let leg_m = self.depth_m / real::tan(opening) + 3.5;
            let [before, after] = [corner - leg_m * along[at], corner + leg_m * along[next]];
            let inner = [along[at], along[next]].map(|along| self.depth_m * along.perp());
            let yard = meeting([before + inner[0], along[at]], [after + inner[1], along[next]]);
            let plan = [before, sides[at][1], sides[next][0], after, after + inner[1], yard, before + inner[0]];
            let fits = (sides[at][1] - sides[at][0]).dot(along[at]) > 2.0 * leg_m;
            if fits && site.build_beside(&plan, self.height_m(stream) + STOREY_M, 0.0) {
                (rest[at][1], rest[next][0]) = (before, after);
            }
        }
        for ([from, to], along) in rest.into_iter().zip(&along) {
            self.row(site, [from, to], *along, stream);
        }
        let yard = inset(core, self.depth_m + 1.5);
        for ([from, to], along) in sides.iter().zip(&along) {
            if stream.chance(0.5) {
                let front = from.lerp(*to, stream.uniform(0.4, 0.6)) + (self.depth_m + 0.1) * along.perp();
                let wing = rectangle(front, *along, DVec2::new(9.0, stream.uniform(8.0, 14.0)));
                site.build(&wing, self.height_m(stream) - STOREY_M, 0.0, 0.0);
            }
        }
        if yard.len() >= 3 {
            scatter(site, &yard, 24, [1.6, 3.2], stream);
        }
    }

    fn row(&self, site: &mut Site, [from, to]: [DVec2; 2], along: DVec2, stream: &mut RandomStream) {
        let length_m = (to - from).dot(along);
        let count = (length_m / stream.uniform(15.0, 22.0)).round().max(1.0);
        let width_m = length_m / count;
        for house in 0..count as usize {
            if width_m < 5.0 || stream.chance(0.03) {
                continue;
            }
            let front = from + (house as f64 + 0.5) * width_m * along;
            let depth_m = self.depth_m - if stream.chance(0.3) { stream.uniform(0.5, 2.0) } else { 0.0 };
            let plan = rectangle(front, along, DVec2::new(width_m - 0.02, depth_m));
            site.build_beside(&plan, self.height_m(stream), self.roof_m);
        }
    }

    /// Houses on the far side of the outermost streets.
    fn edge(&self, site: &mut Site, [from, to]: [DVec2; 2], stream: &mut RandomStream) {
        let Some(along) = (to - from).try_normalize() else { return };
        let set_back = 0.6 * along.perp();
        self.row(site, [from + set_back, to + set_back], along, stream);
    }
}

/// A park in place of a block: paths between its corners, trees, benches, a playground.
fn square(site: &mut Site, core: &[DVec2], stream: &mut RandomStream) {
    let (along, size_m) = long_axis(core);
    let center = middle(core);
    for direction in [along, -along, along.perp(), -along.perp()] {
        site.path(&[center, center + (reach_m(core, center, direction) + 1.2) * direction], 3.2, Surface::Gravel);
    }
    site.walk_on(&crate::geometry::disc(center, 9.0, 16), Surface::Gravel);
    let heading_rad = real::atan2(along.y, along.x);
    playground(site, center + 0.27 * size_m.x * along + 0.27 * size_m.y * along.perp(), along);
    for side in [1.0, -1.0] {
        let center = center + 14.0 * side * along + 2.4 * along.perp();
        site.stand(ThingKind::Bench, Lot { center, half_m: DVec2::new(0.9, 0.25), heading_rad }, 0.8, 0.1);
    }
    scatter(site, core, 90, [2.0, 4.0], stream);
}
