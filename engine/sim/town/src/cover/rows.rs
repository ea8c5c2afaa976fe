//! Polygons as rows of spans, and rows of nearly the same reach as strips.

use crate::polygons::twice_area_m2;
use core::cmp::Ordering;
use cosfly_frames::{DVec2, real};
use std::collections::BTreeMap;

/// Most rows between two neighbouring corners.
const MOST_PIECES: f64 = 256.0;
/// Most crossings of sides with rows that are worked on exactly, and with rows that are cut for slanted sides.
const MOST_CROSSINGS: usize = 60_000;
/// Most pairs of sides that are looked at for crossings.
const MOST_PAIRS: usize = 4_000_000;
/// Rows of rings whose sides are too many.
const COARSE_ROWS: f64 = 64.0;
/// Share of the tolerance that joining rows may use up, so that an overhang along and one across stay within it.
const JOINING_SHARE: f64 = 0.5;

/// A stretch of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Span {
    /// Least x of the polygon in the row.
    pub(crate) low: f64,
    /// Greatest x.
    pub(crate) high: f64,
    /// From here the polygon fills the whole height of the row.
    inner_low: f64,
    /// Up to here.
    inner_high: f64,
}

/// Spans between two levels, sorted, apart from each other.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    pub(crate) low_y: f64,
    pub(crate) high_y: f64,
    pub(crate) spans: Vec<Span>,
    /// Height at the row's upper end that reaches less far than the spans say.
    narrower_m: f64,
}

/// A side of a ring, lower end first. Over the rings' inside, upward sides open it and downward sides close it, or the
/// other way round: along a line the windings of the sides passed add up to a number other than 0 inside.
#[derive(Clone, Copy, Debug)]
struct Side {
    a: DVec2,
    b: DVec2,
    winding: i32,
    /// Depth of the rectangle that covers the inside along the side, metres; 0 without one.
    wall_m: f64,
}

/// Sides of rings, lowest first, and the levels of their corners.
pub(crate) struct Rows {
    sides: Vec<Side>,
    levels: Vec<f64>,
    /// Crossings of the sides with the rows between all levels.
    crossing_count: usize,
}

/// A side between two levels: its x at both, its winding, and the depth of the rectangle along it.
#[derive(Clone, Copy)]
struct Crossing {
    x: [f64; 2],
    winding: i32,
    wall_m: f64,
}

impl Crossing {
    fn low(&self) -> f64 {
        self.x[0].min(self.x[1])
    }

    fn high(&self) -> f64 {
        self.x[0].max(self.x[1])
    }

    /// Depth by which a row of a height stands over the side, metres: a row beside a side that leans by slant/height adds
    /// at most height * slant / hypot.
    fn over_m(&self, height_m: f64) -> f64 {
        let slant_m = self.high() - self.low();
        height_m * slant_m / real::hypot(height_m, slant_m).max(1e-12)
    }
}

impl Span {
    pub(crate) fn new(low: f64, high: f64) -> Self {
        Self { low, high, inner_low: low, inner_high: high }
    }
}

impl Row {
    pub(crate) fn new(low_y: f64, high_y: f64, spans: Vec<Span>) -> Self {
        Self { low_y, high_y, spans, narrower_m: 0.0 }
    }

    fn height_m(&self) -> f64 {
        self.high_y - self.low_y
    }
}

impl Rows {
    /// Rows of rings; the flag marks holes. Sides that two neighbours share cancel out.
    pub(crate) fn of(rings: impl Iterator<Item = (Vec<DVec2>, bool)>) -> Self {
        Self::behind_walls(rings.map(|(ring, is_hole)| (ring, Vec::new(), is_hole)))
    }

    /// Rows of rings some of whose sides, by the number of their first corner, have rectangles of a depth along them.
    pub(crate) fn behind_walls(rings: impl Iterator<Item = (Vec<DVec2>, Vec<f64>, bool)>) -> Self {
        let mut sides = Vec::new();
        for (ring, walls_m, is_hole) in rings {
            let forwards = if (twice_area_m2(&ring) < 0.0) == is_hole { 1 } else { -1 };
            for i in 0..ring.len() {
                let (a, b) = (ring[i], ring[(i + 1) % ring.len()]);
                let side = if a.y < b.y { (a, b, forwards) } else { (b, a, -forwards) };
                let wall_m = walls_m.get(i).copied().unwrap_or(0.0);
                sides.push(Side { a: side.0, b: side.1, winding: side.2, wall_m });
            }
        }
        let place = |side: &Side| [side.a.y, side.a.x, side.b.y, side.b.x];
        sides.sort_by(|p, q| {
            place(p).iter().zip(&place(q)).map(|(x, y)| x.total_cmp(y)).find(|it| it.is_ne()).unwrap_or(Ordering::Equal)
        });
        sides.dedup_by(|next, kept| {
            let is_same = next.a == kept.a && next.b == kept.b;
            kept.winding += if is_same { next.winding } else { 0 };
            is_same
        });
        sides.retain(|side| side.winding != 0);
        let mut levels: Vec<f64> = sides.iter().flat_map(|side| [side.a.y, side.b.y]).collect();
        levels.sort_by(f64::total_cmp);
        levels.dedup();
        let level = |y: f64| levels.partition_point(|level| *level < y);
        let crossing_count = sides.iter().map(|side| level(side.b.y) - level(side.a.y)).sum();
        Self { sides, levels, crossing_count }
    }

    /// Whether there are so many sides that their rows would take long.
    pub(crate) fn are_too_many(&self) -> bool {
        self.crossing_count > MOST_CROSSINGS
    }

    pub(crate) fn bounds(&self) -> (DVec2, DVec2) {
        let ends = || self.sides.iter().flat_map(|side| [side.a, side.b]);
        (ends().fold(DVec2::INFINITY, DVec2::min), ends().fold(DVec2::NEG_INFINITY, DVec2::max))
    }

    /// Rows between neighbouring corners, cut where a slanted side would stand over more than the tolerance.
    pub(crate) fn cut(&self, tolerance_m: f64) -> Vec<Row> {
        let mut rows = Vec::new();
        let mut active: Vec<Side> = Vec::new();
        let mut next = 0;
        let mut left = 4 * MOST_CROSSINGS;
        for pair in self.levels.windows(2) {
            let (low_y, height_m) = (pair[0], pair[1] - pair[0]);
            active.retain(|side| side.b.y > low_y);
            while let Some(side) = self.sides.get(next).filter(|side| side.a.y <= low_y) {
                if side.b.y > low_y {
                    active.push(*side);
                }
                next += 1;
            }
            let over = |side: Crossing| side.over_m(height_m) / side.wall_m.max(tolerance_m);
            let pieces = crossings(&active, pair[0], pair[1]).into_iter().map(over).fold(0.0, f64::max);
            let count = pieces.ceil().clamp(1.0, MOST_PIECES) as usize;
            let count = count.min((left / active.len().max(1)).max(1));
            left = left.saturating_sub(count * active.len());
            let level = |i: usize| if i == count { pair[1] } else { low_y + height_m * i as f64 / count as f64 };
            rows.extend((0..count).map(|i| Row::new(level(i), level(i + 1), spans(&active, level(i), level(i + 1)))));
        }
        rows
    }

    /// The rows with levels where sides cross, so that [`Self::trapezoids`] are exact there, too; `None` where there are
    /// too many sides to look at all pairs.
    pub(super) fn with_levels_at_crossings(mut self) -> Option<Self> {
        let mut pairs = 0;
        for (number, one) in self.sides.iter().enumerate() {
            for other in self.sides[number + 1..].iter().take_while(|other| other.a.y < one.b.y) {
                pairs += 1;
                if pairs > MOST_PAIRS {
                    return None;
                }
                let (along, other_along, between) = (one.b - one.a, other.b - other.a, other.a - one.a);
                let turn = along.perp_dot(other_along);
                let (share, other_share) = (between.perp_dot(other_along) / turn, between.perp_dot(along) / turn);
                if [share, other_share].iter().all(|share| (0.0..=1.0).contains(share)) {
                    self.levels.push(one.a.y + share * along.y);
                }
            }
        }
        self.levels.sort_by(f64::total_cmp);
        self.levels.dedup();
        Some(self)
    }

    /// The sides, each from its lower to its upper end; those that two rings share are left out.
    pub(crate) fn sides(&self) -> impl Iterator<Item = [DVec2; 2]> + '_ {
        self.sides.iter().map(|side| [side.a, side.b])
    }

    /// Spans that hold everything inside between two levels, whatever corners lie between them.
    pub(crate) fn spans_between(&self, low_y: f64, high_y: f64) -> Vec<Span> {
        let first = self.levels.partition_point(|level| *level <= low_y);
        let inner = self.levels[first..].iter().copied().take_while(|level| *level < high_y);
        let near = &self.sides[..self.sides.partition_point(|side| side.a.y < high_y)];
        let near: Vec<Side> = near.iter().filter(|side| side.b.y > low_y).copied().collect();
        let mut below = low_y;
        let mut all = Vec::new();
        for level in inner.chain([high_y]) {
            all.extend(spans(&near, below, level));
            below = level;
        }
        joined(all)
    }
}

impl Rows {
    /// Trapezoids between neighbouring corners' levels, each with its corners in order: together the inside, exactly, where no two sides cross.
    pub(crate) fn trapezoids(&self) -> Vec<[DVec2; 4]> {
        let mut out = Vec::new();
        for pair in self.levels.windows(2) {
            let near = &self.sides[..self.sides.partition_point(|side| side.a.y < pair[1])];
            let near: Vec<Side> = near.iter().filter(|side| side.b.y > pair[0]).copied().collect();
            let mut winding = 0;
            let mut left = None;
            for Crossing { x: [low, high], winding: step, .. } in crossings(&near, pair[0], pair[1]) {
                let (from_low, from_high) = *left.get_or_insert((low, high));
                winding += step;
                if winding == 0 {
                    left = None;
                    let corners = [(from_low, pair[0]), (low, pair[0]), (high, pair[1]), (from_high, pair[1])];
                    out.push(corners.map(|(x, y)| DVec2::new(x, y)));
                }
            }
        }
        out
    }
}

/// Rows of equal height over what any of the rings reaches: conservative, and quick for very many rings.
pub(crate) fn coarse_rows(rings: impl Iterator<Item = Vec<DVec2>>) -> Vec<Row> {
    let rings: Vec<Vec<DVec2>> = rings.collect();
    let corners = || rings.iter().flatten();
    let low_y = corners().map(|corner| corner.y).fold(f64::INFINITY, f64::min);
    let high_y = corners().map(|corner| corner.y).fold(f64::NEG_INFINITY, f64::max);
    let height_m = (high_y - low_y) / COARSE_ROWS;
    let level = |row: usize| low_y + height_m * row as f64;
    let mut spans: Vec<Vec<Span>> = vec![Vec::new(); COARSE_ROWS as usize];
    for ring in &rings {
        let row = |y: f64| (((y - low_y) / height_m.max(1e-12)) as usize).min(spans.len() - 1);
        let mut reach: BTreeMap<usize, Span> = BTreeMap::new();
        for i in 0..ring.len() {
            let (p, q) = (ring[i], ring[(i + 1) % ring.len()]);
            let (a, b) = if p.y <= q.y { (p, q) } else { (q, p) };
            for row in row(a.y)..=row(b.y) {
                let x_at = |y: f64| a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y).max(1e-12)).clamp(0.0, 1.0);
                let (x, y) = if b.y > a.y { (x_at(level(row)), x_at(level(row + 1))) } else { (a.x, b.x) };
                let span = reach.entry(row).or_insert(Span::new(x, x));
                *span = Span::new(span.low.min(x).min(y), span.high.max(x).max(y));
            }
        }
        reach.into_iter().for_each(|(row, span)| spans[row].push(span));
    }
    let rows = spans.into_iter().enumerate();
    rows.map(|(row, spans)| Row::new(level(row), level(row + 1), joined(spans))).collect()
}

/// x of the sides at both levels, sorted by their middles. No corner lies between the levels.
fn crossings(sides: &[Side], low_y: f64, high_y: f64) -> Vec<Crossing> {
    let middle_y = 0.5 * (low_y + high_y);
    let across = sides.iter().filter(|side| side.a.y <= middle_y && side.b.y > middle_y);
    let mut out: Vec<Crossing> = across
        .map(|Side { a, b, winding, wall_m }| {
            let x_at = |y: f64| a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)).clamp(0.0, 1.0);
            Crossing { x: [x_at(low_y), x_at(high_y)], winding: *winding, wall_m: *wall_m }
        })
        .collect();
    out.sort_by(|p, q| (p.x[0] + p.x[1]).total_cmp(&(q.x[0] + q.x[1])));
    out
}

/// Each span holds the sides from where the winding leaves 0 to where it is 0 again. A point outside all spans has all
/// sides of every span on one hand, hence the winding 0: whatever sides cross in the row, the spans hold the inside.
///
/// Where the first or last side has a rectangle along it, the span ends behind the side: what lies between is a triangle
/// beside the side, no deeper than the rectangle.
fn spans(sides: &[Side], low_y: f64, high_y: f64) -> Vec<Span> {
    let mut out = Vec::new();
    let mut winding = 0;
    let mut open: Option<Span> = None;
    let height_m = high_y - low_y;
    let is_walled = |side: &Crossing| side.wall_m > 0.0 && side.over_m(height_m) <= side.wall_m;
    for side in crossings(sides, low_y, high_y) {
        let (low, high) = (side.low(), side.high());
        let first = if is_walled(&side) { high } else { low };
        let span = open.get_or_insert(Span { low: first, high: first, inner_low: high, inner_high: high });
        winding += side.winding;
        if winding == 0 && is_walled(&side) {
            (span.high, span.inner_high) = (span.high.max(low), low);
            out.extend(open.take().filter(|span| span.low < low));
        } else {
            (span.low, span.high, span.inner_high) = (span.low.min(first), span.high.max(high), low);
            if winding == 0 {
                out.extend(open.take().filter(|span| span.low <= high));
            }
        }
    }
    joined(out)
}

/// Overlapping spans as one.
fn joined(mut spans: Vec<Span>) -> Vec<Span> {
    spans.sort_by(|a, b| a.low.total_cmp(&b.low));
    let mut out: Vec<Span> = Vec::with_capacity(spans.len());
    for span in spans {
        match out.last_mut() {
            Some(last) if span.low <= last.high => {
                if span.high > last.high {
                    (last.high, last.inner_high) = (span.high, span.inner_high);
                }
            }
            _ => out.push(span),
        }
    }
    out
}

/// Rows joined upwards as long as no strip stands over its rows by more than the tolerance.
pub(crate) fn strips(rows: Vec<Row>, tolerance_m: f64) -> Vec<Row> {
    let mut out: Vec<Row> = Vec::new();
    for row in rows.into_iter().filter(|row| !row.spans.is_empty()) {
        let below = out.last().filter(|below| below.high_y >= row.low_y - 1e-9);
        match below.and_then(|below| together(below, &row, JOINING_SHARE * tolerance_m)) {
            Some(both) => *out.last_mut().expect("there is a strip below") = both,
            None => out.push(row),
        }
    }
    out
}

/// One strip in place of two, if it stands over neither by more than the tolerance: at the ends of its spans, or as a
/// whole over one that is no higher than the tolerance.
fn together(below: &Row, above: &Row, tolerance_m: f64) -> Option<Row> {
    let all: Vec<Span> = below.spans.iter().chain(&above.spans).copied().collect();
    let mut spans = joined(all);
    let row = |spans, narrower_m| Row { low_y: below.low_y, high_y: above.high_y, spans, narrower_m };
    let height_m = above.high_y - below.low_y;
    match (reaches(&spans, below, tolerance_m), reaches(&spans, above, tolerance_m)) {
        (true, true) => {
            for (span, (a, b)) in spans.iter_mut().zip(below.spans.iter().zip(&above.spans)) {
                span.inner_low = a.inner_low.max(b.inner_low);
                span.inner_high = a.inner_high.min(b.inner_high);
            }
            Some(row(spans, 0.0))
        }
        _ if height_m <= tolerance_m => {
            let filled = spans.iter().map(|span| Span::new(span.low, span.high)).collect();
            Some(row(filled, 0.0))
        }
        (true, false) if below.narrower_m + above.height_m() <= tolerance_m => {
            let inner = with_inner(spans, &below.spans);
            Some(row(inner, below.narrower_m + above.height_m()))
        }
        (false, true) if below.height_m() <= tolerance_m => Some(row(with_inner(spans, &above.spans), 0.0)),
        _ => None,
    }
}

fn with_inner(mut spans: Vec<Span>, of: &[Span]) -> Vec<Span> {
    for (span, inner) in spans.iter_mut().zip(of) {
        (span.inner_low, span.inner_high) = (inner.inner_low, inner.inner_high);
    }
    spans
}

/// Whether each span of the row nearly fills one of `spans`, or reaches as far.
fn reaches(spans: &[Span], row: &Row, tolerance_m: f64) -> bool {
    spans.len() == row.spans.len()
        && spans.iter().zip(&row.spans).all(|(all, own)| {
            own.low >= all.low - 1e-9
                && own.high <= all.high + 1e-9
                && (own.low <= all.low + 1e-9 || own.inner_low - all.low <= tolerance_m)
                && (own.high >= all.high - 1e-9 || all.high - own.inner_high <= tolerance_m)
        })
}
