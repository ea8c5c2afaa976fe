//! Datasets of foreign layouts: episodes as `cosfly doctor` reads them, and pictures at random.

use crate::tables::{self, Part};
use crate::{FlightSource, LoadedFlight};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_domain::Channel;
use cosfly_episodes::{ExaminedEpisode, Flag, Severity};
use cosfly_fingerprint::Digest;
use cosfly_read::StoredImage;
use cosfly_read::columns::TableData;
use std::path::{Path, PathBuf};

/// Pictures of a layout.
pub trait Pictures: Send + Sync {
    /// Names of the channels.
    fn channels(&self) -> &[&'static str];

    /// Why there are no images of other channels, and what to do.
    fn advice(&self) -> String;

    /// Image of one of [`Self::channels`] in a frame of a flight.
    ///
    /// # Errors
    /// Damage of files.
    fn image(&self, flight: usize, channel: &Channel, frame: usize) -> Result<StoredImage>;
}

/// A dataset of a foreign layout.
pub struct Foreign<P> {
    /// Name of the layout.
    pub layout: &'static str,
    /// Folder of the dataset.
    pub folder: PathBuf,
    /// All flights.
    pub flights: Vec<LoadedFlight>,
    /// The episodes of the flights, in their order.
    pub episodes: Vec<ExaminedEpisode>,
    /// Whether the poses of the drone are stated.
    pub has_poses: bool,
    /// Digest of flights, motions and sizes of picture files.
    pub identity: String,
    /// Pictures.
    pub pictures: P,
}

/// Digest of a dataset of a foreign layout, which names itself nowhere: flights, motions, and sizes of some files of pictures.
pub fn identity(flights: &[LoadedFlight], episodes: &[ExaminedEpisode], pictures: &[PathBuf]) -> String {
    let mut known: Vec<u8> = vec![];
    let mut text = |text: &str| {
        known.extend((text.len() as u64).to_le_bytes());
        known.extend(text.as_bytes());
    };
    for (flight, episode) in flights.iter().zip(episodes) {
        text(&flight.id);
        text(&flight.split);
        for moment in &episode.moments {
            let drone = &moment.drone;
            let target = moment.target_in_world.unwrap_or_default().to_array();
            let angles = [drone.pitch_rad, drone.yaw_rad, drone.roll_rad];
            let numbers = drone.position_in_world.to_array().into_iter().chain(angles).chain(target);
            text(&numbers.map(|number| format!("{:016x}", number.to_bits())).collect::<String>());
        }
    }
    for path in pictures {
        text(&std::fs::metadata(path).map_or(0, |found| found.len()).to_string());
    }
    Digest::of(&known).to_string()
}

impl<P: Pictures> FlightSource for Foreign<P> {
    fn flights(&self) -> &[LoadedFlight] {
        &self.flights
    }

    fn identity(&self) -> &str {
        &self.identity
    }

    fn check(&self) -> Result<()> {
        Ok(())
    }

    fn channels(&self, _flight: usize) -> Result<Vec<&'static str>> {
        Ok(self.pictures.channels().to_vec())
    }

    fn image(&self, flight: usize, channel: &Channel, frame: usize) -> Result<StoredImage> {
        if !self.pictures.channels().contains(&channel.name) {
            let (folder, layout) = (self.folder.display(), self.layout);
            let message = format!("`{folder}`, of layout {layout}, has no channel `{}`", channel.name);
            return Err(Diagnostic::new("dataset-channel", Fault::Recipe, message).hint(self.pictures.advice()));
        }
        self.pictures.image(flight, channel, frame)
    }

    fn table(&self, name: &str, split: Option<&str>) -> Result<TableData> {
        let all = self.flights.iter().zip(&self.episodes);
        let parts: Vec<Part<'_>> = all.filter(|(flight, _)| split.is_none_or(|split| split == flight.split)).collect();
        let none = |why: String| {
            let (folder, layout) = (self.folder.display(), self.layout);
            let message = format!("`{folder}`, of layout {layout}, has no table `{name}`{why}");
            let tables = if self.has_poses { tables::NAMES } else { tables::NAMES_WITHOUT_POSES };
            Diagnostic::new("dataset-none", Fault::Input, message)
                .hint(format!("data of this layout give the tables {}", tables.join(", ")))
        };
        match tables::made(name, &parts, &self.episodes, self.has_poses) {
            Some(rows) => Ok(TableData::Rows(rows)),
            None if name == "windows" => Err(none(": the data state no poses of the drone".to_owned())),
            None => Err(none(String::new())),
        }
    }
}

/// Refuses damaged data: the first damage, and the number of others.
///
/// # Errors
/// `dataset-damaged`.
pub fn sound(folder: &Path, flags: &[Flag]) -> Result<()> {
    let mut damages = flags.iter().filter(|flag| flag.severity == Severity::Damage);
    let Some(first) = damages.next() else { return Ok(()) };
    let message = format!("`{}` is damaged: {}: {}", folder.display(), first.place, first.message);
    let more = match damages.count() {
        0 => "`cosfly doctor` examines all of it".to_owned(),
        others => format!("`cosfly doctor` lists this and {others} more"),
    };
    Err(Diagnostic::new("dataset-damaged", Fault::Input, message).hint(more))
}

/// Damage of a file of pictures.
pub fn damaged(path: &Path, what: &str, cause: impl std::fmt::Display) -> Box<Diagnostic> {
    Diagnostic::new("dataset-damaged", Fault::Input, format!("`{}` is damaged: {what}", path.display()))
        .because(cause)
        .hint("`cosfly doctor` lists everything that is wrong with the data")
}
