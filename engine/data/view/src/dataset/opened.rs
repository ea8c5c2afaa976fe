//! [`Opened`]: a dataset with places of the rows of its tables.

use super::causes::Causes;
use crate::inside::inside;
use crate::subject::unknown;
use cosfly_diagnose::Result;
use cosfly_read::{PublishedDataset, PublishedFlight, RowIndex};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

/// Tables that are opened.
const TABLES: [&str; 8] = ["trajectories", "frames", "objects", "bodies", "captions", "goals", "crossings", "rejected"];

/// A published dataset, of which no file leads out.
pub struct Opened {
    /// The dataset.
    pub dataset: PublishedDataset,
    /// Words for what hides targets.
    pub causes: Causes,
    rows: Mutex<BTreeMap<&'static str, Arc<RowIndex>>>,
}

impl Opened {
    /// Opens the dataset in `folder`.
    ///
    /// # Errors
    /// Those of [`PublishedDataset::open`]; `view-outside`; damage of table `objects`.
    pub fn of(folder: &Path) -> Result<Self> {
        check_tables(folder)?;
        let dataset = PublishedDataset::open(folder)?;
        let causes = Causes::of(&dataset)?;
        Ok(Self { dataset, causes, rows: Mutex::default() })
    }

    /// The flight of a number.
    ///
    /// # Errors
    /// `view-unknown`.
    pub fn at(&self, number: usize) -> Result<&PublishedFlight> {
        let flights = self.dataset.flights();
        flights.get(number).ok_or_else(|| unknown(format!("flight {number}: there are {}, from 0", flights.len())))
    }

    /// Places of the rows of a table.
    ///
    /// # Errors
    /// Damage of the table.
    pub fn rows(&self, table: &'static str) -> Result<Arc<RowIndex>> {
        let mut known = self.rows.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(index) = known.get(table) {
            return Ok(Arc::clone(index));
        }
        let index = Arc::new(self.dataset.row_index(table)?);
        known.insert(table, Arc::clone(&index));
        Ok(index)
    }

    /// Number of a trajectory.
    pub fn number(&self, flight: &PublishedFlight) -> Option<usize> {
        self.dataset.place(&flight.trajectory_id)
    }
}

/// Refuses tables that links lead out of the dataset.
fn check_tables(folder: &Path) -> Result<()> {
    for name in ["croissant.json", "cosfly.json"].into_iter().filter(|name| folder.join(name).exists()) {
        inside(folder, name)?;
    }
    for table in TABLES {
        let entries = folder.join("data").join(table).read_dir().into_iter().flatten().flatten();
        for name in entries.filter_map(|entry| entry.file_name().into_string().ok()) {
            inside(folder, &format!("data/{table}/{name}"))?;
        }
    }
    Ok(())
}
