//! Covers a footprint with few turned rectangles that contain it.
//!
//! The footprint is cut into rows along one of its sides; rows of nearly the same reach become one strip. Walls that are slanted
//! to the rows get a rectangle of their own where that takes fewer. Where the strips are many, rectangles grow one by one
//! between the walls ([`crooked`]).

mod crooked;
mod pieces;
mod plan;
mod rows;
mod thinning;
mod walls;

pub use plan::{CoverPlan, TurnedRectangle};
pub(crate) use rows::{Row, Rows, Span, strips};

use crate::polygons::contains;
use cosfly_frames::DVec2;
use walls::Wall;

/// A rectangle's overhang beyond the outline is at most this deep, metres, wherever [`MOST`] rectangles are enough; less for
/// things of a few metres.
pub const COVER_TOLERANCE_M: f64 = 0.25;
/// Overhang over more crooked outlines, metres. Only of a [`Cover::coarse`] one it is deeper.
pub const LOOSE_TOLERANCE_M: f64 = 0.5;
/// Few rectangles of one footprint: where rows need more, other covers are tried.
const FEW: usize = 20;
/// Rectangles of one footprint that are not yet very many.
pub const MOST: usize = 64;
/// Most rectangles of one footprint; with more, its cover is coarse.
const VERY_MOST: usize = 2000;
/// Tolerance as a share of the square root of the area.
const TOLERANCE_SHARE: f64 = 0.04;
/// Strips stand over rows of slanted sides by a tenth more than they are asked to where such rows are joined.
const ROWS_SHARE: f64 = 1.0 / 1.1;
/// How far corners stand over an outline that was thinned out, as a multiple of what that moved: once for the outline, and
/// both sides of the corner grow by as much.
const MOVED_SHARE: f64 = 1.0 + core::f64::consts::SQRT_2;
/// Least tolerance that is left to outlines that were thinned out, metres.
const LEAST_TOLERANCE_M: f64 = 0.1;
/// Places along each side of a coarse cover at which its area is measured.
const SAMPLES: usize = 128;

/// Rectangles over a footprint.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cover {
    /// The rectangles; their union contains the footprint.
    pub rectangles: Vec<TurnedRectangle>,
    /// Where the footprint has so many corners that the rectangles stand over it by more than [`LOOSE_TOLERANCE_M`].
    pub coarse: Option<Coarse>,
}

/// Gain of a coarse cover.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Coarse {
    /// Ground under rectangles that is not of the footprint, square metres, measured on a grid.
    pub gained_m2: f64,
}

/// Rectangles whose union contains the polygon (corners in order, either way round); see [`cover_rings`].
pub fn cover_polygon(outline: &[DVec2]) -> Vec<TurnedRectangle> {
    cover_rings(&[outline], &[]).rectangles
}

/// Rectangles whose union contains what the outer rings enclose and the holes do not, each either way round, crossed
/// ones too. Rings without an area give one rectangle at most; a coordinate that is not finite gives none. Rings of very
/// many corners are thinned out first, and the rectangles grow by what that moved.
pub fn cover_rings(outer: &[&[DVec2]], holes: &[&[DVec2]]) -> Cover {
    match CoverPlan::of(outer, holes) {
        Some(plan) => plan.cover(COVER_TOLERANCE_M, MOST),
        None => Cover::default(),
    }
}

impl CoverPlan {
    /// The cover: with a tolerance of at most `tolerance_m` where `wanted` rectangles are enough, else of
    /// [`LOOSE_TOLERANCE_M`] and of as many as that takes.
    pub fn cover(&self, tolerance_m: f64, wanted: usize) -> Cover {
        let plain = self.angles_rad.iter().map(|angle| Way { yaw_rad: *angle, rows: self.rows(*angle), walls: vec![] });
        let mut ways: Vec<Way> = plain.collect();
        let left_m = |tolerance_m: f64| tolerance_m - MOVED_SHARE * self.moved_m;
        let loose_m = left_m(LOOSE_TOLERANCE_M);
        let is_absurd = loose_m < LEAST_TOLERANCE_M || ways.iter().any(|way| way.rows.are_too_many());
        let within = if is_absurd { None } else { self.cover_within(&mut ways, left_m(tolerance_m), loose_m, wanted) };
        match within {
            // Rings without an area have no rows; the rectangle around them has none either.
            Some(rectangles) if rectangles.is_empty() => Cover { rectangles: self.least_around(), coarse: None },
            Some(rectangles) => Cover { rectangles, coarse: None },
            None => {
                let rectangles = self.coarse_cover(MOST);
                let coarse = Some(Coarse { gained_m2: self.gained_m2(&rectangles) });
                Cover { rectangles, coarse }
            }
        }
    }

    /// The smallest rectangle around everything in one of the directions.
    fn least_around(&self) -> Vec<TurnedRectangle> {
        let around = self.angles_rad.iter().map(|angle| vec![self.bounding(*angle)]);
        around.min_by(|a, b| sum_m2(a).total_cmp(&sum_m2(b))).unwrap_or_default()
    }

    /// Rows that end behind the walls that are slanted to them, if any are.
    fn way_behind(&self, walls: &[Wall], yaw_rad: f64, tolerance_m: f64) -> Option<Way> {
        let slanted: Vec<&Wall> = walls.iter().filter(|wall| wall.is_slanted(yaw_rad, tolerance_m)).collect();
        let rings = self.rings.iter().enumerate().map(|(index, ring)| {
            let own = |side: usize| slanted.iter().find(move |wall| wall.ring == index && wall.side == side);
            let mut corners = Vec::with_capacity(ring.len());
            for (side, corner) in ring.iter().enumerate() {
                corners.push((*corner, 0.0));
                if let Some(wall) = own(side) {
                    corners.extend([(wall.ends[0], wall.depth_m), (wall.ends[1], 0.0)]);
                }
            }
            let (points, depths_m): (Vec<DVec2>, Vec<f64>) = corners.into_iter().unzip();
            (self.turned(&points, yaw_rad), depths_m, index >= self.outer_count)
        });
        (!slanted.is_empty()).then(|| Way {
            yaw_rad,
            rows: Rows::behind_walls(rings),
            walls: slanted.iter().map(|wall| wall.rectangle(self)).collect(),
        })
    }

    /// Rectangles that keep to a tolerance: rows where few are enough, else rectangles one by one.
    fn cover_within(
        &self,
        ways: &mut Vec<Way>,
        tight_m: f64,
        loose_m: f64,
        wanted: usize,
    ) -> Option<Vec<TurnedRectangle>> {
        let walls = walls::walls(self);
        ways.extend(self.angles_rad.iter().filter_map(|angle| self.way_behind(&walls, *angle, tight_m)));
        let rows = |tolerance_m: f64, most: usize| {
            let best = self.best_rows(ways, ROWS_SHARE * tolerance_m);
            best.filter(|cover| cover.len() <= most)
        };
        let tight_m = tight_m.max(LEAST_TOLERANCE_M);
        let mut tolerance_m = (TOLERANCE_SHARE * self.area_m2().sqrt()).clamp(0.02, tight_m);
        loop {
            if let Some(cover) = rows(tolerance_m, FEW.min(wanted)) {
                return Some(cover);
            }
            if tolerance_m >= tight_m {
                break;
            }
            tolerance_m = (tolerance_m * core::f64::consts::SQRT_2).min(tight_m);
        }
        crooked::cover(self, tight_m, wanted)
            .or_else(|| rows(loose_m, wanted))
            .or_else(|| crooked::cover(self, loose_m, VERY_MOST))
    }

    /// The cover of fewest strips among some ways; `None` where all are empty.
    fn best_rows(&self, ways: &[Way], tolerance_m: f64) -> Option<Vec<TurnedRectangle>> {
        let covers = ways.iter().map(|way| {
            let mut cover = self.rectangles(strips(way.rows.cut(tolerance_m), tolerance_m), way.yaw_rad);
            cover.extend(&way.walls);
            cover
        });
        let best = covers.min_by(|a, b| a.len().cmp(&b.len()).then(sum_m2(a).total_cmp(&sum_m2(b))));
        best.filter(|cover| !cover.is_empty())
    }

    /// Ground under rectangles and not in the rings, on a grid, square metres.
    fn gained_m2(&self, rectangles: &[TurnedRectangle]) -> f64 {
        let reach = |one: &TurnedRectangle| DVec2::splat(one.half_extents_m.length());
        let low = rectangles.iter().map(|one| one.center - reach(one)).fold(DVec2::INFINITY, DVec2::min);
        let high = rectangles.iter().map(|one| one.center + reach(one)).fold(DVec2::NEG_INFINITY, DVec2::max);
        let cell = (high - low) / SAMPLES as f64;
        let has = |point: DVec2| {
            let away = |one: &TurnedRectangle| pieces::Frame::turned(one.yaw_rad).local(point - one.center).abs();
            rectangles.iter().any(|one| away(one).cmple(one.half_extents_m).all())
        };
        let is_inside = |point: DVec2| {
            let winding = |rings: &[Vec<DVec2>]| rings.iter().any(|ring| contains(ring, point - self.middle));
            winding(&self.rings[..self.outer_count]) && !winding(&self.rings[self.outer_count..])
        };
        let places = (0..SAMPLES * SAMPLES)
            .map(|at| low + cell * (DVec2::new((at % SAMPLES) as f64, (at / SAMPLES) as f64) + 0.5));
        places.filter(|point| has(*point) && !is_inside(*point)).count() as f64 * cell.element_product()
    }
}

/// Rows in a direction, and rectangles along the walls that are slanted to them.
struct Way {
    yaw_rad: f64,
    rows: Rows,
    walls: Vec<TurnedRectangle>,
}

fn sum_m2(rectangles: &[TurnedRectangle]) -> f64 {
    rectangles.iter().map(|one| 4.0 * one.half_extents_m.element_product()).sum()
}
