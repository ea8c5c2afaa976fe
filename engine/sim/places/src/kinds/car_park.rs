//! A car park: marked bays along aisles, cars in some of them, trees between, lamps.

use crate::geometry::rectangle;
use crate::lot::Lot;
use crate::site::{Site, Surface};
use crate::things::{Footprint, GeneratedThing, ThingKind};
use cosfly_frames::{DVec2, RandomStream, real};

/// Length and width of a bay, metres.
const BAY_M: DVec2 = DVec2::new(5.0, 2.5);
const AISLE_M: f64 = 6.0;
/// Two rows of bays with their aisle, metres.
const DOUBLE_ROW_M: f64 = 2.0 * BAY_M.x + AISLE_M;
/// Width of the way on foot through the middle, metres.
const WAY_M: f64 = 3.0;
const LINE_M: f64 = 0.12;
/// Every so many bays a tree stands in place of a car.
const TREE_BAYS: i32 = 9;

/// A car park on a rectangle to the left of its front.
pub struct CarPark {
    /// Middle of the front, metres.
    pub front: DVec2,
    /// Direction of the front.
    pub along: DVec2,
    /// Along the front and across it, metres.
    pub size_m: DVec2,
    /// Share of the bays with a car.
    pub filled: f64,
    /// How far the way on foot reaches beyond the front and the back, metres; without it nobody walks here.
    pub way_m: Option<[f64; 2]>,
}

impl CarPark {
    /// Builds it, if its ground is free.
    pub fn put(&self, site: &mut Site, stream: &mut RandomStream) -> bool {
        let plan = rectangle(self.front, self.along, self.size_m);
        let rows = (self.size_m.y / DOUBLE_ROW_M).floor();
        if rows < 1.0 || self.size_m.x < 4.0 * BAY_M.y || !site.is_free(&plan, 0.3, 0.3) {
            return false;
        }
        let across = self.along.perp();
        site.surface(&plan, Surface::Asphalt);
        let first_m = 0.5 * (self.size_m.y - rows * DOUBLE_ROW_M);
        for row in 0..rows as usize {
            let near_m = first_m + row as f64 * DOUBLE_ROW_M;
            for middle_m in [near_m + 0.5 * BAY_M.x, near_m + DOUBLE_ROW_M - 0.5 * BAY_M.x] {
                self.bays(site, middle_m, stream);
            }
            let lamp = self.front + (near_m + DOUBLE_ROW_M - 0.1) * across + 0.25 * self.size_m.x * self.along;
            let foot = Footprint::Disc { center: lamp, radius_m: 0.1 };
            site.things.push(GeneratedThing::new(ThingKind::Lamp, foot, 8.0));
            if self.way_m.is_some() {
                let aisle = self.front + (near_m + BAY_M.x) * across;
                site.walk_over(&rectangle(aisle, self.along, DVec2::new(self.size_m.x, AISLE_M)));
            }
        }
        if let Some([before_m, behind_m]) = self.way_m {
            let ends = [self.front - before_m * across, self.front + (self.size_m.y + behind_m) * across];
            site.path(&ends, WAY_M, Surface::Paving);
        }
        site.take(&plan);
        true
    }

    /// A row of bays whose middle lies `middle_m` behind the front.
    fn bays(&self, site: &mut Site, middle_m: f64, stream: &mut RandomStream) {
        let across = self.along.perp();
        let heading_rad = real::atan2(across.y, across.x);
        let count = (0.5 * self.size_m.x / BAY_M.y).floor() as i32 - 1;
        for bay in -count..count {
            let middle_of_bay_m = (f64::from(bay) + 0.5) * BAY_M.y;
            if self.way_m.is_some() && middle_of_bay_m.abs() < 0.5 * (WAY_M + BAY_M.y) {
                continue;
            }
            let center = self.front + middle_m * across + middle_of_bay_m * self.along;
            let lot = Lot { center, half_m: 0.5 * BAY_M, heading_rad };
            site.things.push(GeneratedThing::on_lot(ThingKind::Bay, lot, 0.0));
            let line = center + 0.5 * (BAY_M.y * self.along - BAY_M.x * across);
            site.surface(&rectangle(line, self.along, DVec2::new(LINE_M, BAY_M.x)), Surface::Paint);
            if bay.rem_euclid(TREE_BAYS) == 0 {
                site.plant(center, stream.uniform(1.5, 2.4), stream);
            } else if stream.chance(self.filled) {
                let half_m = DVec2::new(stream.uniform(2.0, 2.35), 0.9);
                let center = center + stream.uniform(-0.2, 0.2) * across;
                site.stand(ThingKind::Car, Lot { center, half_m, heading_rad }, stream.uniform(1.4, 1.7), 0.1);
            }
        }
    }
}
