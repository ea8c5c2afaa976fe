//! A place while it is built: its streets, the land between them, and what stands there already.

use crate::geometry::{bounds, contains, crosses_east, disc, edges, segment_distance_m, twice_area_m2};
use crate::lot::Lot;
use crate::net::faces::{Face, faces};
use crate::net::network::Network;
use crate::net::plan::StreetPlan;
use crate::net::ways::{Way, all_ways};
use crate::things::{Footprint, GeneratedThing, ThingKind};
use cosfly_frames::{DVec2, RandomStream, real};

/// Level of paths and squares, metres; pavements lie at 0.15.
const PAVED_LEVEL_M: f64 = 0.13;
/// Painted lines lie so far under what is walked on, and other ground as far under them, metres.
const BELOW_PATHS_M: f64 = 0.01;

/// Surfaces of ground; the names are those of `userData`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surface {
    /// Slabs.
    Paving,
    /// Gravel of paths, sand of playgrounds.
    Gravel,
    /// Car parks.
    Asphalt,
    /// Ploughed fields.
    Soil,
    /// Ponds and channels.
    Water,
    /// Painted lines.
    Paint,
}

impl Surface {
    fn name(self) -> &'static str {
        match self {
            Self::Paving => "paving",
            Self::Gravel => "gravel",
            Self::Asphalt => "asphalt",
            Self::Soil => "soil",
            Self::Water => "water",
            Self::Paint => "paint",
        }
    }
}

/// A place while it is built.
pub struct Site {
    /// The streets.
    pub network: Network,
    /// Ways through junctions.
    pub ways: Vec<Way>,
    /// Land between and around the streets.
    pub faces: Vec<Face>,
    /// Things that were put up so far.
    pub things: Vec<GeneratedThing>,
    edges: Vec<[DVec2; 2]>,
    taken: Vec<([DVec2; 2], Vec<DVec2>)>,
}

impl Site {
    /// Empty land beside the streets of a plan.
    pub fn of(plan: &StreetPlan) -> Self {
        let mut network = Network::lay(plan);
        network.has_lawn = true;
        let ways = all_ways(&network);
        let faces = faces(&network, &ways);
        let edges = faces.iter().flat_map(|face| edges(&face.outline)).collect();
        Self { network, ways, faces, things: Vec::new(), edges, taken: Vec::new() }
    }

    /// Whether a point lies beside all streets.
    pub fn is_land(&self, at: DVec2) -> bool {
        self.edges.iter().filter(|[a, b]| crosses_east(*a, *b, at)).count() % 2 == 0
    }

    /// Whether a polygon lies on land, `gap_m` from every pavement.
    pub fn is_clear(&self, polygon: &[DVec2], gap_m: f64) -> bool {
        let [low, high] = bounds(polygon);
        let is_near = |[a, b]: &&[DVec2; 2]| a.min(*b).cmple(high + gap_m).all() && a.max(*b).cmpge(low - gap_m).all();
        polygon.len() >= 3
            && self.is_land(polygon[0])
            && self.edges.iter().filter(is_near).all(|edge| {
                edges(polygon).all(|side| segment_distance_m(side, *edge) >= gap_m) && !contains(polygon, edge[0])
            })
    }

    /// Whether a polygon is clear, and `apart_m` from all that is taken.
    pub fn is_free(&self, polygon: &[DVec2], gap_m: f64, apart_m: f64) -> bool {
        let [low, high] = bounds(polygon);
        self.is_clear(polygon, gap_m)
            && self.taken.iter().all(|([other_low, other_high], other)| {
                other_low.cmpgt(high + apart_m).any()
                    || other_high.cmplt(low - apart_m).any()
                    || are_apart(polygon, other, apart_m)
            })
    }

    /// Keeps other things off a polygon.
    pub fn take(&mut self, polygon: &[DVec2]) {
        self.taken.push((bounds(polygon), polygon.to_vec()));
    }

    /// A building, if its ground is clear of streets: for walls that others share.
    pub fn build_beside(&mut self, outline: &[DVec2], height_m: f64, roof_m: f64) -> bool {
        let is_clear = self.is_clear(outline, 0.3);
        if is_clear {
            self.put_building(outline, height_m, roof_m);
        }
        is_clear
    }

    /// A building, if its ground is free.
    pub fn build(&mut self, outline: &[DVec2], height_m: f64, roof_m: f64, apart_m: f64) -> bool {
        let is_free = self.is_free(outline, 0.3, apart_m);
        if is_free {
            self.put_building(outline, height_m, roof_m);
        }
        is_free
    }

    fn put_building(&mut self, outline: &[DVec2], height_m: f64, roof_m: f64) {
        let footprint = Footprint::Polygon(outline.to_vec());
        let mut thing = GeneratedThing::new(ThingKind::Building, footprint, height_m);
        if roof_m > 0.0 {
            thing.data = vec![("roof", "gabled".to_owned()), ("roof_rise", format!("{roof_m:.2}"))];
        }
        self.things.push(thing);
        self.take(outline);
    }

    /// Something upright on a rectangle, if that is free.
    pub fn stand(&mut self, kind: ThingKind, lot: Lot, height_m: f64, apart_m: f64) -> bool {
        let is_free = self.is_free(&lot.corners(), 0.1, apart_m);
        if is_free {
            self.take(&lot.corners());
            self.things.push(GeneratedThing::on_lot(kind, lot, height_m));
        }
        is_free
    }

    /// A straight hedge, fence or wall, if its ground is free.
    pub fn enclose(&mut self, kind: ThingKind, [from, to]: [DVec2; 2], thick_m: f64, height_m: f64) -> bool {
        let along = to - from;
        let half_m = 0.5 * DVec2::new(along.length(), thick_m);
        let lot = Lot { center: 0.5 * (from + to), half_m, heading_rad: real::atan2(along.y, along.x) };
        half_m.x > 0.4 && self.stand(kind, lot, height_m, 0.1)
    }

    /// A tree, if no street is below its trunk and nothing is near; its crown is `crown_m` wide.
    pub fn plant(&mut self, at: DVec2, crown_m: f64, stream: &mut RandomStream) -> bool {
        let half_m = DVec2::splat((0.6 * crown_m).min(1.6));
        let lot = Lot { center: at, half_m, heading_rad: 0.0 };
        let is_free = self.is_free(&lot.corners(), 0.2, 0.4);
        if is_free {
            self.take(&lot.corners());
            self.things.push(tree(at, crown_m, stream));
        }
        is_free
    }

    /// Walkable ground; things that come later keep off.
    pub fn walk_on(&mut self, outline: &[DVec2], surface: Surface) {
        self.put_ground(outline, Some(surface), true, PAVED_LEVEL_M);
        self.take(outline);
    }

    /// Walkable ground whose surface is there already.
    pub fn walk_over(&mut self, outline: &[DVec2]) {
        self.put_ground(outline, None, true, PAVED_LEVEL_M);
        self.take(outline);
    }

    /// Ground that is seen and not walked on.
    pub fn surface(&mut self, outline: &[DVec2], surface: Surface) {
        let level_m = match surface {
            Surface::Water => 0.0,
            Surface::Paint => PAVED_LEVEL_M - BELOW_PATHS_M,
            _ => PAVED_LEVEL_M - 2.0 * BELOW_PATHS_M,
        };
        self.put_ground(outline, Some(surface), false, level_m);
    }

    fn put_ground(&mut self, outline: &[DVec2], surface: Option<Surface>, is_walkable: bool, level_m: f64) {
        let footprint = Footprint::Polygon(outline.to_vec());
        let surface = surface.map(|surface| ("surface", surface.name().to_owned()));
        let walkable = is_walkable.then(|| ("walkable", "yes".to_owned()));
        let data = surface.into_iter().chain(walkable).collect();
        self.things.push(GeneratedThing { data, ..GeneratedThing::new(ThingKind::Ground, footprint, level_m) });
    }

    /// A path of gravel over some points, with round joints.
    pub fn path(&mut self, points: &[DVec2], width_m: f64, surface: Surface) {
        for pair in points.windows(2) {
            let Some(along) = (pair[1] - pair[0]).try_normalize() else { continue };
            let side = 0.5 * width_m * along.perp();
            self.walk_on(&[pair[0] - side, pair[1] - side, pair[1] + side, pair[0] + side], surface);
        }
        for joint in points.iter().skip(1).take(points.len().saturating_sub(2)) {
            self.walk_on(&disc(*joint, 0.55 * width_m, 12), surface);
        }
    }

    /// The enclosed faces, largest first.
    pub fn blocks(&self) -> Vec<Face> {
        let mut blocks: Vec<Face> = self.faces.iter().filter(|face| face.is_enclosed).cloned().collect();
        let area_m2 = |face: &Face| twice_area_m2(&face.outline);
        blocks.sort_by(|a, b| area_m2(b).total_cmp(&area_m2(a)));
        blocks
    }

    /// Mean of the middles of all streets.
    pub fn middle(&self) -> DVec2 {
        let streets = &self.network.streets;
        let sum: DVec2 = streets.iter().map(|street| street.line.pose_at(0.5 * street.line.length_m()).at).sum();
        sum / streets.len().max(1) as f64
    }
}

/// A tree with a crown so wide, metres.
pub fn tree(at: DVec2, crown_m: f64, stream: &mut RandomStream) -> GeneratedThing {
    let tenths = |value: f64| (10.0 * value).round() / 10.0;
    let base_m = tenths(1.6 + 0.3 * crown_m + stream.uniform(0.0, 0.6));
    let height_m = base_m + tenths(crown_m * stream.uniform(1.3, 2.2));
    let trunk_m = (100.0 * (0.05 + 0.05 * crown_m)).round() / 100.0;
    GeneratedThing::tree(at, trunk_m.min(0.4), height_m, tenths(crown_m), base_m)
}

fn are_apart(one: &[DVec2], other: &[DVec2], apart_m: f64) -> bool {
    !contains(one, other[0])
        && !contains(other, one[0])
        && edges(one).all(|side| edges(other).all(|edge| segment_distance_m(side, edge) >= apart_m))
}
