//! [`Passages`]: ways that lead through buildings, and what they leave of a building.

use super::elements::{Elements, Way};
use super::frame::Frame;
use super::paths;
use super::rings::Area;
use super::roads::{Road, lines_of};
use super::stated::{Doubts, Quantity};
use super::tags::Tags;
use cosfly_frames::DVec2;
use cosfly_town::regions::PlanRegion;
use std::collections::{BTreeMap, BTreeSet};

/// Clear height of a passage that states none: for people, and for vehicles, metres.
pub const CLEAR_M: [f64; 2] = [3.0, 4.0];
/// Lowest passage, metres; one that states less is as high.
pub const LOWEST_M: f64 = 2.2;
/// Highest passage that is believed, metres.
const HIGHEST_M: f64 = 30.0;
/// Least height of the building above a passage, metres.
const LINTEL_M: f64 = 0.3;
/// Distance on each side of a way that is cut out beyond its width, metres: boxes stand over what is left by up to 0.5 m, a
/// tenth more where rows of slanted sides are joined.
const SPARE_M: f64 = 0.55;
/// Distance by which a passage goes on beyond the ends of its way, metres.
const BEYOND_M: f64 = 0.5;
/// Places along a way where it is looked for a building over it lie this far apart, metres, and are at most so many.
const SAMPLE_M: f64 = 0.5;
const MOST_SAMPLES: f64 = 256.0;
/// Most stretches of passages through one building.
const MOST_STRETCHES: usize = 16;
/// Side of a cell of the index, metres.
const CELL_M: f64 = 32.0;

/// Clear height of a passage; lower ones are made as high as the lowest.
const CLEAR: Quantity = Quantity {
    is_word: |text| ["default", "none", "unsigned", "below_default", "no_sign", "no_indications"].contains(&text),
    ..Quantity::length("passages", &["maxheight", "height"], [1.0, HIGHEST_M], "they have the usual height")
};
const HIGH_ENOUGH: Quantity =
    Quantity { range: [LOWEST_M, HIGHEST_M], instead: "they are as high as the lowest", ..CLEAR };

/// A straight stretch of a passage.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    from: DVec2,
    to: DVec2,
    /// Ground that stays clear.
    quad: [DVec2; 4],
    clear_m: f64,
    is_assumed: bool,
    way: i64,
}

/// All passages of an extract, and what became of them.
#[derive(Debug, Default)]
pub struct Passages {
    stretches: Vec<Stretch>,
    cells: BTreeMap<(i32, i32), Vec<u32>>,
    /// Ways that lead through a building.
    pub open: BTreeSet<i64>,
    /// Those of them that state no height.
    pub of_assumed_height: BTreeSet<i64>,
    /// Ways under a building that is too low, or through one with too many passages.
    pub closed: BTreeSet<i64>,
}

/// A layer of a building between two heights, metres.
#[derive(Debug)]
pub struct Layer {
    /// Solid plan without the passage, world frame.
    pub regions: Vec<PlanRegion>,
    /// Lower end.
    pub base_m: f64,
    /// Upper end.
    pub top_m: f64,
}

/// Whether a way may lead through buildings.
fn is_passage(tags: &Tags) -> bool {
    let above = |key| tags.number(key).is_some_and(|number| number > 0.0);
    let is_on_the_ground = !(tags.is_hidden() || tags.has("bridge") || above("layer") || above("level"));
    let is_covered = tags.is("covered", &["yes"]) && paths::usual_width_m(tags).is_some();
    is_on_the_ground && (tags.is("tunnel", &["building_passage"]) || is_covered)
}

/// Clear height that a way states, metres.
fn clear_m(way: &Way, doubts: &mut Doubts) -> Option<f64> {
    let name = format_args!("way {}", way.id);
    let stated_m = doubts.read(&way.tags, &CLEAR, name);
    if stated_m.is_some_and(|stated_m| stated_m < LOWEST_M) {
        doubts.add(&way.tags, &HIGH_ENOUGH, name);
    }
    stated_m
}

impl Passages {
    /// The passages of an extract.
    pub fn read(elements: &Elements, frame: &Frame, roads: &[Road<'_>], doubts: &mut Doubts) -> Self {
        let mut passages = Self::default();
        for way in elements.ways.iter().filter(|way| is_passage(&way.tags)) {
            let Some(width_m) = paths::usual_width_m(&way.tags) else { continue };
            let lines = lines_of(elements, frame, &way.nodes);
            passages.add(way, &lines, 0.5 * width_m, clear_m(way, doubts), CLEAR_M[0]);
        }
        for road in roads.iter().filter(|road| is_passage(&road.way.tags)) {
            passages.add(road.way, &road.pieces, road.half_width_m, clear_m(road.way, doubts), CLEAR_M[1]);
        }
        passages
    }

    fn add(&mut self, way: &Way, pieces: &[Vec<DVec2>], half_width_m: f64, stated_m: Option<f64>, usual_m: f64) {
        let clear_m = stated_m.unwrap_or(usual_m).max(LOWEST_M);
        let half_m = half_width_m + SPARE_M;
        for piece in pieces {
            for (index, pair) in piece.windows(2).enumerate() {
                let (from, to) = (pair[0], pair[1]);
                let Some(along) = (to - from).try_normalize() else { continue };
                // Around a bend stretches reach as far as the outer corner.
                let reach = |is_end: bool| if is_end { BEYOND_M } else { half_m };
                let (back, on) = (from - reach(index == 0) * along, to + reach(index + 2 == piece.len()) * along);
                let aside = half_m * along.perp();
                let quad = [back - aside, on - aside, on + aside, back + aside];
                self.index(Stretch { from, to, quad, clear_m, is_assumed: stated_m.is_none(), way: way.id });
            }
        }
    }

    /// Files a stretch under every cell that it touches, in pieces no longer than a cell, so that slanted ones touch few.
    fn index(&mut self, stretch: Stretch) {
        let number = self.stretches.len() as u32;
        let count = (stretch.from.distance(stretch.to) / CELL_M).ceil().max(1.0) as usize;
        for piece in 0..count {
            let at = |step: usize| cell(stretch.from.lerp(stretch.to, step as f64 / count as f64));
            let (a, b) = (at(piece), at(piece + 1));
            for row in a.1.min(b.1)..=a.1.max(b.1) {
                for column in a.0.min(b.0)..=a.0.max(b.0) {
                    let there = self.cells.entry((column, row)).or_default();
                    if there.last() != Some(&number) {
                        there.push(number);
                    }
                }
            }
        }
        self.stretches.push(stretch);
    }

    /// Stretches whose middle line may lie in a rectangle, in their order.
    fn near(&self, low: DVec2, high: DVec2) -> Vec<Stretch> {
        let (from, to) = (cell(low), cell(high));
        let mut numbers: BTreeSet<u32> = BTreeSet::new();
        for row in self.cells_between(from, to) {
            numbers.extend(row);
        }
        numbers.into_iter().map(|number| self.stretches[number as usize]).collect()
    }

    /// The lists of the cells between two, whichever are fewer: those cells, or all that have a list.
    fn cells_between(&self, from: (i32, i32), to: (i32, i32)) -> Vec<&Vec<u32>> {
        let columns = i64::from(to.0) - i64::from(from.0) + 1;
        let is_between = |column: i32, row: i32| (from.0..=to.0).contains(&column) && (from.1..=to.1).contains(&row);
        if columns > self.cells.len() as i64 {
            return self.cells.iter().filter(|((x, y), _)| is_between(*x, *y)).map(|(_, list)| list).collect();
        }
        (from.0..=to.0).flat_map(|x| self.cells.range((x, from.1)..=(x, to.1))).map(|(_, list)| list).collect()
    }

    /// The lower layers of a building, lowest first, where passages lead through it; none where none does. Above the last
    /// layer the building is whole.
    pub fn layers(&mut self, area: &Area<'_>, base_m: f64, eaves_m: f64) -> Vec<Layer> {
        if self.stretches.is_empty() || base_m >= LOWEST_M {
            return Vec::new();
        }
        let low = area.outer.iter().copied().fold(DVec2::INFINITY, DVec2::min);
        let high = area.outer.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
        let mut through = self.near(low, high);
        through.retain(|stretch| stretch.leads_through(area));
        let most_m = eaves_m - LINTEL_M;
        through.iter_mut().for_each(|stretch| stretch.clear_m = stretch.clear_m.min(most_m));
        let ways = || through.iter().map(|stretch| stretch.way);
        if most_m < LOWEST_M || through.len() > MOST_STRETCHES {
            self.closed.extend(ways());
            return Vec::new();
        }
        let Some(layers) = layers(area, base_m, &through) else {
            self.closed.extend(ways());
            return Vec::new();
        };
        self.open.extend(ways());
        self.of_assumed_height.extend(through.iter().filter(|stretch| stretch.is_assumed).map(|stretch| stretch.way));
        layers
    }

    /// Note on the passages, as a sentence: how many are open, and how many not.
    pub fn note(&self) -> String {
        let closed = self.closed.difference(&self.open).count();
        let [people_m, vehicles_m] = CLEAR_M;
        format!(
            "{} passages through buildings are open ({} of an assumed height: {people_m} m, for vehicles {vehicles_m} m), {closed} \
             are closed, because the building over them is lower than {} m, \
             has more than {MOST_STRETCHES} of them, or crosses itself",
            self.open.len(),
            self.of_assumed_height.len(),
            LOWEST_M + LINTEL_M
        )
    }
}

/// The layers that stretches leave of a building; `None` where its outline cannot be cut.
fn layers(area: &Area<'_>, base_m: f64, through: &[Stretch]) -> Option<Vec<Layer>> {
    let mut tops_m: Vec<f64> = through.iter().map(|stretch| stretch.clear_m).collect();
    tops_m.sort_by(f64::total_cmp);
    tops_m.dedup();
    let whole = PlanRegion::new(&area.outer, &area.holes);
    let mut layers = Vec::with_capacity(tops_m.len());
    let mut below_m = base_m;
    for top_m in tops_m {
        let mut regions = vec![whole.clone()];
        for stretch in through.iter().filter(|stretch| stretch.clear_m >= top_m) {
            let cut: Option<Vec<Vec<PlanRegion>>> =
                regions.iter().map(|region| region.outside(&stretch.quad)).collect();
            regions = cut?.into_iter().flatten().collect();
        }
        layers.push(Layer { regions, base_m: below_m, top_m });
        below_m = top_m;
    }
    Some(layers)
}

impl Stretch {
    /// Whether a part of the middle line lies in an area.
    fn leads_through(&self, area: &Area<'_>) -> bool {
        let count = (self.from.distance(self.to) / SAMPLE_M).ceil().clamp(1.0, MOST_SAMPLES);
        (0..count as usize).any(|step| area.contains(self.from.lerp(self.to, (step as f64 + 0.5) / count)))
    }
}

fn cell(point: DVec2) -> (i32, i32) {
    ((point.x / CELL_M).floor() as i32, (point.y / CELL_M).floor() as i32)
}
