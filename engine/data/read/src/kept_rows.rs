//! Rows of a table by trajectory: those of neighbouring trajectories are read together and kept until others are asked for.

use super::dataset::PublishedDataset;
use super::row_index::RowIndex;
use super::rows::Rows;
use cosfly_diagnose::Result;
use cosfly_schema::tables::Column;
use std::collections::BTreeMap;

/// Rows `T` of a table, by places of trajectories in [`PublishedDataset::flights`].
pub(super) struct KeptRows<T> {
    index: RowIndex,
    known: BTreeMap<usize, Vec<T>>,
}

impl<T> KeptRows<T> {
    /// Rows of a table.
    ///
    /// # Errors
    /// Damage of the table.
    pub fn of(dataset: &PublishedDataset, table: &str) -> Result<Self> {
        Ok(Self { index: dataset.row_index(table)?, known: BTreeMap::new() })
    }

    /// Rows of the trajectory at a place, by the key that `order` gives; `read` gives those rows that count.
    ///
    /// # Errors
    /// Damage of the table.
    pub fn at<S, K: Ord>(
        &mut self,
        dataset: &PublishedDataset,
        place: usize,
        id: Column<S, String>,
        read: impl Fn(&Rows<'_>, usize) -> Result<Option<T>>,
        order: impl Fn(&T) -> K,
    ) -> Result<&[T]> {
        if !self.known.contains_key(&place) && self.index.has(place) {
            self.known = BTreeMap::new();
            let wanted = self.index.beside(place);
            let known = &mut self.known;
            self.index.visit(&wanted, &mut |rows, _| {
                let ids = rows.values(id)?;
                for row in 0..rows.len() {
                    if let Some(place) = dataset.place(ids.text(row)).filter(|it| wanted.contains(it)) {
                        known.entry(place).or_default().extend(read(rows, row)?);
                    }
                }
                Ok(())
            })?;
            known.values_mut().for_each(|rows| rows.sort_by_key(&order));
        }
        Ok(self.known.get(&place).map_or(&[], Vec::as_slice))
    }
}
