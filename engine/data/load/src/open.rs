//! [`open`]: the source in a folder, by its layout.

use crate::ours::Ours;
use crate::{FlightSource, lerobot, v7};
use cosfly_diagnose::Result;
use cosfly_doctor::sources;
use std::path::Path;

/// The dataset in `folder`, in any of the layouts.
///
/// # Errors
/// `dataset-none` where there is none, otherwise damage of its files.
pub fn open(folder: &Path) -> Result<Box<dyn FlightSource>> {
    let roots = lerobot::roots(folder);
    if sources::ours::recognises(folder) {
        Ok(Box::new(Ours::open(folder)?))
    } else if let Some(root) = sources::v7::root(folder) {
        Ok(Box::new(v7::open(&root)?))
    } else if !roots.is_empty() {
        Ok(Box::new(lerobot::open(folder, &roots)?))
    } else {
        Ours::open(folder).map(|dataset| Box::new(dataset) as Box<dyn FlightSource>).map_err(|refusal| {
            refusal.hint("datasets of other layouts load, too: v7 (`<Town>/trajectory_<id>/<trace>/trajectory.json`) and LeRobot (`meta/info.json`)")
        })
    }
}
