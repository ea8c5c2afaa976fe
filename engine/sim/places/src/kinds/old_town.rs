//! `old_town`: a few crooked streets, lanes between old houses that only people use, a market square with a church.

use super::around::Around;
use super::kind::{Key, PlaceKind, PlaceSettings};
use super::mesh::{Mesh, distances_m};
use super::pavements::Furniture;
use crate::geometry::{
    contains, convex_core, cut, disc, edges, grown, inset, long_axis, middle, rectangle, twice_area_m2,
};
use crate::lot::Lot;
use crate::net::plan::Profile;
use crate::site::{Site, Surface};
use crate::things::ThingKind;
use cosfly_frames::{DVec2, RandomStream, Seed, real};

/// The kind.
pub const KIND: PlaceKind = PlaceKind {
    name: "old_town",
    doc: "Crooked narrow lanes between old houses, a market square with a church",
    keys: &[
        Key { name: "size_m", doc: "Width of the place, metres", range: [180.0, 700.0], default: 320.0 },
        Key { name: "lane_m", doc: "Usual width of the lanes, metres", range: [2.5, 8.0], default: 4.0 },
        Key { name: "storeys", doc: "Usual number of storeys", range: [1.0, 6.0], default: 3.0 },
    ],
    build,
};

const STOREY_M: f64 = 2.9;
/// Narrowest nave of the church, metres.
const NAVE_M: f64 = 7.0;
/// Lanes go so far onto other lanes and pavements, metres.
const ONTO_M: f64 = 0.4;
/// Blocks between lanes are split until they are smaller, square metres.
const BLOCK_M2: f64 = 1100.0;
/// Plots of houses are split until they are smaller, square metres.
const PLOT_M2: f64 = 150.0;

fn build(settings: &PlaceSettings, seed: Seed) -> Site {
    let mut stream = seed.stream("streets");
    let mesh = Mesh {
        columns_m: distances_m(settings.get("size_m"), 115.0, 0.15, &mut stream),
        rows_m: distances_m(settings.get("size_m"), 115.0, 0.15, &mut stream),
        heading_rad: stream.uniform(-0.7, 0.7),
        jitter_m: 13.0,
        bend_m: 0.0,
    };
    let profile = Profile { lanes: 1, lane_m: 2.75, sidewalk_m: 1.9, corner_m: 1.5 };
    let mut site = Site::of(&mesh.plan(&mut stream, |_| Some(profile)));
    site.network.has_lawn = false;
    let mut town = OldTown { lane_m: settings.get("lane_m"), storeys: settings.get("storeys"), cells: Vec::new() };
    for (number, block) in site.blocks().iter().enumerate() {
        let mut stream = seed.child("block", number as u64).stream("lanes");
        // The land is paved as a whole; lanes are what houses leave.
        let core = inset(&convex_core(&block.outline), 0.02);
        site.surface(&core, Surface::Paving);
        town.split(&mut site, core, &mut stream);
    }
    town.fill(&mut site, seed);
    let mut stream = seed.stream("edge");
    for face in site.faces.clone().iter().filter(|face| !face.is_enclosed) {
        for front in &face.fronts {
            let [from, to] = front.ends();
            let Some(along) = (to - from).try_normalize() else { continue };
            let belt = rectangle(from.lerp(to, 0.5) + 0.75 * along.perp(), along, DVec2::new(from.distance(to), 9.0));
            town.houses(&mut site, belt, &mut stream);
        }
    }
    Furniture { tree_share: 0.0, crown_m: 2.0, lamp_m: 4.5 }.put(&mut site, &mut seed.stream("pavements"));
    Around { fields: 4, trees: 300, rows: 2, eaves_m: [4.0, 8.0] }.put(&mut site, seed);
    site
}

struct OldTown {
    lane_m: f64,
    storeys: f64,
    /// Blocks between the lanes.
    cells: Vec<Vec<DVec2>>,
}

impl OldTown {
    /// Lanes through a piece of land, until the pieces are small.
    fn split(&mut self, site: &mut Site, land: Vec<DVec2>, stream: &mut RandomStream) {
        if land.len() < 3 || 0.5 * twice_area_m2(&land) < BLOCK_M2 * stream.uniform(0.8, 1.5) {
            self.cells.push(land);
            return;
        }
        let (axis, size_m) = long_axis(&land);
        let at = middle(&land) + stream.uniform(-0.12, 0.12) * size_m.x * axis;
        let (sin, cos) = real::sin_cos(stream.uniform(-0.22, 0.22));
        let along = DVec2::new(cos, sin).rotate(axis.perp());
        let half = 0.5 * (self.lane_m * stream.uniform(0.75, 1.35)).max(2.4) * along.perp();
        // Lanes reach onto the ground that they lead to.
        let lane = cut(&cut(&grown(&land, ONTO_M), at - half, along), at + half, -along);
        if lane.len() >= 3 {
            site.walk_over(&lane);
        }
        self.split(site, cut(&land, at + half, along), stream);
        self.split(site, cut(&land, at - half, -along), stream);
    }

    /// A market square and a church in the middle, houses elsewhere.
    fn fill(&self, site: &mut Site, seed: Seed) {
        let center = site.middle();
        let mut order: Vec<&Vec<DVec2>> = self.cells.iter().filter(|cell| cell.len() >= 3).collect();
        order.sort_by(|a, b| middle(a).distance(center).total_cmp(&middle(b).distance(center)));
        let church = (1..order.len()).find_map(|number| Some((number, church_plan(site, order[number])?)));
        for (number, cell) in order.into_iter().enumerate() {
            let mut stream = seed.child("cell", number as u64).stream("houses");
            match &church {
                _ if number == 0 => market(site, cell, &mut stream),
                Some((own, plan)) if *own == number => put_church(site, plan, &mut stream),
                _ => self.houses(site, inset(cell, 0.75), &mut stream),
            }
        }
    }

    /// Houses wall to wall on a piece of land.
    fn houses(&self, site: &mut Site, land: Vec<DVec2>, stream: &mut RandomStream) {
        if land.len() < 3 {
            return;
        }
        let (axis, size_m) = long_axis(&land);
        if 0.5 * twice_area_m2(&land) > PLOT_M2 * stream.uniform(0.6, 1.3) && size_m.x > 9.0 {
            let at = middle(&land) + stream.uniform(-0.1, 0.1) * size_m.x * axis;
            let along = axis.perp();
            self.houses(site, cut(&land, at + 0.01 * along.perp(), along), stream);
            self.houses(site, cut(&land, at - 0.01 * along.perp(), -along), stream);
            return;
        }
        let storeys = (self.storeys + stream.uniform(-1.3, 1.3)).round().max(1.0);
        let eaves_m = (10.0 * (STOREY_M * storeys + stream.uniform(0.0, 0.8))).round() / 10.0;
        let roof_m = 0.4 * size_m.y * stream.uniform(0.8, 1.2);
        if size_m.y < 3.0 {
            return;
        }
        if stream.chance(0.04) {
            site.plant(middle(&land), 2.0, stream);
        } else {
            site.build_beside(&land, eaves_m, (10.0 * roof_m).round() / 10.0);
        }
    }
}

/// Nave, tower and the rise of the nave's roof, metres.
type Church = ([Vec<DVec2>; 2], f64);

/// A church with a tower at an end of its nave, where the land holds both.
fn church_plan(site: &Site, cell: &[DVec2]) -> Option<Church> {
    let land = inset(cell, 0.75);
    let holds = |plan: &[DVec2]| plan.iter().all(|corner| contains(&land, *corner)) && site.is_clear(plan, 0.3);
    let (axis, size_m) = long_axis(cell);
    let (width_m, length_m) = (0.34 * size_m.y, 0.5 * size_m.x);
    let front = middle(cell) - 0.5 * width_m * axis.perp();
    let nave = rectangle(front, axis, DVec2::new(length_m, width_m));
    let tower = |end: f64| {
        let at = front + end * (0.5 * length_m + 3.1) * axis + (0.5 * width_m - 3.0) * axis.perp();
        rectangle(at, axis, DVec2::new(6.0, 6.0))
    };
    let tower = [-1.0, 1.0].map(tower).into_iter().find(|tower| holds(tower))?;
    (width_m >= NAVE_M && holds(&nave)).then_some(([nave, tower], 0.5 * width_m))
}

fn put_church(site: &mut Site, ([nave, tower], roof_m): &Church, stream: &mut RandomStream) {
    let eaves_m = 11.0 + stream.uniform(0.0, 3.0).round();
    site.build_beside(nave, eaves_m, *roof_m);
    site.build_beside(tower, eaves_m + 18.0, 6.0);
}

/// A square to walk on with a fountain, rows of stalls and some trees.
fn market(site: &mut Site, cell: &[DVec2], stream: &mut RandomStream) {
    let (axis, size_m) = long_axis(cell);
    let (center, heading_rad) = (middle(cell), real::atan2(axis.y, axis.x));
    let basin = Lot { center, half_m: DVec2::splat(1.6), heading_rad };
    site.stand(ThingKind::Fountain, basin, 1.1, 0.0);
    for row in [-1.0, 1.0] {
        for stall in -2..=2 {
            let center = center + f64::from(stall) * 5.5 * axis + 0.26 * row * size_m.y * axis.perp();
            let lot = Lot { center, half_m: DVec2::new(1.6, 1.0), heading_rad };
            let is_inside = edges(&inset(cell, 2.0)).all(|[a, b]| (b - a).perp_dot(center - a) > 0.0);
            if is_inside && stream.chance(0.8) {
                site.stand(ThingKind::Stall, lot, 2.4, 0.3);
            }
        }
    }
    for corner in inset(cell, 4.0) {
        site.plant(corner, 2.4, stream);
    }
    site.walk_over(cell);
    site.surface(&disc(center, 3.2, 12), Surface::Gravel);
}
