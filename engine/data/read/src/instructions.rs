//! Instructions of the windows of single trajectories; those of neighbouring ones are read together and kept until others
//! are asked for.

use super::dataset::PublishedDataset;
use super::row_index::RowIndex;
use cosfly_diagnose::Result;
use cosfly_schema::tables::{Column, DatasetItem, Windows};
use std::collections::BTreeMap;

/// Instructions of the windows of one trajectory, by first frame.
pub type InstructionsByFrame = BTreeMap<usize, String>;

/// Reads instructions of windows trajectory by trajectory.
pub struct InstructionReader {
    index: RowIndex,
    language: Column<DatasetItem, String>,
    history: usize,
    known: BTreeMap<usize, InstructionsByFrame>,
}

impl InstructionReader {
    /// A reader of the windows with an input of `history` frames; `language` is the column of their instructions.
    ///
    /// # Errors
    /// Damage of table `windows`.
    pub fn of(dataset: &PublishedDataset, language: Column<DatasetItem, String>, history: usize) -> Result<Self> {
        Ok(Self { index: dataset.row_index("windows")?, language, history, known: BTreeMap::new() })
    }

    /// Instructions of the windows of the trajectory at a place in [`PublishedDataset::flights`] of the same dataset; none
    /// where the dataset was written by a cosfly without them.
    ///
    /// # Errors
    /// Damage of table `windows`.
    pub fn at(&mut self, dataset: &PublishedDataset, place: usize) -> Result<&InstructionsByFrame> {
        static NONE: InstructionsByFrame = BTreeMap::new();
        if !self.known.contains_key(&place) && self.index.has(place) {
            self.known = BTreeMap::new();
            let wanted = self.index.beside(place);
            let (known, language, history) = (&mut self.known, self.language, self.history);
            self.index.visit(&wanted, &mut |rows, _| {
                let ids = rows.values(Windows::trajectory_id)?;
                for row in 0..rows.len() {
                    let Some(place) = dataset.place(ids.text(row)).filter(|it| wanted.contains(it)) else {
                        continue;
                    };
                    let of_flight = known.entry(place).or_default();
                    let text = rows.get_or(language, row, String::new())?;
                    if !text.is_empty() && rows.get(Windows::input_boxes_px, row)?.len() == 4 * history {
                        of_flight.insert(rows.get(Windows::start_frame, row)? as usize, text);
                    }
                }
                Ok(())
            })?;
        }
        Ok(self.known.get(&place).unwrap_or(&NONE))
    }
}
