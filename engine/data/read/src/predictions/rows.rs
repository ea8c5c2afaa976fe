//! Predictions in memory, and rows that cannot be scored.

use super::waypoint::DIMENSIONS;
use cosfly_diagnose::{Implausible, plausible};
use serde::Serialize;

/// A valid prediction.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Prediction {
    /// Line of the file (Parquet: row), from 1.
    pub line: u64,
    /// Trajectory id.
    pub trajectory_id: String,
    /// First frame of the window.
    pub frame: u64,
    /// Increments: dx, dy, dz (m), dpitch, dyaw, droll (degrees).
    pub deltas: Vec<[f64; 6]>,
    /// Box of the target in the frame of each waypoint: left, top, right, bottom edge (pixels); empty when none was
    /// given.
    pub boxes: Vec<Option<[f64; 4]>>,
}

/// A row that cannot be scored.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RowProblem {
    /// Line of the file (Parquet: row), from 1.
    pub line: u64,
    /// Short kebab-case name of the kind of problem.
    pub kind: &'static str,
    /// Description of the problem.
    pub reason: String,
}

impl RowProblem {
    /// Creates a problem of line `line`.
    pub fn new(line: u64, kind: &'static str, reason: impl Into<String>) -> Self {
        Self { line, kind, reason: reason.into() }
    }
}

/// Rows of a file, in order, stored in blocks without allocations per row.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Predictions {
    blocks: Vec<Block>,
    /// Number of the first row of each block.
    first: Vec<usize>,
    len: usize,
    /// Invalid rows.
    pub problems: Vec<RowProblem>,
}

/// A row of [`Predictions`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PredictionRow<'a> {
    /// Line of the file (Parquet: row), from 1.
    pub line: u64,
    /// Trajectory id.
    pub trajectory_id: &'a str,
    /// First frame of the window.
    pub frame: u64,
    /// Increments: dx, dy, dz (m), dpitch, dyaw, droll (degrees).
    pub deltas: &'a [[f64; 6]],
    /// Box of the target in the frame of each waypoint: left, top, right, bottom edge (pixels); empty when none was
    /// given.
    pub boxes: &'a [Option<[f64; 4]>],
}

impl Predictions {
    /// Predictions from rows in memory.
    pub fn of(rows: &[Prediction], problems: Vec<RowProblem>) -> Self {
        let mut block = Block::default();
        rows.iter().for_each(|row| block.push(row.line, &row.trajectory_id, row.frame, &row.deltas, &row.boxes));
        let mut all = Self { problems, ..Self::default() };
        all.append(block);
        all
    }

    /// Number of valid rows.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there is no valid row.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Row number `row`, which must exist.
    pub fn row(&self, row: usize) -> PredictionRow<'_> {
        let block = self.first.partition_point(|first| *first <= row) - 1;
        self.blocks[block].row(row - self.first[block])
    }

    /// All rows.
    pub fn rows(&self) -> impl Iterator<Item = PredictionRow<'_>> {
        self.blocks.iter().flat_map(|block| (0..block.rows.len()).map(|row| block.row(row)))
    }

    pub(super) fn append(&mut self, block: Block) {
        if !block.rows.is_empty() {
            self.first.push(self.len);
            self.len += block.rows.len();
            self.blocks.push(block);
        }
    }
}

/// A block of rows.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Block {
    rows: Vec<BlockRow>,
    /// Trajectory ids; neighbouring rows of one flight share theirs.
    ids: Vec<String>,
    deltas: Vec<[f64; 6]>,
    boxes: Vec<Option<[f64; 4]>>,
}

/// Ranges of a row's parts: first, and one past the last.
#[derive(Clone, Debug, PartialEq)]
struct BlockRow {
    line: u64,
    frame: u64,
    id: u32,
    deltas: [u32; 2],
    boxes: [u32; 2],
}

impl Block {
    fn push(&mut self, line: u64, id: &str, frame: u64, deltas: &[[f64; 6]], boxes: &[Option<[f64; 4]>]) {
        if self.ids.last().is_none_or(|last| last != id) {
            self.ids.push(id.to_owned());
        }
        let starts = [self.deltas.len(), self.boxes.len()];
        self.deltas.extend_from_slice(deltas);
        self.boxes.extend_from_slice(boxes);
        self.rows.push(BlockRow {
            line,
            frame,
            id: self.ids.len() as u32 - 1,
            deltas: [starts[0] as u32, self.deltas.len() as u32],
            boxes: [starts[1] as u32, self.boxes.len() as u32],
        });
    }

    /// Counts the lines before the block's into its line numbers.
    pub(super) fn begin_after(&mut self, lines: u64) {
        self.rows.iter_mut().for_each(|row| row.line += lines);
    }

    /// Releases unused memory.
    pub(super) fn shrink(&mut self) {
        self.rows.shrink_to_fit();
        self.ids.shrink_to_fit();
        self.deltas.shrink_to_fit();
        self.boxes.shrink_to_fit();
    }

    fn row(&self, row: usize) -> PredictionRow<'_> {
        let row = &self.rows[row];
        PredictionRow {
            line: row.line,
            trajectory_id: &self.ids[row.id as usize],
            frame: row.frame,
            deltas: &self.deltas[row.deltas[0] as usize..row.deltas[1] as usize],
            boxes: &self.boxes[row.boxes[0] as usize..row.boxes[1] as usize],
        }
    }

    /// Appends a row; `Err` is kind and reason of a problem.
    pub(super) fn take(
        &mut self,
        line: u64,
        id: &str,
        frame: u64,
        deltas: &[[f64; 6]],
        boxes: &[Option<[f64; 4]>],
    ) -> Result<(), Refusal> {
        for (delta, number) in deltas.iter().zip(1..) {
            for (value, name) in delta.iter().zip(DIMENSIONS) {
                number_of(*value, || format!("`{name}` of waypoint {number}"))?;
            }
        }
        for (edges, number) in boxes.iter().zip(1..) {
            for (value, name) in edges.iter().flatten().zip(["left", "top", "right", "bottom"]) {
                number_of(*value, || format!("the {name} edge of box {number}"))?;
            }
        }
        self.push(line, id, frame, deltas, boxes);
        Ok(())
    }
}

/// A number that a measurement can have, or the refusal of what `name` says it is.
pub(super) fn number_of(value: f64, name: impl FnOnce() -> String) -> Result<f64, Refusal> {
    plausible(value).map_err(|fault| match fault {
        Implausible::TooLarge => ("implausible", format!("{} {fault}: {value:e}", name())),
        Implausible::NotANumber | Implausible::Infinite => ("not-finite", format!("{} {fault}", name())),
    })
}

/// Kind and reason of a problem.
pub(super) type Refusal = (&'static str, String);
