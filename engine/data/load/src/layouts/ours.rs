//! Datasets of cosfly: tables in Parquet files, images in logs.

use crate::layout::Layout;
use crate::{FlightSource, LoadedFlight};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_domain::Channel;
use cosfly_read::columns::TableData;
use cosfly_read::{ImageLog, PublishedDataset, StoredImage};
use std::collections::VecDeque;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

pub(super) const LAYOUT: Layout = Layout {
    doc: "cosfly (`files.parquet`)",
    recognises: cosfly_episodes::is_of_cosfly,
    open: |folder| Ok(Box::new(Ours::open(folder)?)),
};

/// Logs kept open; each needs a file descriptor and about 100 kB for its index.
const OPEN_LOGS: usize = 64;

/// A dataset of cosfly.
struct Ours {
    dataset: PublishedDataset,
    flights: Vec<LoadedFlight>,
    /// Open logs by the number of their flight, the latest last.
    logs: Mutex<VecDeque<(usize, Arc<ImageLog>)>>,
}

impl Ours {
    /// Opens the dataset in `folder`.
    ///
    /// # Errors
    /// Those of [`PublishedDataset::open`].
    fn open(folder: &Path) -> Result<Self> {
        let dataset = PublishedDataset::open(folder)?;
        let flights = dataset.flights().iter().map(|flight| LoadedFlight {
            id: flight.trajectory_id.clone(),
            split: flight.split.clone(),
            frames: flight.frames,
            size: [flight.camera.width, flight.camera.height],
        });
        Ok(Self { flights: flights.collect(), dataset, logs: Mutex::default() })
    }

    /// The open log of a flight; the one unused for longest is closed when there are too many.
    fn log(&self, flight: usize) -> Result<Arc<ImageLog>> {
        let mut logs = self.logs.lock().unwrap_or_else(PoisonError::into_inner);
        let place = logs.iter().position(|(number, _)| *number == flight);
        let entry = match place.and_then(|place| logs.remove(place)) {
            Some(entry) => entry,
            None => (flight, Arc::new(self.dataset.image_log(&self.dataset.flights()[flight])?)),
        };
        let log = Arc::clone(&entry.1);
        logs.push_back(entry);
        if logs.len() > OPEN_LOGS {
            logs.pop_front();
        }
        Ok(log)
    }
}

impl FlightSource for Ours {
    fn flights(&self) -> &[LoadedFlight] {
        &self.flights
    }

    fn identity(&self) -> &str {
        self.dataset.identity().digest()
    }

    fn check(&self) -> Result<()> {
        self.dataset.identity().check()
    }

    fn channels(&self, flight: usize) -> Result<Vec<&'static str>> {
        Ok(self.log(flight)?.channels().collect())
    }

    fn image(&self, flight: usize, channel: &Channel, frame: usize) -> Result<StoredImage> {
        self.log(flight)?.image(channel, frame)
    }

    fn table(&self, name: &str, split: Option<&str>) -> Result<TableData> {
        let files = self.dataset.files(name)?;
        if files.is_empty() {
            let folder = self.dataset.folder();
            let listed = std::fs::read_dir(folder.join("data")).into_iter().flatten().flatten();
            let mut tables: Vec<String> = listed.map(|it| it.file_name().to_string_lossy().into_owned()).collect();
            tables.sort();
            let refusal =
                Diagnostic::new("dataset-none", Fault::Input, format!("`{}` has no table `{name}`", folder.display()));
            return Err(refusal.hint(format!("the tables are the folders in `data`: {}", tables.join(", "))));
        }
        let is_wanted = |of: &str| split.is_none_or(|split| split == of || !matches!(of, "train" | "val" | "test"));
        let (wanted, others): (Vec<_>, Vec<_>) = files.into_iter().partition(|(of, _)| is_wanted(of));
        match (&wanted[..], &others[..]) {
            // No flight is in that split: the columns are those of the other splits.
            ([], [(_, other), ..]) => TableData::without_rows(other),
            _ => Ok(TableData::Files(wanted.into_iter().map(|(_, path)| path).collect())),
        }
    }
}
