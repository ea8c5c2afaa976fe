//! Buildings on the land between the streets: rows of lots around a courtyard, towers, a park, and a row all around.

use super::GenerateConfig;
use super::street_space::StreetSpace;
use super::streets::Network;
use crate::lot::Lot;
use crate::things::{Footprint, GeneratedThing, ThingKind};
use cosfly_frames::{DVec2, RandomStream, Seed, real};

/// Gap between buildings and pavements, metres.
const SETBACK_M: f64 = 0.6;
/// Distance of a front from the ends of its block, where the pavement rounds the corner, metres.
const CORNER_INSET_M: f64 = 1.7;
/// Length of the curves at the town's corners along its sides, metres.
const CURVE_REACH_M: f64 = 54.0;
/// Lots shallower than this are not built on, metres.
const MIN_DEPTH_M: f64 = 7.0;

/// Puts up buildings, and the trees, walls and benches of courtyards and parks.
pub fn build_blocks(
    network: &Network,
    space: &StreetSpace,
    config: &GenerateConfig,
    seed: Seed,
) -> Vec<GeneratedThing> {
    let mut site = FillSite { space, config, lots: Vec::new(), things: Vec::new() };
    let blocks = network.blocks();
    let park = seed.stream("park").index(blocks.len());
    for (index, &(low, high)) in blocks.iter().enumerate() {
        let mut stream = seed.child("block", index as u64).stream("lots");
        if index == park {
            site.park(low, high, &mut stream);
        } else if stream.chance(0.15) {
            site.towers(low, high, &mut stream);
        } else {
            site.courtyard_block(low, high, &mut stream);
        }
    }
    let mut stream = seed.stream("outer row");
    for street in network.streets.iter().filter(|street| !street.line.is_straight()) {
        if let Some(side) = street.outer_side {
            site.follow_curve(street, side, &mut stream);
        }
    }
    let (low, high) = network.outline();
    let size = high - low;
    for (corner, heading_rad, length_m) in [
        (low, 0.0, size.x),
        (DVec2::new(high.x, low.y), real::FRAC_PI_2, size.y),
        (high, real::PI, size.x),
        (DVec2::new(low.x, high.y), -real::FRAC_PI_2, size.y),
    ] {
        let (sin, cos) = real::sin_cos(heading_rad);
        let corner = corner + CURVE_REACH_M * DVec2::new(cos, sin);
        let row = Row { corner, heading_rad, length_m: length_m - 2.0 * CURVE_REACH_M, depth_m: 14.0, behind: -1.0 };
        site.build_row(&row, &mut stream);
    }
    site.things
}

/// A row of lots: from `corner` along `heading`, the buildings to the left (`behind` = 1) or right (-1) of it.
struct Row {
    corner: DVec2,
    heading_rad: f64,
    length_m: f64,
    depth_m: f64,
    behind: f64,
}

struct FillSite<'a> {
    space: &'a StreetSpace,
    config: &'a GenerateConfig,
    lots: Vec<Lot>,
    things: Vec<GeneratedThing>,
}

impl FillSite<'_> {
    fn height_m(&self, stream: &mut RandomStream) -> f64 {
        // Most are low; a few reach the top.
        let share = stream.unit();
        let rise = share * share;
        let exact_m = self.config.min_height_m + rise * (self.config.max_height_m - self.config.min_height_m);
        (10.0 * exact_m).round() / 10.0
    }

    fn is_free(&self, lot: &Lot, gap_m: f64) -> bool {
        self.space.is_clear(lot, gap_m) && self.lots.iter().all(|other| !lot.is_near(other, -0.01))
    }

    fn build(&mut self, lot: Lot, height_m: f64) -> bool {
        let free = lot.half_m.min_element() > 2.0 && self.is_free(&lot, SETBACK_M);
        if free {
            self.lots.push(lot);
            self.things.push(GeneratedThing::on_lot(ThingKind::Building, lot, height_m));
        }
        free
    }

    /// Buildings wall to wall along a front, with alleys and open lots in between.
    fn build_row(&mut self, row: &Row, stream: &mut RandomStream) {
        let (sin, cos) = real::sin_cos(row.heading_rad);
        let (along, behind) = (DVec2::new(cos, sin), DVec2::new(-sin, cos) * row.behind);
        let mut at_m = 0.0;
        while row.length_m - at_m > 8.0 {
            let rest_m = row.length_m - at_m;
            let wanted_m = stream.uniform(11.0, 24.0);
            let front_m = if rest_m < 1.6 * wanted_m { rest_m } else { wanted_m };
            let height_m = self.height_m(stream);
            let pulled_back_m = if stream.chance(0.3) { stream.uniform(0.0, 2.0) } else { 0.0 };
            let alley_m = if stream.chance(0.35) { stream.uniform(2.5, 5.0) } else { 0.0 };
            let is_built = stream.chance(self.config.building_density);
            // Where a street bends into the lot, stand farther back.
            let mut back_m = SETBACK_M + 0.4 + pulled_back_m;
            while is_built && row.depth_m - back_m >= MIN_DEPTH_M {
                let half_m = DVec2::new(0.5 * front_m - 0.02, 0.5 * (row.depth_m - back_m));
                let center = row.corner + along * (at_m + 0.5 * front_m) + behind * (back_m + half_m.y);
                if self.build(Lot { center, half_m, heading_rad: row.heading_rad }, height_m) {
                    break;
                }
                back_m += 1.5;
            }
            at_m += front_m + alley_m;
        }
    }

    /// Four rows around a courtyard; some corners are L-shaped.
    fn courtyard_block(&mut self, low: DVec2, high: DVec2, stream: &mut RandomStream) {
        let size = high - low;
        let depth_m = stream.uniform(12.0, 16.0).min(0.4 * size.min_element());
        let corner_m = self.corner_building(low, depth_m, stream);
        let inner_m = size.y - 2.0 * depth_m;
        let south_start_m = corner_m.max(CORNER_INSET_M);
        let west_start_m = corner_m.max(depth_m);
        for (corner, heading_rad, length_m, behind) in [
            (low + south_start_m * DVec2::X, 0.0, size.x - south_start_m - CORNER_INSET_M, 1.0),
            (DVec2::new(low.x + CORNER_INSET_M, high.y), 0.0, size.x - 2.0 * CORNER_INSET_M, -1.0),
            (low + west_start_m * DVec2::Y, real::FRAC_PI_2, size.y - depth_m - west_start_m, -1.0),
            (DVec2::new(high.x, low.y + depth_m), real::FRAC_PI_2, inner_m, 1.0),
        ] {
            self.build_row(&Row { corner, heading_rad, length_m, depth_m, behind }, stream);
        }
        self.courtyard(low + DVec2::splat(depth_m), high - DVec2::splat(depth_m), stream);
    }

    /// An L-shaped building around the block's south-west corner; gives how much of both fronts it takes, metres.
    fn corner_building(&mut self, low: DVec2, depth_m: f64, stream: &mut RandomStream) -> f64 {
        let (wing_m, height_m) = (depth_m + stream.uniform(6.0, 12.0), self.height_m(stream));
        let inset_m = CORNER_INSET_M;
        let thick_m = depth_m - inset_m - 2.0;
        let outer = low + DVec2::splat(inset_m);
        let reach_m = wing_m - inset_m;
        let wings = [DVec2::new(reach_m, thick_m), DVec2::new(thick_m, reach_m)].map(|size| Lot {
            center: outer + 0.5 * size,
            half_m: 0.5 * size,
            heading_rad: 0.0,
        });
        if !stream.chance(0.7) || thick_m < MIN_DEPTH_M || !wings.iter().all(|lot| self.is_free(lot, SETBACK_M)) {
            return 0.0;
        }
        self.lots.extend(wings);
        let corners =
            [(0.0, 0.0), (reach_m, 0.0), (reach_m, thick_m), (thick_m, thick_m), (thick_m, reach_m), (0.0, reach_m)]
                .map(|(x, y)| outer + DVec2::new(x, y));
        let footprint = Footprint::Polygon(corners.to_vec());
        self.things.push(GeneratedThing::new(ThingKind::Building, footprint, height_m));
        wing_m
    }

    fn courtyard(&mut self, low: DVec2, high: DVec2, stream: &mut RandomStream) {
        let size = high - low;
        if size.min_element() < 10.0 {
            return;
        }
        let lot = Lot { center: 0.5 * (low + high), half_m: DVec2::new(0.18, 0.22) * size, heading_rad: 0.0 };
        let has_house = stream.chance(0.5) && self.build(lot, (4.0 + 4.0 * stream.unit()).round());
        if !has_house {
            let half_m = DVec2::new(0.35 * size.x, 0.12);
            self.wall(Lot { half_m, ..lot }, stream);
        }
        for _ in 0..5 {
            let at = DVec2::new(stream.uniform(low.x + 2.0, high.x - 2.0), stream.uniform(low.y + 2.0, high.y - 2.0));
            self.plant(at, 1.5, stream);
        }
    }

    fn wall(&mut self, lot: Lot, stream: &mut RandomStream) {
        if self.is_free(&lot, 0.3) {
            self.lots.push(lot);
            self.things.push(GeneratedThing::on_lot(
                ThingKind::Wall,
                lot,
                (10.0 * stream.uniform(1.6, 2.4)).round() / 10.0,
            ));
        }
    }

    /// A tree off the street, at least `gap_m` from everything built.
    fn plant(&mut self, at: DVec2, gap_m: f64, stream: &mut RandomStream) {
        let tree = tree_at(at, stream);
        // Two crowns may touch, not swallow each other: the tree's place is a square of 2 m.
        let place = Lot { center: at, half_m: DVec2::splat(1.0), heading_rad: 0.0 };
        if self.space.is_clear(&place, 0.0) && self.lots.iter().all(|lot| lot.distance_m(at) > gap_m) {
            self.lots.push(place);
            self.things.push(tree);
        }
    }

    /// Two or three high buildings on open ground with trees.
    fn towers(&mut self, low: DVec2, high: DVec2, stream: &mut RandomStream) {
        let size = high - low;
        for share in [DVec2::new(0.27, 0.3), DVec2::new(0.73, 0.68), DVec2::new(0.75, 0.22)] {
            let half_m = DVec2::new(stream.uniform(0.12, 0.19) * size.x, stream.uniform(0.12, 0.17) * size.y);
            let top_m = self.config.max_height_m;
            let height_m = stream.uniform(0.6 * top_m, top_m).max(self.config.min_height_m).round();
            self.build(Lot { center: low + share * size, half_m, heading_rad: 0.0 }, height_m);
        }
        for _ in 0..14 {
            let at = DVec2::new(stream.uniform(low.x + 1.5, high.x - 1.5), stream.uniform(low.y + 1.5, high.y - 1.5));
            self.plant(at, 2.5, stream);
        }
    }

    /// Trees in loose rows, a broken wall around.
    fn park(&mut self, low: DVec2, high: DVec2, stream: &mut RandomStream) {
        let size = high - low;
        for (from, step) in [(low, DVec2::X), (DVec2::new(low.x, high.y), DVec2::X)] {
            for share in [0.25, 0.75] {
                let inward = if from.y == low.y { 1.0 } else { -1.0 };
                let center = from + step * (share * size.x) + DVec2::Y * inward;
                self.wall(Lot { center, half_m: DVec2::new(0.18 * size.x, 0.15), heading_rad: 0.0 }, stream);
            }
        }
        let (columns, rows) = ((size.x / 9.0) as usize, (size.y / 9.0) as usize);
        for column in 0..columns {
            for row in 0..rows {
                let jitter = DVec2::new(stream.uniform(-1.8, 1.8), stream.uniform(-1.8, 1.8));
                let cell = DVec2::new(column as f64 + 0.5, row as f64 + 0.5) / DVec2::new(columns as f64, rows as f64);
                if stream.chance(0.8) {
                    self.plant(low + cell * size + jitter, 1.5, stream);
                }
            }
        }
    }

    /// Buildings turned with a curve, on its outer side.
    fn follow_curve(&mut self, street: &super::streets::Street, side: f64, stream: &mut RandomStream) {
        let length_m = street.line.length_m();
        let mut at_m = 4.0;
        while at_m < length_m - 10.0 {
            let front_m = stream.uniform(10.0, 15.0);
            let depth_m = stream.uniform(10.0, 13.0);
            let height_m = self.height_m(stream);
            let is_built = stream.chance(self.config.building_density);
            let pose = street.line.pose_at(at_m + 0.5 * front_m);
            for back_m in [SETBACK_M + 0.3, SETBACK_M + 1.3] {
                let away_m = street.profile.half_width_m() + back_m + 0.5 * depth_m;
                let center = pose.moved(0.0, side * away_m).at;
                let lot = Lot { center, half_m: 0.5 * DVec2::new(front_m, depth_m), heading_rad: pose.heading_rad };
                if is_built && self.build(lot, height_m) {
                    break;
                }
            }
            at_m += front_m + 1.0;
        }
    }
}

/// A street tree: high enough to walk under, wide enough to hide a walker from above.
pub fn tree_at(center: DVec2, stream: &mut RandomStream) -> GeneratedThing {
    let tenths = |value: f64| (10.0 * value).round() / 10.0;
    let radius_m = (100.0 * stream.uniform(0.12, 0.22)).round() / 100.0;
    let (crown_m, base_m) = (tenths(stream.uniform(2.0, 3.1)), tenths(stream.uniform(2.6, 3.4)));
    let height_m = base_m + tenths(stream.uniform(3.6, 7.0));
    GeneratedThing::tree(center, radius_m, height_m, crown_m, base_m)
}
