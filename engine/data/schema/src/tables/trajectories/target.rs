//! The target of a trajectory.

use super::columns::Trajectories;
use crate::tables::DatasetItem;
use crate::tables::column::columns;

columns! { Trajectories::TARGET of DatasetItem;
    /// Height of the target's body.
    target_height_m: f64 = |item, _| item.record.trajectory.track.height_m;
    /// Radius of the target's body seen from above; of a vehicle, of the circle around its outline.
    target_radius_m: f64 = |item, _| item.record.trajectory.track.radius_m;
    /// Length of the target's walk.
    target_length_m: f64 = |item, _| item.record.trajectory.track.length_m();
    /// Mean of `frames.visible_by_pixels`.
    mean_visible_by_pixels: f64 = mean_visible_by_pixels;
    /// Number of frames with the target in the image.
    frames_in_view: u32 = |item, _| item.record.views.iter().filter(|view| view.in_view).count() as u32;
}

fn mean_visible_by_pixels(item: &DatasetItem, _: usize) -> f64 {
    let views = &item.record.views;
    views.iter().map(|view| view.visible_by_pixels).sum::<f64>() / views.len().max(1) as f64
}
