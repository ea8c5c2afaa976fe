//! Trees, lamps, masts and barriers as boxes.

use super::buildings::MOST_BOXES;
use super::elements::{CUT_OUT, Elements, Way};
use super::frame::Frame;
use super::heights::bearing_deg;
use super::roads::lines;
use super::stated::{Base, Doubts, EVERY, Quantity};
use super::tags::Tags;
use super::tally::Tally;
use core::fmt::Display;
use cosfly_domain::{Obstacle, ObstacleKind, OrientedBox};
use cosfly_frames::{DVec2, Seed, real};
use cosfly_town::MapError;
use cosfly_town::crown::crown_boxes;
use std::collections::BTreeSet;

/// Things farther outside the stated bounds are left out, metres.
const MARGIN_M: f64 = 100.0;
/// Distance between the trees of a row, metres.
const TREE_SPACING_M: f64 = 8.0;
/// Most openings of one barrier.
const MOST_OPENINGS: usize = 200;
/// Half the opening of a barrier at a gate or a path, metres.
const HALF_OPENING_M: f64 = 1.5;

/// Lower end of a thing, and its upper end above the ground.
const BASE: Base = Base::of("things");
const TOP: Quantity = Quantity::length("things", &["height"], [0.2, 300.0], USUAL);
const TOP_ABOVE_BASE: Quantity = Quantity { range: EVERY, noun: ["height above their lower end", ""], ..TOP };
/// Height of a tree above its foot, and diameter of its crown.
const TREE: Quantity = Quantity::length("trees", &["height"], [1.0, 80.0], USUAL);
const CROWN: Quantity = Quantity::length("trees", &["diameter_crown"], [0.5, 30.0], USUAL);
/// Length and depth of a bench.
const BENCH_M: DVec2 = DVec2::new(1.8, 0.6);
const USUAL: &str = "the usual one is assumed";

/// Height of a tree and radius of its crown, metres, as far as they are stated.
#[derive(Clone, Copy, Debug, Default)]
struct TreeSize {
    height_m: Option<f64>,
    crown_m: Option<f64>,
}

/// Boxes of things, and what is not from the file.
#[derive(Debug)]
pub struct Things<'i> {
    /// Boxes.
    pub obstacles: Vec<Obstacle>,
    /// Trees.
    pub trees: usize,
    /// Trees whose height is assumed.
    pub trees_of_assumed_height: usize,
    /// Trees of rows, whose places along the row are assumed.
    pub trees_of_rows: usize,
    /// Things that stand on something of unknown height, which are left out.
    pub upstairs: Tally,
    /// Barriers with more openings than are made.
    pub closed: Tally,
    /// Values that are not believed.
    pub doubts: Doubts,
    storey_m: f64,
    next_id: &'i mut u32,
}

/// A kind of thing that is a point: box kind, width, height, metres.
fn upright(tags: &Tags) -> Option<(ObstacleKind, f64, f64)> {
    let by_key = |key: &str, names: &[&str]| tags.is(key, names);
    Some(match () {
        () if by_key("highway", &["street_lamp"]) => (ObstacleKind::Lamp, 0.16, 6.0),
        () if by_key("barrier", &["bollard"]) => (ObstacleKind::Pole, 0.2, 1.0),
        () if by_key("amenity", &["bench"]) => (ObstacleKind::Bench, BENCH_M.y, 0.85),
        () if by_key("barrier", &["block"]) => (ObstacleKind::Static, 0.8, 0.8),
        () if by_key("power", &["tower"]) => (ObstacleKind::Pole, 4.0, 30.0),
        () if by_key("power", &["pole"]) => (ObstacleKind::Pole, 0.3, 9.0),
        () if by_key("man_made", &["flagpole"]) => (ObstacleKind::Pole, 0.15, 8.0),
        () if by_key("man_made", &["mast"]) => (ObstacleKind::Pole, 0.8, 20.0),
        () if by_key("man_made", &["chimney"]) => (ObstacleKind::Static, 2.5, 30.0),
        _ => return None,
    })
}

/// Yaw of a bench whose tags may state which way people on it look, a bearing clockwise from north. Its back is on the side of its
/// second axis; x is east, y south.
fn bench_yaw_rad(tags: &Tags) -> f64 {
    let bearing_deg = tags.get("direction").and_then(bearing_deg);
    bearing_deg.map_or(0.0, |bearing_deg| real::wrap_angle_rad(bearing_deg.to_radians()))
}

/// A kind of thing along a line: box kind, thickness, height, metres.
fn along(tags: &Tags) -> Option<(ObstacleKind, f64, f64)> {
    Some(match tags.get("barrier")? {
        "wall" => (ObstacleKind::Wall, 0.3, 2.0),
        "retaining_wall" => (ObstacleKind::Wall, 0.4, 1.0),
        "city_wall" => (ObstacleKind::Wall, 1.0, 5.0),
        "fence" => (ObstacleKind::Fence, 0.1, 1.5),
        "railing" | "handrail" => (ObstacleKind::Fence, 0.1, 1.0),
        "hedge" => (ObstacleKind::Bush, 0.8, 1.5),
        "guard_rail" => (ObstacleKind::GuardRail, 0.2, 0.8),
        "jersey_barrier" => (ObstacleKind::Wall, 0.5, 0.9),
        _ => return None,
    })
}

/// Reads all things. `passages` are nodes of paths and roads: barriers are open there, as they are at their gates. `storey_m` is the
/// height of a storey.
///
/// # Errors
/// More boxes than any town has.
pub fn read<'i>(
    elements: &Elements,
    frame: &Frame,
    passages: &BTreeSet<i64>,
    storey_m: f64,
    next_id: &'i mut u32,
) -> Result<Things<'i>, MapError> {
    let mut out = Things {
        obstacles: Vec::new(),
        trees: 0,
        trees_of_assumed_height: 0,
        trees_of_rows: 0,
        upstairs: Tally::default(),
        closed: Tally::default(),
        doubts: Doubts::default(),
        storey_m,
        next_id,
    };
    for (id, tags) in elements.node_tags.iter().filter(|(_, tags)| !tags.is_hidden()) {
        let Some(at) = frame.position(elements, *id).filter(|at| frame.holds(*at, MARGIN_M)) else { continue };
        if tags.is("natural", &["tree"]) {
            if let Some(base_m) = out.base_m(tags, format_args!("node {id}")) {
                let size = out.tree_size(tags, base_m, format_args!("node {id}"));
                out.add_tree(*id as u64, at, base_m, size);
            }
        } else if let Some((kind, width_m, height_m)) = upright(tags)
            && let Some(span_m) = out.span_m(tags, height_m, format_args!("node {id}"))
        {
            let (size_m, yaw_rad) = match kind {
                ObstacleKind::Bench => (BENCH_M, bench_yaw_rad(tags)),
                _ => (DVec2::splat(width_m), 0.0),
            };
            let id = out.next();
            out.add_box(kind, id, at, 0.5 * size_m, yaw_rad, span_m);
        }
    }
    let mut length_m = 0.0;
    for way in elements.ways.iter().filter(|way| !way.tags.is_hidden()) {
        if way.tags.is("natural", &["tree_row"]) {
            let Some(base_m) = out.base_m(&way.tags, format_args!("way {}", way.id)) else { continue };
            let size = out.tree_size(&way.tags, base_m, format_args!("way {}", way.id));
            for piece in lines(elements, frame, way, &mut length_m)? {
                out.add_tree_row(way, &piece, base_m, size);
            }
        } else if let Some((kind, thickness_m, height_m)) = along(&way.tags) {
            let Some(span_m) = out.span_m(&way.tags, height_m, format_args!("way {}", way.id)) else { continue };
            let openings = openings(elements, frame, way, passages);
            if openings.len() == MOST_OPENINGS {
                out.closed.add(format_args!("way {}", way.id));
            }
            let id = out.next();
            for piece in lines(elements, frame, way, &mut length_m)? {
                out.add_barrier(kind, id, &piece, (0.5 * thickness_m, span_m), &openings);
            }
        }
        if out.obstacles.len() > MOST_BOXES {
            return Err(MapError::new(format!(
                "the file gives more than {MOST_BOXES} solid boxes (at way {})",
                way.id
            ))
            .hint(CUT_OUT));
        }
    }
    Ok(out)
}

/// Where a barrier is open.
fn openings(elements: &Elements, frame: &Frame, way: &Way, passages: &BTreeSet<i64>) -> Vec<DVec2> {
    let is_open = |id: i64| {
        let is_gate = |tags: &Tags| tags.has("barrier") && !tags.is("barrier", &["bollard", "block", "wall", "fence"]);
        passages.contains(&id) || elements.tags_of_node(id).is_some_and(is_gate)
    };
    let open = way.nodes.iter().filter(|id| is_open(**id)).filter_map(|id| frame.position(elements, *id));
    open.take(MOST_OPENINGS).collect()
}

impl Things<'_> {
    /// Height above the ground at which a thing begins, metres; `None`, counted, for one on a roof or an upper storey that
    /// does not say how high that is.
    fn base_m(&mut self, tags: &Tags, name: impl Display + Copy) -> Option<f64> {
        let base_m = BASE.read_m(tags, self.storey_m, name, &mut self.doubts);
        if base_m.is_none() && tags.is_upstairs() {
            self.upstairs.add(name);
            return None;
        }
        Some(base_m.unwrap_or(0.0))
    }

    /// Lower and upper end of a thing of a usual height, metres. Stated heights are those of the upper end above the ground;
    /// one that is below the lower end is not believed.
    fn span_m(&mut self, tags: &Tags, usual_m: f64, name: impl Display + Copy) -> Option<[f64; 2]> {
        let base_m = self.base_m(tags, name)?;
        let stated_m = self.doubts.read(tags, &TOP, name);
        let top_m = stated_m.filter(|top_m| *top_m > base_m);
        if stated_m.is_some() && top_m.is_none() {
            self.doubts.add(tags, &TOP_ABOVE_BASE, name);
        }
        Some([base_m, top_m.unwrap_or(base_m + usual_m)])
    }

    /// Size that the tags of a tree, or of a row, state.
    fn tree_size(&mut self, tags: &Tags, base_m: f64, name: impl Display + Copy) -> TreeSize {
        let [low, high] = TREE.range;
        let height_m = tags.stated(&TOP).map(|top_m| top_m - base_m).filter(|height| (low..=high).contains(height));
        if height_m.is_none() {
            self.doubts.add(tags, &TREE, name);
        }
        TreeSize { height_m, crown_m: self.doubts.read(tags, &CROWN, name).map(|width| 0.5 * width) }
    }

    fn next(&mut self) -> u32 {
        *self.next_id += 1;
        *self.next_id
    }

    fn add_box(
        &mut self,
        kind: ObstacleKind,
        object_id: u32,
        at: DVec2,
        half_m: DVec2,
        yaw_rad: f64,
        [from_m, to_m]: [f64; 2],
    ) {
        let half_height_m = 0.5 * (to_m - from_m);
        let shape = OrientedBox {
            center_in_world: at.extend(from_m + half_height_m),
            half_extents_m: half_m.extend(half_height_m),
            yaw_rad,
        };
        self.obstacles.push(Obstacle { shape, kind, object_id, synthetic: false });
    }

    /// A tree that the file does not state, flagged as synthetic.
    pub fn add_assumed_tree(&mut self, number: u64, at: DVec2) {
        let (first, trees, unknown) = (self.obstacles.len(), self.trees, self.trees_of_assumed_height);
        self.add_tree(number, at, 0.0, TreeSize::default());
        (self.trees, self.trees_of_assumed_height) = (trees, unknown);
        self.obstacles[first..].iter_mut().for_each(|one| one.synthetic = true);
    }

    /// A bush that the file does not state, flagged as synthetic, of a width and a height, metres.
    pub fn add_assumed_bush(&mut self, at: DVec2, [width_m, height_m]: [f64; 2]) {
        let id = self.next();
        self.add_box(ObstacleKind::Bush, id, at, DVec2::splat(0.5 * width_m), 0.0, [0.0, height_m]);
        self.obstacles.iter_mut().rev().take(1).for_each(|one| one.synthetic = true);
    }

    /// A trunk and a crown. `number` draws what `size` does not state.
    fn add_tree(&mut self, number: u64, at: DVec2, base_m: f64, size: TreeSize) {
        self.trees += 1;
        self.trees_of_assumed_height += usize::from(size.height_m.is_none());
        let mut stream = Seed([0; 32]).child("tree", number).stream("height");
        let height_m = size.height_m.unwrap_or_else(|| stream.uniform(6.0, 10.0));
        let crown_m = size.crown_m.unwrap_or((0.2 * height_m).clamp(1.0, 4.5));
        let (trunk_m, crown_foot_m) = ((0.015 * height_m).clamp(0.08, 0.4), 0.35 * height_m);
        let id = self.next();
        self.add_box(ObstacleKind::TreeTrunk, id, at, DVec2::splat(trunk_m), 0.0, [base_m, base_m + crown_foot_m]);
        let half_height_m = 0.5 * (height_m - crown_foot_m);
        let space = OrientedBox {
            center_in_world: at.extend(base_m + crown_foot_m + half_height_m),
            half_extents_m: DVec2::splat(crown_m).extend(half_height_m),
            yaw_rad: 0.0,
        };
        let one = |shape| Obstacle { shape, kind: ObstacleKind::TreeCrown, object_id: id, synthetic: false };
        self.obstacles.extend(crown_boxes(&space, id).map(one));
    }

    fn add_tree_row(&mut self, way: &Way, line: &[DVec2], base_m: f64, size: TreeSize) {
        let mut left_m = 0.0;
        for pair in line.windows(2) {
            let length_m = pair[0].distance(pair[1]);
            let mut at_m = left_m;
            while at_m <= length_m {
                self.trees_of_rows += 1;
                self.add_tree(
                    way.id as u64 ^ (self.trees_of_rows as u64) << 40,
                    pair[0].lerp(pair[1], at_m / length_m.max(1e-9)),
                    base_m,
                    size,
                );
                at_m += TREE_SPACING_M;
            }
            left_m = at_m - length_m;
        }
    }

    /// A box along each side of a line, without the openings.
    fn add_barrier(
        &mut self,
        kind: ObstacleKind,
        object_id: u32,
        line: &[DVec2],
        (half_thickness_m, span_m): (f64, [f64; 2]),
        openings: &[DVec2],
    ) {
        for pair in line.windows(2) {
            let (length_m, step) = (pair[0].distance(pair[1]), pair[1] - pair[0]);
            let Some(along) = step.try_normalize() else { continue };
            let mut open: Vec<[f64; 2]> = openings
                .iter()
                .map(|point| (*point - pair[0], (*point - pair[0]).dot(along)))
                .filter(|(away, at)| (*away - *at * along).length() < HALF_OPENING_M)
                .map(|(_, at)| [at - HALF_OPENING_M, at + HALF_OPENING_M])
                .filter(|[from, to]| *to > 0.0 && *from < length_m)
                .collect();
            open.sort_by(|a, b| a[0].total_cmp(&b[0]));
            let mut from_m = 0.0;
            for [begin_m, end_m] in open.into_iter().chain([[length_m, length_m]]) {
                if begin_m - from_m > 0.1 {
                    let middle = pair[0] + 0.5 * (from_m + begin_m) * along;
                    let half_m = DVec2::new(0.5 * (begin_m - from_m), half_thickness_m);
                    self.add_box(kind, object_id, middle, half_m, real::atan2(along.y, along.x), span_m);
                }
                from_m = from_m.max(end_m);
            }
        }
    }
}
