//! Visible bodies of single trajectories, beside the target; those of neighbouring trajectories are read together and kept until others
//! are asked for.

use super::dataset::PublishedDataset;
use super::kept_rows::KeptRows;
use super::rows::Rows;
use cosfly_diagnose::Result;
use cosfly_frames::DVec3;
use cosfly_schema::tables::{Bodies, Edges};

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
    rows: KeptRows<SeenBody>,
}

impl SightingReader {
    /// A reader of table `bodies`.
    ///
    /// # Errors
    /// Damage of the table.
    pub fn of(dataset: &PublishedDataset) -> Result<Self> {
        Ok(Self { rows: KeptRows::of(dataset, "bodies")? })
    }

    /// Bodies of the trajectory at a place in [`PublishedDataset::flights`] of the same dataset, by frame and id.
    ///
    /// # Errors
    /// Damage of the table.
    pub fn at(&mut self, dataset: &PublishedDataset, place: usize) -> Result<&[SeenBody]> {
        let read = |rows: &Rows<'_>, row: usize| {
            // A row without a box or an id is of a hidden body.
            let seen = (rows.get(Bodies::instance, row)?, rows.get(Bodies::visible_box_px, row)?);
            let (Some(instance), Some(visible_box_px)) = seen else { return Ok(None) };
            let [.., height_m] = rows.get(Bodies::size_m, row)?;
            Ok(Some(SeenBody {
                frame: rows.get(Bodies::frame, row)?,
                instance,
                kind: rows.get(Bodies::kind, row)?,
                feet_in_world: DVec3::from_array(rows.get(Bodies::feet_in_world_m, row)?),
                height_m,
                visible_box_px,
            }))
        };
        self.rows.at(dataset, place, Bodies::trajectory_id, read, |body| (body.frame, body.instance))
    }
}
