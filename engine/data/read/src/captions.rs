//! Captions of single trajectories; those of neighbouring ones are read together and kept until others are asked for.

use super::dataset::PublishedDataset;
use super::kept_rows::KeptRows;
use super::rows::Rows;
use cosfly_diagnose::Result;
use cosfly_schema::CaptionRecord;
use cosfly_schema::tables::Captions;

/// Reads captions trajectory by trajectory.
pub struct CaptionReader {
    rows: KeptRows<CaptionRecord>,
}

impl CaptionReader {
    /// A reader of table `captions`.
    ///
    /// # Errors
    /// Damage of the table.
    pub fn of(dataset: &PublishedDataset) -> Result<Self> {
        Ok(Self { rows: KeptRows::of(dataset, "captions")? })
    }

    /// Captions of the trajectory at a place in [`PublishedDataset::flights`] of the same dataset.
    ///
    /// # Errors
    /// Damage of the table.
    pub fn at(&mut self, dataset: &PublishedDataset, place: usize) -> Result<&[CaptionRecord]> {
        let read = |rows: &Rows<'_>, row: usize| {
            Ok(Some(CaptionRecord {
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
            }))
        };
        self.rows.at(dataset, place, Captions::trajectory_id, read, |_| ())
    }
}
