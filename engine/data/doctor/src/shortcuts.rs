//! What gives the targets of a dataset of cosfly away: their place in the picture, and their clothes.

use cosfly_diagnose::Result;
use cosfly_metrics::shortcuts::{Edges, ShortcutFigures, Shortcuts};
use cosfly_read::PublishedDataset;
use cosfly_schema::tables::{People, Trajectories};
use std::collections::{BTreeMap, BTreeSet};

/// Boxes of people by trajectory and frame.
type Boxes = BTreeMap<(String, u32), Vec<Edges>>;

/// Figures over all flights; experts alone count for places in the picture. Datasets from before the columns of clothes existed
/// have figures of places alone.
///
/// # Errors
/// Damage of the tables.
pub fn figures(dataset: &PublishedDataset) -> Result<ShortcutFigures> {
    let mut shortcuts = Shortcuts::default();
    let towns: BTreeMap<&str, &str> =
        dataset.flights().iter().map(|it| (it.trajectory_id.as_str(), it.town.as_str())).collect();
    let town = |id: &str| towns.get(id).copied().unwrap_or_default();
    for (_, path) in dataset.files("trajectories")? {
        cosfly_read::read(&path, &mut |rows| {
            for row in 0..rows.len() {
                if let Some(top) = rows.get_or(Trajectories::target_top_linear_rgb, row, None)? {
                    let id = rows.get(Trajectories::trajectory_id, row)?;
                    shortcuts
                        .add_target(&format!("{} {}", town(&id), rows.get(Trajectories::pedestrian_id, row)?), top);
                }
            }
            Ok(())
        })?;
    }
    let experts: BTreeSet<&str> =
        dataset.flights().iter().filter(|it| it.expert_id.is_none()).map(|it| it.trajectory_id.as_str()).collect();
    let mut boxes = Boxes::new();
    for (_, path) in dataset.files("people")? {
        cosfly_read::read(&path, &mut |rows| {
            for row in 0..rows.len() {
                let id = rows.get(People::trajectory_id, row)?;
                if rows.has(People::top_linear_rgb) {
                    let walk = format!("{} {}", town(&id), rows.get(People::walk_id, row)?);
                    shortcuts.add_other(&walk, rows.get(People::top_linear_rgb, row)?);
                }
                if experts.contains(id.as_str()) {
                    let edges = rows.get(People::visible_box_px, row)?.map(f64::from);
                    boxes.entry((id, rows.get(People::frame, row)?)).or_default().push(edges);
                }
            }
            Ok(())
        })?;
    }
    dataset.walk(&|flight| flight.expert_id.is_none(), &mut |flight, rows| {
        let image_px = [flight.camera.width, flight.camera.height].map(f64::from);
        for (frame, row) in rows.iter().enumerate() {
            if let Some(target) = row.visible_box_px {
                let others = boxes.remove(&(flight.trajectory_id.clone(), frame as u32)).unwrap_or_default();
                shortcuts.add_frame(image_px, target.map(f64::from), others.into_iter());
            }
        }
        Ok(())
    })?;
    Ok(shortcuts.figures())
}
