//! Covers a footprint with few turned rectangles that contain it.
//!
//! The footprint is cut into rows along one of its sides; rows of nearly the same reach become one strip. Walls that are slanted
//! to the rows get a rectangle of their own where that takes fewer. Where the strips are many, rectangles grow one by one
//! between the walls ([`crooked`]).

mod crooked;
mod pieces;
mod rows;
mod thinning;
mod walls;

pub(crate) use rows::{Row, Rows, Span, coarse_rows, strips};

use crate::polygons::contains;
use cosfly_frames::{DVec2, real};
use walls::Wall;

/// A rectangle's overhang beyond the outline is at most this deep, metres, wherever [`MOST`] rectangles are enough; less for
/// things of a few metres.
pub const COVER_TOLERANCE_M: f64 = 0.25;
/// The same of more crooked outlines. Only of a [`Cover::coarse`] one it is deeper.
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
/// Directions of sides that are tried, each lengthwise and across.
const DIRECTIONS: usize = 3;
/// Places along each side of a coarse cover at which its area is measured.
const SAMPLES: usize = 128;

/// A rectangle turned about its centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TurnedRectangle {
    /// Centre, metres.
    pub center: DVec2,
    /// Half its size along its own axes, metres.
    pub half_extents_m: DVec2,
    /// Turn from x towards y, radians.
    pub yaw_rad: f64,
}

/// Rectangles over a footprint.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cover {
    /// The rectangles; their union contains the footprint.
    pub rectangles: Vec<TurnedRectangle>,
    /// Where the footprint has so many corners that the rectangles stand over it by more than [`LOOSE_TOLERANCE_M`].
    pub coarse: Option<Coarse>,
}

/// What a coarse cover gains.
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
    match Plan::of(outer, holes) {
        Some(plan) => plan.cover(COVER_TOLERANCE_M, MOST),
        None => Cover::default(),
    }
}

impl Plan {
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

/// Rings near the origin, thinned out, and the directions that suit them.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Outer rings first.
    rings: Vec<Vec<DVec2>>,
    outer_count: usize,
    /// Middle of the rings in their own frame.
    middle: DVec2,
    /// Distance by which thinning out moved the rings at most, metres.
    moved_m: f64,
    /// Directions of the longest sides, longest first, each followed by the direction across.
    angles_rad: Vec<f64>,
    /// Width and depth, whichever is larger.
    extent_m: f64,
}

impl Plan {
    /// None when there is no corner or a coordinate is not finite.
    pub fn of(outer: &[&[DVec2]], holes: &[&[DVec2]]) -> Option<Self> {
        let corners = || outer.iter().chain(holes).copied().flatten().copied();
        let low = corners().fold(DVec2::INFINITY, DVec2::min);
        let high = corners().fold(DVec2::NEG_INFINITY, DVec2::max);
        let has_sides = outer.iter().any(|ring| ring.len() > 1);
        if !(has_sides && low.is_finite() && high.is_finite() && corners().all(DVec2::is_finite)) {
            return None;
        }
        let middle = 0.5 * (low + high);
        let near = |rings: &[&[DVec2]]| -> Vec<Vec<DVec2>> {
            rings.iter().map(|ring| ring.iter().map(|corner| *corner - middle).collect()).collect()
        };
        let (mut outer, mut holes) = (near(outer), near(holes));
        let moved_m = thinning::thin_out(&mut outer).max(thinning::thin_out(&mut holes));
        let outer_count = outer.len();
        let rings = [outer, holes].concat();
        let angles_rad = side_angles_rad(&rings);
        Some(Self { rings, outer_count, middle, moved_m, angles_rad, extent_m: (high - low).max_element() })
    }

    /// The same rings, to be covered in these directions only.
    #[must_use]
    pub fn along(mut self, angles_rad: &[f64]) -> Self {
        self.angles_rad = angles_rad.to_vec();
        self
    }

    /// Directions of the longest sides, longest first, each followed by the direction across; radians, x towards y.
    pub fn angles_rad(&self) -> &[f64] {
        &self.angles_rad
    }

    /// Area of the outer rings without the holes, square metres.
    pub fn area_m2(&self) -> f64 {
        let area_m2 = |ring: &Vec<DVec2>| 0.5 * crate::polygons::twice_area_m2(ring).abs();
        let (outer, holes) = self.rings.split_at(self.outer_count);
        (outer.iter().map(area_m2).sum::<f64>() - holes.iter().map(area_m2).sum::<f64>()).max(0.0)
    }

    /// The cover of rings whose sides are too many: courtyards are filled.
    fn coarse_cover(&self, most: usize) -> Vec<TurnedRectangle> {
        let yaw_rad = self.angles_rad[0];
        let outer = self.rings[..self.outer_count].iter().map(|ring| self.turned(ring, yaw_rad));
        let rows = coarse_rows(outer);
        let mut allowed_m = self.extent_m / 64.0;
        loop {
            let strips = strips(rows.clone(), allowed_m);
            let count: usize = strips.iter().map(|row| row.spans.len()).sum();
            if count <= most || allowed_m > 4.0 * self.extent_m {
                return self.rectangles(strips, yaw_rad);
            }
            allowed_m *= core::f64::consts::SQRT_2;
        }
    }

    fn turned(&self, ring: &[DVec2], yaw_rad: f64) -> Vec<DVec2> {
        let (sin, cos) = real::sin_cos(yaw_rad);
        ring.iter().map(|p| DVec2::new(cos * p.x + sin * p.y, cos * p.y - sin * p.x)).collect()
    }

    /// The rings turned so that `yaw_rad` is x.
    pub(crate) fn rows(&self, yaw_rad: f64) -> Rows {
        let rings = self.rings.iter().enumerate();
        Rows::of(rings.map(|(index, ring)| (self.turned(ring, yaw_rad), index >= self.outer_count)))
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

    /// Convex quads, corners in order, that tile the inside; a ring's sides must not cross. Thinned out like a cover;
    /// none where the sides are too many.
    pub fn trapezoids(&self) -> Vec<[DVec2; 4]> {
        let rows = self.rows(0.0);
        let quads = if rows.are_too_many() { Vec::new() } else { rows.trapezoids() };
        quads.into_iter().map(|quad| quad.map(|corner| corner + self.middle)).collect()
    }

    /// The smallest rectangle in this direction.
    pub(crate) fn bounding(&self, yaw_rad: f64) -> TurnedRectangle {
        let corners = self.rings.iter().flat_map(|ring| self.turned(ring, yaw_rad));
        let (low, high) = corners.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(a, b), p| (a.min(p), b.max(p)));
        self.rectangle(low, high, yaw_rad)
    }

    /// The rectangles of strips.
    pub(crate) fn rectangles(&self, strips: Vec<Row>, yaw_rad: f64) -> Vec<TurnedRectangle> {
        let of_strip = |strip: Row| {
            let (low_y, high_y) = (strip.low_y, strip.high_y);
            strip.spans.into_iter().map(move |span| (DVec2::new(span.low, low_y), DVec2::new(span.high, high_y)))
        };
        strips.into_iter().flat_map(of_strip).map(|(low, high)| self.rectangle(low, high, yaw_rad)).collect()
    }

    fn rectangle(&self, low: DVec2, high: DVec2, yaw_rad: f64) -> TurnedRectangle {
        let (sin, cos) = real::sin_cos(yaw_rad);
        let center = 0.5 * (low + high);
        let turned = DVec2::new(cos * center.x - sin * center.y, sin * center.x + cos * center.y);
        let half_extents_m = 0.5 * (high - low) + self.moved_m;
        TurnedRectangle { center: self.middle + turned, half_extents_m, yaw_rad }
    }
}

/// Directions in which the sides are longest together, sides within two degrees of each other (or of a right angle)
/// counted together.
fn side_angles_rad(rings: &[Vec<DVec2>]) -> Vec<f64> {
    let quarter = 0.5 * real::PI;
    let near = |a: f64, b: f64| {
        let apart = (a - b).rem_euclid(quarter);
        apart.min(quarter - apart) < 0.035
    };
    let mut sides: Vec<DVec2> = rings
        .iter()
        .flat_map(|ring| (0..ring.len()).map(|i| ring[(i + 1) % ring.len()] - ring[i]))
        .filter(|side| side.length() > 1e-6)
        .collect();
    sides.sort_by(|a, b| b.length_squared().total_cmp(&a.length_squared()));
    let mut groups: Vec<(f64, f64)> = Vec::new();
    for side in &sides {
        let angle = real::atan2(side.y, side.x);
        match groups.iter().position(|(other, _)| near(*other, angle)) {
            Some(group) => groups[group].1 += side.length(),
            None if groups.len() < 32 => groups.push((angle, side.length())),
            None => {}
        }
    }
    if groups.is_empty() {
        groups.push((0.0, 0.0));
    }
    groups.sort_by(|a, b| b.1.total_cmp(&a.1));
    groups.iter().take(DIRECTIONS).flat_map(|(angle, _)| [*angle, *angle + quarter]).collect()
}
