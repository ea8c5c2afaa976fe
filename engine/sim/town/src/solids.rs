//! Solid boxes of things that a map gives by their outline and heights.

use crate::cover::{
    COVER_TOLERANCE_M, Coarse, Cover, CoverPlan, LOOSE_TOLERANCE_M, MOST, Row, Rows, Span, TurnedRectangle,
    cover_rings, strips,
};
use crate::polygons::{contains, twice_area_m2};
use crate::regions::PlanRegion;
use cosfly_domain::OrientedBox;
use cosfly_frames::DVec2;

/// Highest step of a roof that is made of boxes, metres; higher only where the roof has more than [`MOST_STEPS`].
pub const ROOF_STEP_M: f64 = 0.75;
/// Most steps of a roof: 72 m.
const MOST_STEPS: f64 = 96.0;
/// Rows of a roof's plan that are looked at are so many, or so high, metres; the bound goes before.
const ROOF_ROWS: f64 = 40.0;
const ROOF_ROWS_M: [f64; 2] = [0.2, 0.25];
/// Most sides times rows of a roof; a roof of more is filled.
const MOST_ROOF_WORK: f64 = 400_000.0;
/// A footprint that fills less of its bounding rectangle has wings: its roof rises from every wall.
const WITHOUT_WINGS: f64 = 0.8;

/// Ground that a building covers, plan view in the world frame, metres. Rings either way round, first corner not repeated.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Footprint {
    /// Outer ring.
    pub outer: Vec<DVec2>,
    /// Courtyards.
    pub holes: Vec<Vec<DVec2>>,
}

/// Shape of a roof above the eaves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Roof {
    /// Level.
    #[default]
    Flat,
    /// Two planes that meet in a ridge along `ridge_yaw_rad` (x towards y); none means along the longer side. A
    /// footprint with wings gets planes from every wall instead.
    Gabled {
        /// Ridge above the eaves, metres.
        rise_m: f64,
        /// Direction of the ridge, radians.
        ridge_yaw_rad: Option<f64>,
    },
    /// Planes that rise from every wall.
    Hipped {
        /// Highest point above the eaves, metres.
        rise_m: f64,
    },
}

impl Footprint {
    /// Width of the strip of the same area and perimeter, metres: the shorter side of a rectangle, the width of wings.
    pub fn wing_width_m(&self) -> f64 {
        let yards = self.yards();
        let half = |ring: &[DVec2]| -> f64 {
            (0..ring.len()).map(|i| 0.5 * ring[i].distance(ring[(i + 1) % ring.len()])).sum()
        };
        let area = |ring: &[DVec2]| 0.5 * twice_area_m2(ring).abs();
        let around_m: f64 = half(&self.outer) + yards.iter().map(|yard| half(yard)).sum::<f64>();
        let area_m2 = area(&self.outer) - yards.iter().map(|yard| area(yard)).sum::<f64>();
        // Length and width add up to half the perimeter.
        0.5 * (around_m - (around_m * around_m - 4.0 * area_m2).max(0.0).sqrt())
    }

    /// The courtyards that begin inside the outer ring.
    fn yards(&self) -> Vec<&[DVec2]> {
        let is_inside = |hole: &&Vec<DVec2>| hole.first().is_some_and(|corner| contains(&self.outer, *corner));
        self.holes.iter().filter(is_inside).map(Vec::as_slice).collect()
    }
}

/// Boxes of a thing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SolidBoxes {
    /// The boxes.
    pub boxes: Vec<OrientedBox>,
    /// Where they stand over the outline by more than covers do.
    pub coarse: Option<Coarse>,
    /// Whether steps of its roof are higher than they should be, or reach out to the walls.
    pub is_roof_coarse: bool,
}

/// Things whose boxes are coarser than they should be, counted for the user.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CoarseThings {
    covers: usize,
    gained_m2: f64,
    roofs: usize,
}

impl CoarseThings {
    /// Counts a thing, if it is coarse.
    pub fn add(&mut self, thing: &SolidBoxes) {
        self.add_cover(thing.coarse);
        self.roofs += usize::from(thing.is_roof_coarse);
    }

    /// Counts a cover, if it is coarse.
    pub fn add_cover(&mut self, coarse: Option<Coarse>) {
        if let Some(Coarse { gained_m2 }) = coarse {
            self.covers += 1;
            self.gained_m2 += gained_m2;
        }
    }

    /// Warnings about covers that are coarse.
    pub fn warnings(&self) -> Vec<String> {
        let mut lines = Vec::new();
        if self.covers > 0 {
            lines.push(format!(
                "{} outlines of too many corners are covered coarsely: their boxes stand over them by more than \
                 {LOOSE_TOLERANCE_M} m and gain about {:.0} square metres of ground",
                self.covers, self.gained_m2
            ));
        }
        if self.roofs > 0 {
            lines.push(format!(
                "the roofs of {} things are too crooked or too high for fine steps: some of their steps are higher or reach \
                 out to the walls",
                self.roofs
            ));
        }
        lines
    }
}

/// Boxes whose union covers a building from `base_m` to its roof, heights in the world frame, metres; none when a
/// number is not finite. Overhang in plan as in [`crate::cover`]; a roof's boxes contain it and stand over it by less than one step.
pub fn building_boxes(footprint: &Footprint, base_m: f64, eaves_m: f64, roof: Roof) -> SolidBoxes {
    let rise_m = match roof {
        Roof::Flat => 0.0,
        Roof::Gabled { rise_m, .. } | Roof::Hipped { rise_m } => rise_m.max(0.0),
    };
    if !(base_m.is_finite() && eaves_m.is_finite() && rise_m.is_finite()) {
        return SolidBoxes::default();
    }
    let Some(plan) = CoverPlan::of(&[&footprint.outer], &footprint.yards()) else { return SolidBoxes::default() };
    let step_count = (rise_m / ROOF_STEP_M).ceil().clamp(1.0, MOST_STEPS);
    let level_m = |step: f64| eaves_m.max(base_m) + rise_m * step / step_count;
    let foot = plan.cover(COVER_TOLERANCE_M, MOST);
    let mut boxes: Vec<OrientedBox> = foot.rectangles.iter().map(|one| upright(*one, base_m, level_m(1.0))).collect();
    let plan = if step_count > 1.0 { RoofPlan::of(plan, roof) } else { None };
    let is_absurd = plan.as_ref().is_some_and(|plan| !plan.takes_little_work());
    let Some(plan) = plan.filter(|_| !is_absurd) else {
        // Too low or too thin for steps, or far too large.
        boxes.iter_mut().for_each(|one| *one = reaching(*one, level_m(step_count)));
        return SolidBoxes { boxes, coarse: foot.coarse, is_roof_coarse: is_absurd };
    };
    let mut is_roof_coarse = rise_m > MOST_STEPS * ROOF_STEP_M;
    let mut step = 1.0;
    while step < step_count {
        let section = plan.section(step / step_count);
        is_roof_coarse |= section.is_none();
        let section = section.unwrap_or_else(|| foot.rectangles.clone());
        boxes.extend(section.into_iter().map(|one| upright(one, level_m(step), level_m(step + 1.0))));
        step += 1.0;
    }
    SolidBoxes { boxes, coarse: foot.coarse, is_roof_coarse }
}

/// Boxes whose union covers a region between two heights, world, metres; overhang in plan as in [`crate::cover`].
pub fn layer_boxes(region: &PlanRegion, base_m: f64, top_m: f64) -> SolidBoxes {
    let (outer, holes) = region.rings();
    let Cover { rectangles, coarse } = cover_rings(&outer, &holes);
    let boxes = rectangles.into_iter().map(|one| upright(one, base_m, top_m)).collect();
    SolidBoxes { boxes, coarse, is_roof_coarse: false }
}

fn upright(rectangle: TurnedRectangle, low_m: f64, high_m: f64) -> OrientedBox {
    OrientedBox {
        center_in_world: rectangle.center.extend(0.5 * (low_m + high_m)),
        half_extents_m: rectangle.half_extents_m.extend(0.5 * (high_m - low_m)),
        yaw_rad: rectangle.yaw_rad,
    }
}

fn reaching(shape: OrientedBox, top_m: f64) -> OrientedBox {
    let low_m = shape.center_in_world.z - shape.half_extents_m.z;
    OrientedBox {
        center_in_world: shape.center_in_world.with_z(0.5 * (low_m + top_m)),
        half_extents_m: shape.half_extents_m.with_z(0.5 * (top_m - low_m)),
        ..shape
    }
}

/// A roof's plan, ready to be cut at heights.
struct RoofPlan {
    plan: CoverPlan,
    yaw_rad: f64,
    rows: Rows,
    low: DVec2,
    high: DVec2,
    /// Distance of the highest point from the walls; none for a roof of two planes.
    depth_m: Option<f64>,
}

impl RoofPlan {
    fn of(plan: CoverPlan, roof: Roof) -> Option<Self> {
        let size = |yaw_rad: f64| 2.0 * plan.bounding(yaw_rad).half_extents_m;
        let longer = |angles: &[f64]| {
            let widest = angles.iter().copied().take(2).max_by(|a, b| size(*a).x.total_cmp(&size(*b).x));
            widest.unwrap_or(0.0)
        };
        let yaw_rad = match roof {
            Roof::Gabled { ridge_yaw_rad: Some(yaw_rad), .. } if yaw_rad.is_finite() => yaw_rad,
            _ => longer(plan.angles_rad()),
        };
        let has_wings = plan.area_m2() < WITHOUT_WINGS * size(yaw_rad).element_product();
        let rows = plan.rows(yaw_rad);
        let (low, high) = rows.bounds();
        let mut roof_plan = Self { plan, yaw_rad, rows, low, high, depth_m: None };
        if has_wings || matches!(roof, Roof::Hipped { .. }) {
            roof_plan.depth_m = Some(roof_plan.deepest_m());
        }
        ((high - low).min_element() > 0.1).then_some(roof_plan)
    }

    fn row_m(&self) -> f64 {
        let [least_m, most_m] = ROOF_ROWS_M;
        ((self.high.y - self.low.y) / ROOF_ROWS).clamp(least_m, most_m)
    }

    fn takes_little_work(&self) -> bool {
        let rows = (self.high.y - self.low.y) / self.row_m();
        rows * self.rows.sides().count() as f64 <= MOST_ROOF_WORK
    }

    /// Rectangles over all of the roof that is higher than a share of its rise; `None` where very many would be needed.
    fn section(&self, share: f64) -> Option<Vec<TurnedRectangle>> {
        let rows = match self.depth_m {
            Some(depth_m) => self.eroded(share * depth_m),
            None => {
                let inset_m = 0.5 * share * (self.high.y - self.low.y);
                self.sampled(self.low.y + inset_m, self.high.y - inset_m, |low, high| {
                    self.rows.spans_between(low, high)
                })
            }
        };
        let joined = strips(rows, LOOSE_TOLERANCE_M);
        let count: usize = joined.iter().map(|row| row.spans.len()).sum();
        (count <= MOST).then(|| self.plan.rectangles(joined, self.yaw_rad))
    }

    /// Rows that stand over slanted walls by no more than half of what strips may.
    fn sampled(&self, from: f64, to: f64, spans: impl Fn(f64, f64) -> Vec<Span>) -> Vec<Row> {
        let count = ((to - from) / self.row_m()).ceil().max(1.0);
        let level = |i: f64| from + (to - from) * i / count;
        (0..count as usize)
            .map(|i| (level(i as f64), level(i as f64 + 1.0)))
            .map(|(low, high)| Row::new(low, high, spans(low, high)))
            .collect()
    }

    /// Rows that hold every point at least `inset_m` from all walls: the disc around such a point lies in the footprint,
    /// so it does at the disc's middle, its ends and half-way.
    fn eroded(&self, inset_m: f64) -> Vec<Row> {
        self.sampled(self.low.y + inset_m, self.high.y - inset_m, |low, high| {
            let around = [(0.0, 1.0), (-1.0, 0.0), (1.0, 0.0), (-0.5, 0.75_f64.sqrt()), (0.5, 0.75_f64.sqrt())];
            let mut kept = vec![Span::new(f64::NEG_INFINITY, f64::INFINITY)];
            for (up, aside) in around {
                let spans = self.rows.spans_between(low + up * inset_m, high + up * inset_m);
                let shrunk =
                    spans.iter().map(|span| Span::new(span.low + aside * inset_m, span.high - aside * inset_m));
                kept = overlaps(&kept, &shrunk.filter(|span| span.low < span.high).collect::<Vec<_>>());
            }
            kept
        })
    }

    /// Largest inset that leaves anything.
    fn deepest_m(&self) -> f64 {
        let (mut low, mut high) = (0.0, 0.5 * (self.high - self.low).min_element());
        for _ in 0..6 {
            let middle = 0.5 * (low + high);
            if self.eroded(middle).iter().any(|row| !row.spans.is_empty()) { low = middle } else { high = middle }
        }
        high
    }
}

/// Spans that two sorted lists share.
fn overlaps(some: &[Span], others: &[Span]) -> Vec<Span> {
    let mut out = Vec::new();
    let (mut i, mut j) = (0, 0);
    while let (Some(a), Some(b)) = (some.get(i), others.get(j)) {
        let (low, high) = (a.low.max(b.low), a.high.min(b.high));
        if low < high {
            out.push(Span::new(low, high));
        }
        if a.high < b.high { i += 1 } else { j += 1 }
    }
    out
}
