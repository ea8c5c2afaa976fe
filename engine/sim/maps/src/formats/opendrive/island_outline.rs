//! The outline of a set of cells, on the edges of what lies around it.

use cosfly_frames::DVec2;
use cosfly_town::polygons::twice_area_m2;
use std::collections::BTreeMap;

/// Side of the cells, metres.
pub(super) const CELL_M: f64 = 0.3;
/// Largest distance of a corner that is left out from the line through its neighbours, metres.
const TOLERANCE_M: f64 = 0.04;
/// Halvings of a cell's width that find an edge.
const HALVINGS: usize = 8;

/// Cells by column and row.
pub(super) type Cell = (i64, i64);

/// Middle of a cell.
pub(super) fn middle((column, row): Cell) -> DVec2 {
    CELL_M * (DVec2::new(column as f64, row as f64) + 0.5)
}

/// Ground beside an island.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Closed {
    pub(super) height_m: f64,
    pub(super) is_road: bool,
}

/// A crossing of the outline with the line between two neighbouring cells, the inner one first.
type Crossing = (Cell, Cell);

/// Corners of the outline, counter-clockwise (from x towards y), each with the ground outside of it; `None` for cells around a hole.
/// `closed` tells what lies at a place outside of the cells near a height.
pub(super) fn outline(
    cells: &BTreeMap<Cell, f64>,
    closed: &dyn Fn(DVec2, f64) -> Option<Closed>,
) -> Option<Vec<(DVec2, Closed)>> {
    let next = steps(cells);
    let first = *next.keys().next()?;
    let mut corners = vec![];
    let mut at = first;
    loop {
        corners.push(edge_between(at, cells[&at.0], closed)?);
        at = *next.get(&at)?;
        if at == first {
            break;
        }
        if corners.len() > next.len() {
            return None;
        }
    }
    let plan: Vec<DVec2> = corners.iter().map(|(place, _)| *place).collect();
    // A second line would be around a hole.
    (corners.len() == next.len() && twice_area_m2(&plan) > 0.0).then(|| simplified(&corners))
}

/// From each crossing to the next one, with the cells on the left. Cells that touch at a corner only are apart.
fn steps(cells: &BTreeMap<Cell, f64>) -> BTreeMap<Crossing, Crossing> {
    let mut next = BTreeMap::new();
    for cell in cells.keys() {
        for (x, y) in [(1, 0), (0, 1), (-1, 0), (0, -1)] {
            let outer = (cell.0 + x, cell.1 + y);
            if cells.contains_key(&outer) {
                continue;
            }
            // With the cell on the left, the outline goes on in the direction (x, y) turned left.
            let [inner_ahead, outer_ahead] = [(cell.0 - y, cell.1 + x), (outer.0 - y, outer.1 + x)];
            let following = match (cells.contains_key(&inner_ahead), cells.contains_key(&outer_ahead)) {
                (true, true) => (outer_ahead, outer),
                (true, false) => (inner_ahead, outer_ahead),
                (false, _) => (*cell, inner_ahead),
            };
            next.insert((*cell, outer), following);
        }
    }
    next
}

/// The place between two cells where the ground changes, and the ground outside.
fn edge_between(
    (inner, outer): Crossing,
    height_m: f64,
    closed: &dyn Fn(DVec2, f64) -> Option<Closed>,
) -> Option<(DVec2, Closed)> {
    let (mut open, mut taken) = (middle(inner), middle(outer));
    let mut ground = closed(taken, height_m)?;
    for _ in 0..HALVINGS {
        let between = 0.5 * (open + taken);
        match closed(between, height_m) {
            Some(found) => (taken, ground) = (between, found),
            None => open = between,
        }
    }
    Some((taken, ground))
}

/// Fewer corners, none of those left out far from the outline.
fn simplified(corners: &[(DVec2, Closed)]) -> Vec<(DVec2, Closed)> {
    let count = corners.len();
    let far = (0..count).max_by(|a, b| {
        let away_m = |k: usize| corners[k].0.distance_squared(corners[0].0);
        away_m(*a).total_cmp(&away_m(*b))
    });
    let mut kept = vec![false; count + 1];
    let at = |k: usize| corners[k % count].0;
    let mut stretches = vec![(0, far.unwrap_or(0)), (far.unwrap_or(0), count)];
    while let Some((from, to)) = stretches.pop() {
        (kept[from], kept[to]) = (true, true);
        let along = (at(to) - at(from)).normalize_or_zero();
        let off_m = |k: usize| along.perp_dot(at(k) - at(from)).abs();
        let worst = (from + 1..to).max_by(|a, b| off_m(*a).total_cmp(&off_m(*b)));
        // Where the ground outside changes, a corner stays.
        let change = (from + 1..to).find(|k| corners[k - 1].1.is_road != corners[*k].1.is_road);
        if let Some(k) = change.or(worst.filter(|k| off_m(*k) > TOLERANCE_M)) {
            stretches.extend([(from, k), (k, to)]);
        }
    }
    (0..count).filter(|k| kept[*k]).map(|k| corners[k]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn disc(radius_m: f64, hole_m: f64) -> (BTreeMap<Cell, f64>, impl Fn(DVec2, f64) -> Option<Closed>) {
        let is_in = move |at: DVec2| (hole_m..radius_m).contains(&at.length());
        let reach = (radius_m / CELL_M) as i64 + 2;
        let all = (-reach..reach).flat_map(|x| (-reach..reach).map(move |y| (x, y)));
        let cells = all.filter(|cell| is_in(middle(*cell))).map(|cell| (cell, 0.0)).collect();
        (cells, move |at, height_m| (!is_in(at)).then_some(Closed { height_m, is_road: true }))
    }

    #[test]
    fn the_outline_of_a_disc_is_a_circle_of_few_corners() {
        let (cells, closed) = disc(5.0, 0.0);
        let outline = outline(&cells, &closed).unwrap();
        assert!(outline.iter().all(|(at, _)| (at.length() - 5.0).abs() < 2e-3));
        assert!((10..60).contains(&outline.len()), "{}", outline.len());
        let plan: Vec<DVec2> = outline.iter().map(|(at, _)| *at).collect();
        assert!((0.5 * twice_area_m2(&plan) - 78.5).abs() < 1.5, "{}", 0.5 * twice_area_m2(&plan));
    }

    #[test]
    fn cells_around_a_hole_have_no_outline() {
        let (cells, closed) = disc(5.0, 1.0);
        assert!(outline(&cells, &closed).is_none());
    }
}
