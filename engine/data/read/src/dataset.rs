//! A published dataset: its trajectories, tables and logs.

use super::identity::Identity;
use super::image_log::ImageLog;
use super::inner_path::inner_path;
use super::log::LogReader;
use super::rows::{Rows, read};
use super::trajectory::{PublishedFlight, Shared};
use cosfly_diagnose::{Diagnostic, Fault, Result, absent, nearest_name};
use cosfly_schema::Split;
use cosfly_schema::tables::Rejected;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Most ids listed in an error.
const LISTED: usize = 8;

/// A published dataset whose table of trajectories has been read.
#[derive(Clone, Debug)]
pub struct PublishedDataset {
    folder: PathBuf,
    /// Shared by the copies of this.
    flights: Arc<Vec<PublishedFlight>>,
    /// Places of the flights in the order of their ids.
    by_id: Arc<Vec<u32>>,
    /// The dataset that was opened.
    identity: Arc<Identity>,
}

impl PublishedDataset {
    /// Opens the dataset in `folder`; its trajectories are in the order of its splits and tables. Tables and logs that are
    /// listed or opened later are of the same dataset, or refused (`dataset-changed`).
    ///
    /// # Errors
    /// `dataset-none` where there is no dataset, otherwise damage of its files.
    pub fn open(folder: &Path) -> Result<Self> {
        let identity = Arc::new(Identity::of(folder));
        let mut dataset = Self { folder: folder.to_owned(), flights: Arc::default(), by_id: Arc::default(), identity };
        let (mut flights, mut shared): (Vec<PublishedFlight>, _) = (vec![], Shared::default());
        for (split, path) in dataset.files("trajectories")? {
            read(&path, &mut |rows| {
                for row in 0..rows.len() {
                    let mut flight = PublishedFlight::read(rows, row, &split)?;
                    shared.share(&mut flight);
                    flights.push(flight);
                }
                Ok(())
            })?;
        }
        if flights.is_empty() {
            return Err(no_dataset(folder, &dataset.rejections().unwrap_or_default()));
        }
        let mut by_id: Vec<u32> = (0..flights.len() as u32).collect();
        by_id.sort_by(|a, b| flights[*a as usize].trajectory_id.cmp(&flights[*b as usize].trajectory_id));
        flights.shrink_to_fit();
        (dataset.flights, dataset.by_id) = (Arc::new(flights), Arc::new(by_id));
        dataset.identity.check()?;
        Ok(dataset)
    }

    /// Which dataset was opened.
    pub fn identity(&self) -> &Identity {
        &self.identity
    }

    /// Folder of the dataset.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Name that the dataset has itself, in `croissant.json`, whatever its folder is called; `dataset` where it has none.
    pub fn name(&self) -> String {
        let file = std::fs::read(self.folder.join("croissant.json")).unwrap_or_default();
        let description: serde_json::Value = serde_json::from_slice(&file).unwrap_or_default();
        let name = description["name"].as_str().unwrap_or_default();
        if name.trim().is_empty() { "dataset".to_owned() } else { name.to_owned() }
    }

    /// All trajectories.
    pub fn flights(&self) -> &[PublishedFlight] {
        &self.flights
    }

    /// All trajectories, to be kept without a copy.
    pub fn shared_flights(&self) -> Arc<Vec<PublishedFlight>> {
        Arc::clone(&self.flights)
    }

    /// Parquet files of a table with the names of their splits, in the order train, val, test; none where the dataset
    /// has no such table.
    ///
    /// # Errors
    /// The folder of the table cannot be read; `dataset-changed`.
    pub fn files(&self, table: &str) -> Result<Vec<(String, PathBuf)>> {
        let folder = self.folder.join("data").join(table);
        let refused = |error: std::io::Error| Diagnostic::io(format!("read `{}`", folder.display()), &error);
        let mut files = vec![];
        if !folder.is_dir() {
            return self.identity.check().map(|()| vec![]);
        }
        for entry in std::fs::read_dir(&folder).map_err(refused)? {
            let path = entry.map_err(refused)?.path();
            let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
            if let (Some((split, _)), true) = (name.split_once('-'), name.ends_with(".parquet")) {
                let place = Split::ALL.iter().position(|it| it.name() == split).unwrap_or(usize::MAX);
                files.push((place, split.to_owned(), path.clone()));
            }
        }
        files.sort();
        self.identity.check()?;
        Ok(files.into_iter().map(|(_, split, path)| (split, path)).collect())
    }

    /// Calls `visit` with each row of a table, in order.
    ///
    /// # Errors
    /// Damage of the table, or an error of `visit`.
    pub(super) fn each_row(&self, table: &str, visit: &mut dyn FnMut(&Rows<'_>, usize) -> Result<()>) -> Result<()> {
        let mut each = |rows: &Rows<'_>| (0..rows.len()).try_for_each(|row| visit(rows, row));
        self.files(table)?.iter().try_for_each(|(_, path)| read(path, &mut each))
    }

    /// Items without a trajectory, with their reasons.
    ///
    /// # Errors
    /// Damage of table `rejected`.
    pub fn rejections(&self) -> Result<BTreeMap<String, String>> {
        let mut found = BTreeMap::new();
        self.each_row("rejected", &mut |rows, row| {
            found.insert(rows.get(Rejected::trajectory_id, row)?, rows.get(Rejected::reason, row)?);
            Ok(())
        })?;
        Ok(found)
    }

    /// Place of the trajectory `id` in [`Self::flights`].
    pub fn place(&self, id: &str) -> Option<usize> {
        let id_of = |place: &u32| self.flights[*place as usize].trajectory_id.as_str();
        let first = self.by_id.partition_point(|place| id_of(place) < id);
        self.by_id.get(first).filter(|place| id_of(place) == id).map(|place| *place as usize)
    }

    /// Trajectory with the id `id`.
    ///
    /// # Errors
    /// `dataset-no-flight`, with the nearest ids.
    pub fn flight(&self, id: &str) -> Result<&PublishedFlight> {
        self.place(id).map(|place| &self.flights[place]).ok_or_else(|| {
            let message = format!("`{}` has no trajectory `{id}`", self.folder.display());
            let refusal = Diagnostic::new("dataset-no-flight", Fault::Recipe, message);
            let ids: Vec<&str> = self.flights.iter().map(|flight| flight.trajectory_id.as_str()).collect();
            let near = nearest_name(id, ids.iter().copied()).map(|near| format!("did you mean `{near}`?"));
            let refusal = near.into_iter().fold(refusal, Diagnostic::hint);
            let shown: Vec<String> = ids.iter().take(LISTED).map(|id| format!("`{id}`")).collect();
            let more = if ids.len() > LISTED { format!(" and {} more", ids.len() - LISTED) } else { String::new() };
            refusal.hint(format!("its trajectories are {}{more}", shown.join(", ")))
        })
    }

    /// An expert and its perturbed twins, given any of them; the expert first.
    pub fn family<'a>(&'a self, flight: &'a PublishedFlight) -> Vec<&'a PublishedFlight> {
        let expert = flight.expert_id.as_deref().unwrap_or(&flight.trajectory_id);
        let mut family: Vec<_> = self.flights.iter().filter(|it| it.trajectory_id == expert).collect();
        family.extend(self.flights.iter().filter(|it| it.expert_id.as_deref() == Some(expert)));
        family
    }

    /// Opens the log of `flight`.
    pub fn log(&self, flight: &PublishedFlight) -> Result<LogReader> {
        let log = LogReader::open(&self.log_path(flight)?, flight.times());
        self.identity.check()?;
        log
    }

    /// Opens the log of `flight` for random access to its images.
    pub fn image_log(&self, flight: &PublishedFlight) -> Result<ImageLog> {
        let log = ImageLog::open(&self.log_path(flight)?, flight.times());
        self.identity.check()?;
        log
    }

    /// Path of a log, inside the dataset.
    fn log_path(&self, flight: &PublishedFlight) -> Result<PathBuf> {
        inner_path(&self.folder, &flight.mcap_path).ok_or_else(|| {
            let message = format!("the log `{}` is outside the dataset", flight.mcap_path);
            Diagnostic::new("dataset-damaged", Fault::Input, message)
        })
    }
}

fn no_dataset(folder: &Path, rejections: &BTreeMap<String, String>) -> Box<Diagnostic> {
    let (shown, is_file) = (folder.display(), folder.is_file());
    if !rejections.is_empty() {
        let message = format!("`{shown}` has no flights: {} were planned and left out", rejections.len());
        let refusal = Diagnostic::new("dataset-none", Fault::Input, message);
        let reasons = rejections.iter().take(3).map(|(id, reason)| format!("{id}: {reason}"));
        let refusal = reasons.fold(refusal, Diagnostic::because);
        return refusal.hint("change the recipe, and run it again; table `rejected` has all reasons");
    }
    let message = match (absent(folder), is_file) {
        (Some(why), _) => format!("`{shown}` {why}"),
        (None, true) => format!("`{shown}` is a file, not the folder of a dataset"),
        (None, false) => format!("`{shown}` is not a published dataset: it has no table `trajectories`"),
    };
    let refusal = Diagnostic::new("dataset-none", Fault::Input, message);
    match folder.extension().and_then(|extension| extension.to_str()) {
        Some("toml") => refusal.hint("run the recipe first, then give the folder that it printed, such as `out/small`"),
        _ => refusal.hint("give the folder that `cosfly run` delivered, such as `out/carla_town`"),
    }
}
