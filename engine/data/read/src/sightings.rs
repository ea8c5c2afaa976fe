//! Visible bodies of single trajectories, beside the target; those of neighbouring trajectories are read together and kept until others
//! are asked for.

use super::dataset::PublishedDataset;
use super::row_index::RowIndex;
use cosfly_diagnose::Result;
use cosfly_frames::DVec3;
use cosfly_schema::tables::{Bodies, Edges};
use std::collections::BTreeMap;

/// A body that a frame shows: a row of table `bodies`.
#[derive(Clone, Debug, PartialEq)]
pub struct SeenBody {
    /// Number of the frame, from 0.
    pub frame: u32,
    /// Id in instance images.
    pub instance: u32,
    /// Kind, such as `pedestrian`.
    pub kind: String,
    /// Middle of the body on the ground, world frame, metres.
    pub feet_in_world: DVec3,
    /// Height of the body, metres.
    pub height_m: f64,
    /// Edges around the visible pixels: left, top, right, bottom.
    pub visible_box_px: Edges,
}

/// Reads visible bodies trajectory by trajectory.
pub struct SightingReader {
    index: RowIndex,
    known: BTreeMap<usize, Vec<SeenBody>>,
}

impl SightingReader {
    /// A reader of table `bodies`.
    ///
    /// # Errors
    /// Damage of the table.
    pub fn of(dataset: &PublishedDataset) -> Result<Self> {
        Ok(Self { index: dataset.row_index("bodies")?, known: BTreeMap::new() })
    }

    /// Bodies of the trajectory at a place in [`PublishedDataset::flights`] of the same dataset, by frame and id.
    ///
    /// # Errors
    /// Damage of the table.
    pub fn at(&mut self, dataset: &PublishedDataset, place: usize) -> Result<&[SeenBody]> {
        if !self.known.contains_key(&place) && self.index.has(place) {
            self.known = BTreeMap::new();
            let wanted = self.index.beside(place);
            let known = &mut self.known;
            self.index.visit(&wanted, &mut |rows, _| {
                let (ids, frames) = (rows.values(Bodies::trajectory_id)?, rows.values(Bodies::frame)?);
                let (instances, boxes) = (rows.values(Bodies::instance)?, rows.values(Bodies::visible_box_px)?);
                for row in 0..rows.len() {
                    let Some(place) = dataset.place(ids.text(row)).filter(|it| wanted.contains(it)) else {
                        continue;
                    };
                    // A row without a box or an id is of a hidden body.
                    let seen = (instances.at(row)?, boxes.at(row)?);
                    let (Some(instance), Some(visible_box_px)) = seen else { continue };
                    let [.., height_m] = rows.get(Bodies::size_m, row)?;
                    known.entry(place).or_default().push(SeenBody {
                        frame: frames.at(row)?,
                        instance,
                        kind: rows.get(Bodies::kind, row)?,
                        feet_in_world: DVec3::from_array(rows.get(Bodies::feet_in_world_m, row)?),
                        height_m,
                        visible_box_px,
                    });
                }
                Ok(())
            })?;
            known.values_mut().for_each(|bodies| bodies.sort_by_key(|body| (body.frame, body.instance)));
        }
        Ok(self.known.get(&place).map_or(&[], Vec::as_slice))
    }
}
