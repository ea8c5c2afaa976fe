//! [`middles`]: the middle lines of the open ground between blocks of houses, and where they meet.
//!
//! Open ground is thinned from the houses on, nearest cells first, as long as that joins no two blocks: what is left are lines
//! around all blocks, and into long dead ends. Courts that houses enclose have no part in it.

use super::clearance::{Clearance, OPEN_M};
use cosfly_frames::DVec2;
use std::cmp::Reverse;
use std::collections::{BinaryHeap, VecDeque};

/// Ground nearer to a house belongs to its block, metres.
pub(super) const NEAR_M: f64 = 3.9;
/// Smaller blocks, with the ground near them, are passed by and not walked around, square metres.
const SMALLEST_BLOCK_M2: f64 = 450.0;
/// Dead ends go so far from all other lines, metres; there are at most so many.
const DEAD_END_M: f64 = 55.0;
const MOST_DEAD_ENDS: usize = 200;

/// A middle line between two points.
pub(super) struct Middle {
    /// Numbers of the points at its ends.
    pub ends: [usize; 2],
    /// Its cells' middles in order, with those of both points.
    pub line: Vec<DVec2>,
}

/// Points where lines meet or end, and the lines between them.
pub(super) fn middles(ground: &Clearance) -> (Vec<DVec2>, Vec<Middle>) {
    let open = open_ground(ground);
    let mut is_open = open.clone();
    thin(ground, &mut is_open, &[]);
    let ends = dead_ends(ground, &open, &is_open);
    is_open = open;
    thin(ground, &mut is_open, &ends);
    for cell in (0..is_open.len()).filter(|cell| ground.is_edge(*cell)) {
        is_open[cell] = false;
    }
    traced(ground, &is_open)
}

/// The open ground that reaches the edge, with small blocks on it.
fn open_ground(ground: &Clearance) -> Vec<bool> {
    let mut is_open: Vec<bool> = (0..ground.squared.len()).map(|cell| ground.of_cell_m(cell) >= NEAR_M).collect();
    let smallest = (SMALLEST_BLOCK_M2 / (ground.cell_m * ground.cell_m)) as usize;
    let mut is_seen = is_open.clone();
    for first in 0..is_seen.len() {
        let block = piece(ground, first, &mut is_seen, false);
        if block.len() < smallest {
            block.into_iter().for_each(|cell| is_open[cell] = true);
        }
    }
    let mut is_left = is_open.clone();
    for first in (0..is_left.len()).filter(|cell| ground.is_edge(*cell)) {
        piece(ground, first, &mut is_left, true);
    }
    is_open.iter().zip(is_left).map(|(open, left)| *open && !left).collect()
}

/// The cells with a mark that are joined to one over their sides; their marks are turned over.
fn piece(ground: &Clearance, first: usize, marks: &mut [bool], mark: bool) -> Vec<usize> {
    if marks[first] != mark {
        return Vec::new();
    }
    marks[first] = !mark;
    let (mut cells, mut done) = (vec![first], 0);
    while done < cells.len() {
        let cell = cells[done];
        for next in cosfly_town::terrain::beside(cell, ground.columns, ground.rows) {
            if marks[next] == mark {
                marks[next] = !mark;
                cells.push(next);
            }
        }
        done += 1;
    }
    cells
}

/// The open cells that are far from all lines and from each other's ways there.
fn dead_ends(ground: &Clearance, is_open: &[bool], is_line: &[bool]) -> Vec<usize> {
    let may_end: Vec<usize> = (0..is_open.len()).filter(|cell| ground.of_cell_m(*cell) <= OPEN_M).collect();
    let mut ways = Ways { rank: vec![u64::MAX; is_open.len()], before: vec![usize::MAX; is_open.len()] };
    ways.spread(ground, is_open, (0..is_line.len()).filter(|cell| is_line[*cell]).collect());
    let mut ends = Vec::new();
    while ends.len() < MOST_DEAD_ENDS {
        let reached = may_end.iter().copied().filter(|cell| ways.rank[*cell] != u64::MAX);
        let Some(end) = reached.reduce(|a, b| ways.later(ground, a, b)) else { break };
        let mut way: Vec<usize> =
            std::iter::successors(Some(end), |at| Some(ways.before[*at]).filter(|to| to != at)).collect();
        if (way.len() as f64) * ground.cell_m < DEAD_END_M {
            break;
        }
        way.sort_unstable();
        ways.spread(ground, is_open, way);
        ends.push(end);
    }
    ends
}

/// Shortest ways over open cells from the nearest line; of equal ones, the way from the cell of the smallest number.
struct Ways {
    /// Steps from the line, then the number of the line's cell; the largest where no way leads.
    rank: Vec<u64>,
    before: Vec<usize>,
}

impl Ways {
    /// Makes a line of further cells, in ascending order.
    fn spread(&mut self, ground: &Clearance, is_open: &[bool], line: Vec<usize>) {
        let mut queue: VecDeque<usize> = line.into_iter().filter(|cell| (*cell as u64) < self.rank[*cell]).collect();
        queue.iter().for_each(|cell| (self.rank[*cell], self.before[*cell]) = (*cell as u64, *cell));
        while let Some(cell) = queue.pop_front() {
            let rank = self.rank[cell] + (1 << 32);
            for next in cosfly_town::terrain::beside(cell, ground.columns, ground.rows) {
                if is_open[next] && rank < self.rank[next] {
                    (self.rank[next], self.before[next]) = (rank, cell);
                    queue.push_back(next);
                }
            }
        }
    }

    /// The one of two cells that a search in the breadth from all lines comes to later.
    fn later(&self, ground: &Clearance, a: usize, b: usize) -> usize {
        if a == b || self.rank[a] != self.rank[b] {
            return if self.rank[b] < self.rank[a] { a } else { b };
        }
        let (mut of_a, mut of_b) = (a, b);
        while self.before[of_a] != self.before[of_b] {
            (of_a, of_b) = (self.before[of_a], self.before[of_b]);
        }
        let mut beside = cosfly_town::terrain::beside(self.before[of_a], ground.columns, ground.rows);
        if beside.find(|next| *next == of_a || *next == of_b) == Some(of_a) { b } else { a }
    }
}

/// Takes cells away, nearest to houses first, while that parts and joins nothing. Cells at the edge and some others stay.
fn thin(ground: &Clearance, is_open: &mut [bool], kept: &[usize]) {
    let mut stays: Vec<bool> = (0..is_open.len()).map(|cell| ground.is_edge(cell)).collect();
    kept.iter().for_each(|cell| stays[*cell] = true);
    let inner = |cell: &usize| !stays[*cell];
    let entry = |cell: usize| Reverse((ground.squared[cell], cell));
    let mut queue: BinaryHeap<_> = (0..is_open.len()).filter(|cell| is_open[*cell]).filter(inner).map(entry).collect();
    let mut is_queued = is_open.to_vec();
    while let Some(Reverse((_, cell))) = queue.pop() {
        is_queued[cell] = false;
        let around = ground.around(cell);
        if !is_open[cell] || !is_needless(around.map(|cell| is_open[cell])) {
            continue;
        }
        is_open[cell] = false;
        for next in around.into_iter().filter(inner) {
            if is_open[next] && !is_queued[next] {
                is_queued[next] = true;
                queue.push(entry(next));
            }
        }
    }
}

/// Whether open cells around a cell hang together without it, and closed ones are not joined by taking it (Yokoi's number is 1).
fn is_needless(open: [bool; 8]) -> bool {
    let side = |at: usize| !open[at] && (open[at + 1] || open[(at + 2) % 8]);
    [0, 2, 4, 6].into_iter().filter(|at| side(*at)).count() == 1
}

/// Points and lines of thin cells.
fn traced(ground: &Clearance, is_open: &[bool]) -> (Vec<DVec2>, Vec<Middle>) {
    let next_to = |cell: usize| ground.around(cell).into_iter().filter(|next| is_open[*next]).collect::<Vec<_>>();
    let cells: Vec<usize> = (0..is_open.len()).filter(|cell| is_open[*cell]).collect();
    let mut point_of = vec![usize::MAX; is_open.len()];
    let (mut points, mut groups) = (Vec::new(), Vec::new());
    for first in cells {
        if point_of[first] != usize::MAX || next_to(first).len() == 2 {
            continue;
        }
        point_of[first] = points.len();
        let (mut group, mut done) = (vec![first], 0);
        while done < group.len() {
            for next in next_to(group[done]) {
                if point_of[next] == usize::MAX && next_to(next).len() > 2 {
                    point_of[next] = points.len();
                    group.push(next);
                }
            }
            done += 1;
        }
        points.push(group.iter().map(|cell| ground.middle(*cell)).sum::<DVec2>() / group.len() as f64);
        groups.push(group);
    }
    let mut is_seen = vec![false; is_open.len()];
    let mut lines = Vec::new();
    for (point, group) in groups.iter().enumerate() {
        for (start, first) in group.iter().flat_map(|cell| next_to(*cell).into_iter().map(move |next| (*cell, next))) {
            if is_seen[first] || point_of[first] != usize::MAX {
                continue;
            }
            let (mut line, mut before, mut at) = (vec![points[point]], start, first);
            while point_of[at] == usize::MAX {
                is_seen[at] = true;
                line.push(ground.middle(at));
                let onward = next_to(at).into_iter().find(|next| *next != before);
                (before, at) = (at, onward.unwrap_or(start));
            }
            line.push(points[point_of[at]]);
            lines.push(Middle { ends: [point, point_of[at]], line });
        }
    }
    (points, lines)
}
