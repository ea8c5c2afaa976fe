//! Surroundings of a place, so that it does not end in a lawn: fields, woods, further houses.

use super::houses::scatter;
use crate::geometry::{disc, edges, inset, rectangle};
use crate::site::{Site, Surface};
use crate::things::ThingKind;
use cosfly_frames::{DVec2, RandomStream, Seed, real};

/// How far from the outermost streets things stand, metres.
const REACH_M: f64 = 110.0;

/// Trees that are tried in a copse.
const COPSE: usize = 16;

/// Surroundings of a place.
#[derive(Clone, Copy, Debug)]
pub struct Around {
    /// Ploughed fields.
    pub fields: usize,
    /// Places where trees are tried.
    pub trees: usize,
    /// Rows of houses behind the outermost ones.
    pub rows: usize,
    /// Height of their walls, the least and the most, metres.
    pub eaves_m: [f64; 2],
}

impl Around {
    /// Puts it up; what stands already stays.
    pub fn put(&self, site: &mut Site, seed: Seed) {
        let mut stream = seed.stream("around");
        let fronts: Vec<[DVec2; 2]> = site
            .faces
            .iter()
            .filter(|face| !face.is_enclosed)
            .flat_map(|face| face.fronts.iter().map(|front| front.ends()))
            .collect();
        for row in 0..self.rows {
            for front in &fronts {
                self.row(site, *front, 38.0 + 30.0 * row as f64, &mut stream);
            }
        }
        fields(site, self.fields, &mut seed.stream("fields around"));
        let [low, high] = site.network.bounds(REACH_M);
        let around = [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)];
        let mut stream = seed.stream("trees around");
        for _ in 0..self.trees / COPSE {
            let at = DVec2::new(stream.uniform(low.x, high.x), stream.uniform(low.y, high.y));
            scatter(site, &disc(at, stream.uniform(6.0, 24.0), 8), COPSE, [1.8, 4.4], &mut stream);
        }
        scatter(site, &around, self.trees / 2, [1.8, 4.4], &mut stream);
    }

    /// Houses along a line behind a front.
    fn row(&self, site: &mut Site, [from, to]: [DVec2; 2], behind_m: f64, stream: &mut RandomStream) {
        let Some(along) = (to - from).try_normalize() else { return };
        let mut at_m = -behind_m;
        while at_m < from.distance(to) + behind_m {
            let size_m = DVec2::new(stream.uniform(9.0, 22.0), stream.uniform(8.5, 12.0));
            let front = from + (at_m + 0.5 * size_m.x) * along + (behind_m + stream.uniform(-3.0, 3.0)) * along.perp();
            let [eaves_m, roof_m] = [stream.uniform(self.eaves_m[0], self.eaves_m[1]), 0.3 * size_m.y]
                .map(|height_m| (10.0 * height_m).round() / 10.0);
            if stream.chance(0.75) {
                site.build(&rectangle(front, along, size_m), eaves_m, roof_m, 3.0);
            }
            at_m += size_m.x + stream.uniform(4.0, 14.0);
        }
    }
}

/// Ploughed fields with fences and hedges around them.
pub fn fields(site: &mut Site, count: usize, stream: &mut RandomStream) {
    let [low, high] = site.network.bounds(REACH_M);
    let mut made = 0;
    for _ in 0..60 * count {
        if made == count {
            return;
        }
        let at = DVec2::new(stream.uniform(low.x, high.x), stream.uniform(low.y, high.y));
        let (sin, cos) = real::sin_cos(stream.uniform(0.0, real::PI));
        let size_m = DVec2::new(stream.uniform(40.0, 90.0), stream.uniform(30.0, 60.0));
        let along = DVec2::new(cos, sin);
        let field = rectangle(at - 0.5 * size_m.y * along.perp(), along, size_m);
        if !site.is_free(&field, 2.5, 2.0) {
            continue;
        }
        made += 1;
        site.surface(&inset(&field, 1.5), Surface::Soil);
        let is_hedge = stream.chance(0.5);
        for [a, b] in edges(&field) {
            let (kind, thick_m) = if is_hedge { (ThingKind::Hedge, 0.9) } else { (ThingKind::Fence, 0.08) };
            let step = (b - a).normalize();
            site.enclose(kind, [a + 1.0 * step, b - 1.0 * step], thick_m, if is_hedge { 1.6 } else { 1.1 });
        }
        site.take(&field);
    }
}
