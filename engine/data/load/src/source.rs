//! The seam: flights, tables and images of a dataset.

use crate::ours::Ours;
use crate::{lerobot, v7};
use cosfly_diagnose::Result;
use cosfly_doctor::sources;
use cosfly_domain::Channel;
use cosfly_read::StoredImage;
use cosfly_read::columns::TableData;
use std::path::Path;

/// A flight of a dataset.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Flight {
    /// Name; one flight has it.
    pub id: String,
    /// Split; empty where the data state none.
    pub split: String,
    /// Number of frames.
    pub frames: usize,
    /// Width and height of the images, pixels.
    pub size: [u32; 2],
}

/// A dataset with random access. Threads may share it; it has no threads of its own, so that it survives a fork.
pub trait Source: Send + Sync {
    /// All flights; their numbers are places in this list.
    fn flights(&self) -> &[Flight];

    /// Digest that tells this dataset from others: hex digits.
    fn identity(&self) -> &str;

    /// Refuses to go on where the folder holds another dataset by now.
    ///
    /// # Errors
    /// `dataset-changed`.
    fn check(&self) -> Result<()>;

    /// Names of the channels of a flight.
    ///
    /// # Errors
    /// Files that cannot be read.
    fn channels(&self, flight: usize) -> Result<Vec<&'static str>>;

    /// Image of `channel` in a frame of a flight.
    ///
    /// # Errors
    /// `dataset-channel` for a channel that the layout does not hold, damage of files.
    fn image(&self, flight: usize, channel: &Channel, frame: usize) -> Result<StoredImage>;

    /// A table, of one split or of all.
    ///
    /// # Errors
    /// `dataset-none` for a table that the dataset does not have, damage of files.
    fn table(&self, name: &str, split: Option<&str>) -> Result<TableData>;
}

/// The dataset in `folder`, in any of the layouts.
///
/// # Errors
/// `dataset-none` where there is none, otherwise damage of its files.
pub fn open(folder: &Path) -> Result<Box<dyn Source>> {
    let roots = lerobot::roots(folder);
    if sources::ours::recognises(folder) {
        Ok(Box::new(Ours::open(folder)?))
    } else if let Some(root) = sources::v7::root(folder) {
        Ok(Box::new(v7::open(&root)?))
    } else if !roots.is_empty() {
        Ok(Box::new(lerobot::open(folder, &roots)?))
    } else {
        Ours::open(folder).map(|dataset| Box::new(dataset) as Box<dyn Source>).map_err(|refusal| {
            refusal.hint("datasets of other layouts load, too: v7 (`<Town>/trajectory_<id>/<trace>/trajectory.json`) and LeRobot (`meta/info.json`)")
        })
    }
}
