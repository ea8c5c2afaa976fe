//! Captions of single trajectories; those of neighbouring ones are read together and kept until others are asked for.

use super::dataset::PublishedDataset;
use super::row_index::RowIndex;
use cosfly_diagnose::Result;
use cosfly_schema::CaptionRecord;
use cosfly_schema::tables::Captions;
use std::collections::BTreeMap;

/// Reads captions trajectory by trajectory.
pub struct CaptionReader {
    index: RowIndex,
    known: BTreeMap<usize, Vec<CaptionRecord>>,
}

impl CaptionReader {
    /// A reader of table `captions`.
    ///
    /// # Errors
    /// Damage of the table.
    pub fn of(dataset: &PublishedDataset) -> Result<Self> {
        Ok(Self { index: dataset.row_index("captions")?, known: BTreeMap::new() })
    }

    /// Captions of the trajectory at a place in [`PublishedDataset::flights`] of the same dataset.
    ///
    /// # Errors
    /// Damage of the table.
    pub fn at(&mut self, dataset: &PublishedDataset, place: usize) -> Result<&[CaptionRecord]> {
        if !self.known.contains_key(&place) && self.index.has(place) {
            self.known = BTreeMap::new();
            let wanted = self.index.beside(place);
            let known = &mut self.known;
            self.index.visit(&wanted, &mut |rows, _| {
                let ids = rows.values(Captions::trajectory_id)?;
                for row in 0..rows.len() {
                    let Some(place) = dataset.place(ids.text(row)).filter(|it| wanted.contains(it)) else {
                        continue;
                    };
                    known.entry(place).or_default().push(CaptionRecord {
                        language: rows.get(Captions::language, row)?,
                        style: rows.get(Captions::style, row)?,
                        text: rows.get(Captions::text, row)?,
                        writer: rows.get_or(Captions::writer, row, "template".to_owned())?,
                        model: rows.get_or(Captions::model, row, None)?,
                        prompt_version: rows.get_or(Captions::prompt_version, row, None)?,
                        attempts: rows.get_or(Captions::attempts, row, 0)?,
                        fallback: rows.get_or(Captions::fallback, row, None)?,
                        verdicts: rows.get_or(Captions::verdicts, row, vec![])?,
                        refused: rows.get_or(Captions::refused, row, vec![])?,
                        refused_because: rows.get_or(Captions::refused_because, row, vec![])?,
                        refused_for: vec![],
                    });
                }
                Ok(())
            })?;
        }
        Ok(self.known.get(&place).map_or(&[], Vec::as_slice))
    }
}
