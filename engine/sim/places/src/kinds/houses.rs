//! Houses along a front: detached, in pairs or in terraces, with gardens, hedges, fences, drives and cars.

use crate::geometry::{edges, middle, rectangle};
use crate::lot::Lot;
use crate::net::faces::Front;
use crate::site::{Site, Surface};
use crate::things::ThingKind;
use cosfly_frames::{DVec2, RandomStream, real};

/// Houses along a front.
#[derive(Clone, Debug)]
pub struct Houses {
    /// Houses wall to wall, the least and the most.
    pub in_a_row: [usize; 2],
    /// Width of a house, the least and the most, metres.
    pub width_m: [f64; 2],
    /// From front to back, metres.
    pub depth_m: [f64; 2],
    /// From the pavement to the front, metres.
    pub setback_m: [f64; 2],
    /// Between rows, metres.
    pub gap_m: [f64; 2],
    /// Height of the walls, metres.
    pub eaves_m: [f64; 2],
    /// From the back wall to the end of the garden, metres.
    pub garden_m: f64,
    /// Share of the plots with houses.
    pub density: f64,
    /// Share of the fronts with a hedge, not a fence; neither where it is 0.
    pub hedges: f64,
    /// Share of the gaps with a drive and a car.
    pub cars: f64,
    /// How far drives reach under the pavement, metres: they meet it where it bends, too.
    pub drive_onto_m: f64,
    /// Share of the gardens with trees.
    pub trees: f64,
}

/// A place on a front.
struct Spot {
    at: DVec2,
    along: DVec2,
}

/// Where a front is after so many metres.
fn spot(front: &Front, mut along_m: f64) -> Option<Spot> {
    for pair in front.points.windows(2) {
        let length_m = pair[0].distance(pair[1]);
        if along_m <= length_m && length_m > 0.0 {
            let along = (pair[1] - pair[0]) / length_m;
            return Some(Spot { at: pair[0] + along_m * along, along });
        }
        along_m -= length_m;
    }
    None
}

/// Length of a front, metres.
pub fn length_m(front: &Front) -> f64 {
    front.points.windows(2).map(|pair| pair[0].distance(pair[1])).sum()
}

impl Houses {
    /// Puts houses along a front of the land.
    pub fn along(&self, site: &mut Site, front: &Front, stream: &mut RandomStream) {
        let length_m = length_m(front);
        let mut at_m = stream.uniform(1.5, 3.0);
        while at_m < length_m - self.width_m[0] {
            let count = self.in_a_row[0] + stream.index(self.in_a_row[1] - self.in_a_row[0] + 1);
            let [width_m, depth_m, setback_m, gap_m, eaves_m] =
                [self.width_m, self.depth_m, self.setback_m, self.gap_m, self.eaves_m]
                    .map(|[low, high]| stream.uniform(low, high));
            let roof_m = 0.5 * depth_m.min(if count == 1 { width_m } else { depth_m }) * stream.uniform(0.6, 0.95);
            let row_m = width_m * count as f64;
            let is_built = stream.chance(self.density);
            let fits = at_m + row_m <= length_m;
            let along = spot(front, at_m + 0.5 * row_m.min(length_m - at_m));
            if let Some(spot) = along.filter(|_| is_built && fits) {
                let tenths = |value: f64| (10.0 * value).round() / 10.0;
                let row = Row { spot, count, width_m, depth_m, setback_m, gap_m };
                self.row(site, &row, [tenths(eaves_m), tenths(roof_m)], stream);
            }
            at_m += row_m + gap_m;
        }
    }

    fn row(&self, site: &mut Site, row: &Row, [eaves_m, roof_m]: [f64; 2], stream: &mut RandomStream) {
        let along = row.spot.along;
        let front = |offset_m: f64, back_m: f64| row.spot.at + offset_m * along + back_m * along.perp();
        let whole = rectangle(front(0.0, row.setback_m), along, DVec2::new(row.length_m(), row.depth_m));
        if !site.is_free(&whole, 0.4, 0.6) {
            return;
        }
        for house in 0..row.count {
            let offset_m = (house as f64 + 0.5) * row.width_m - 0.5 * row.length_m();
            let plan = rectangle(front(offset_m, row.setback_m), along, DVec2::new(row.width_m - 0.02, row.depth_m));
            site.build_beside(&plan, eaves_m, roof_m);
        }
        let drive_m = 0.5 * (row.length_m() + row.gap_m);
        if row.gap_m >= 3.2 && stream.chance(self.cars) {
            self.drive(site, row, drive_m, stream);
        }
        if self.hedges > 0.0 && row.setback_m >= 2.0 {
            let is_hedge = stream.chance(self.hedges);
            for house in 0..row.count {
                let [left, right] = [house, house + 1].map(|at| at as f64 * row.width_m - 0.5 * row.length_m());
                enclose(site, [front(left + 0.2, 0.5), front(right - 1.6, 0.5)], is_hedge);
            }
        }
        let back_m = row.setback_m + row.depth_m;
        for house in 0..=row.count {
            let offset_m = house as f64 * row.width_m - 0.5 * row.length_m();
            enclose(site, [front(offset_m, back_m + 0.3), front(offset_m, back_m + self.garden_m)], false);
        }
        for house in 0..row.count {
            if stream.chance(self.trees) {
                let offset_m = (house as f64 + stream.uniform(0.3, 0.7)) * row.width_m - 0.5 * row.length_m();
                let at = front(offset_m, back_m + stream.uniform(0.45, 0.9) * self.garden_m);
                site.plant(at, stream.uniform(1.3, 2.8), stream);
            }
        }
    }

    fn drive(&self, site: &mut Site, row: &Row, offset_m: f64, stream: &mut RandomStream) {
        let along = row.spot.along;
        let at = row.spot.at + offset_m * along;
        let drive = rectangle(at + 0.05 * along.perp(), along, DVec2::new(2.8, row.setback_m + 0.8 * row.depth_m));
        if !site.is_free(&drive, 0.0, 0.1) {
            return;
        }
        let onto_m = self.drive_onto_m;
        let size_m = DVec2::new(2.8, row.setback_m + 0.8 * row.depth_m + onto_m);
        site.surface(&rectangle(at + (0.05 - onto_m) * along.perp(), along, size_m), Surface::Paving);
        let center = at + (row.setback_m + stream.uniform(0.0, 0.4) * row.depth_m) * along.perp();
        let heading_rad = real::atan2(along.y, along.x) + real::FRAC_PI_2;
        site.stand(ThingKind::Car, Lot { center, half_m: DVec2::new(2.15, 0.9), heading_rad }, 1.5, 0.1);
        site.take(&drive);
    }
}

/// Houses wall to wall.
struct Row {
    spot: Spot,
    count: usize,
    width_m: f64,
    depth_m: f64,
    setback_m: f64,
    gap_m: f64,
}

impl Row {
    fn length_m(&self) -> f64 {
        self.width_m * self.count as f64
    }
}

fn enclose(site: &mut Site, ends: [DVec2; 2], is_hedge: bool) {
    if is_hedge {
        site.enclose(ThingKind::Hedge, ends, 0.6, 1.2);
    } else {
        site.enclose(ThingKind::Fence, ends, 0.1, 1.3);
    }
}

/// Trees at random places of an outline.
pub fn scatter(site: &mut Site, outline: &[DVec2], count: usize, crown_m: [f64; 2], stream: &mut RandomStream) {
    let [low, high] = crate::geometry::bounds(outline);
    for _ in 0..count {
        let at = DVec2::new(stream.uniform(low.x, high.x), stream.uniform(low.y, high.y));
        let crown_m = stream.uniform(crown_m[0], crown_m[1]);
        if crate::geometry::contains(outline, at) {
            site.plant(at, crown_m, stream);
        }
    }
}

/// A playground: sand, three frames to climb and swing on, a fence around with a gap.
pub fn playground(site: &mut Site, center: DVec2, along: DVec2) -> bool {
    let plan = rectangle(center - 6.0 * along.perp(), along, DVec2::new(16.0, 12.0));
    if !site.is_free(&plan, 1.0, 0.5) {
        return false;
    }
    site.surface(&plan, Surface::Gravel);
    for (x, y, size_m, height_m) in [
        (-4.0, -1.0, DVec2::new(3.6, 0.5), 2.3),
        (3.0, 2.0, DVec2::new(2.4, 2.4), 2.6),
        (3.5, -3.0, DVec2::new(3.0, 0.8), 1.6),
    ] {
        let lot = Lot {
            center: middle(&plan) + x * along + y * along.perp(),
            half_m: 0.5 * size_m,
            heading_rad: real::atan2(along.y, along.x),
        };
        site.stand(ThingKind::PlayEquipment, lot, height_m, 0.1);
    }
    for (number, [a, b]) in edges(&plan).enumerate() {
        let end = if number == 0 { a.lerp(b, 0.7) } else { b };
        let step = (b - a).normalize();
        site.enclose(ThingKind::Fence, [a + 0.3 * step, end - 0.3 * step], 0.08, 1.0);
    }
    site.take(&plan);
    true
}
