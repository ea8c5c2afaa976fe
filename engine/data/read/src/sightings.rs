//! Visible bodies of single trajectories, beside the target; those of neighbouring trajectories are read together and kept until others
//! are asked for.

use super::dataset::PublishedDataset;
use super::row_index::RowIndex;
use cosfly_diagnose::Result;
use cosfly_schema::tables::{Edges, People};
use std::collections::BTreeMap;

/// A body that a frame shows: a row of table `people`.
#[derive(Clone, Debug, PartialEq)]
pub struct SeenBody {
    /// Number of the frame, from 0.
    pub frame: u32,
    /// Id in instance images.
    pub instance: u32,
    /// Kind, such as `pedestrian`.
    pub kind: String,
    /// Edges around the visible pixels: left, top, right, bottom.
    pub visible_box_px: Edges,
}

/// Reads visible bodies trajectory by trajectory.
pub struct SightingReader {
    index: RowIndex,
    known: BTreeMap<usize, Vec<SeenBody>>,
}

impl SightingReader {
    /// A reader of table `people`.
    ///
    /// # Errors
    /// Damage of the table.
    pub fn of(dataset: &PublishedDataset) -> Result<Self> {
        Ok(Self { index: dataset.row_index("people")?, known: BTreeMap::new() })
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
                let (ids, frames) = (rows.values(People::trajectory_id)?, rows.values(People::frame)?);
                let (instances, boxes) = (rows.values(People::instance)?, rows.values(People::visible_box_px)?);
                for row in 0..rows.len() {
                    let Some(place) = dataset.place(ids.text(row)).filter(|it| wanted.contains(it)) else {
                        continue;
                    };
                    known.entry(place).or_default().push(SeenBody {
                        frame: frames.at(row)?,
                        instance: instances.at(row)?,
                        kind: rows.get_or(People::kind, row, "pedestrian".to_owned())?,
                        visible_box_px: boxes.at(row)?,
                    });
                }
                Ok(())
            })?;
            known.values_mut().for_each(|bodies| bodies.sort_by_key(|body| (body.frame, body.instance)));
        }
        Ok(self.known.get(&place).map_or(&[], Vec::as_slice))
    }
}
