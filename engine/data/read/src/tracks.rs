//! Poses, targets and visibility of some flights of a dataset, without pictures: the ground truth for predictions.

use super::damage::damaged;
use super::dataset::PublishedDataset;
use super::row_index::RowIndex;
use super::rows::{RowValues, Rows};
use cosfly_diagnose::Result;
use cosfly_frames::{DVec3, Pose};
use cosfly_schema::tables::{Edges, Frames};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Frames of a flight, one entry of each list per frame. World frame, metres, radians.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FlightTrack {
    /// Poses of the drone.
    pub poses: Vec<Pose>,
    /// Positions of the target's feet.
    pub feet: Vec<DVec3>,
    /// Walking directions of the target.
    pub heading_rad: Vec<f64>,
    /// Share of the target's body that rays from the camera reach, 0..=1.
    pub visible: Vec<f64>,
    /// Edges around the target's visible pixels: left, top, right, bottom.
    pub boxes: Vec<Option<Edges>>,
    /// Frame of the expert for each frame of a perturbed flight; the frame itself for an expert.
    pub expert_frame: Vec<u32>,
}

impl PublishedDataset {
    /// Tracks of some trajectories, by their places in [`Self::flights`]. Reads only the row groups that hold them.
    ///
    /// # Errors
    /// A missing column, a row without a value, or frames that are missing or out of order.
    pub fn tracks(&self, index: &RowIndex, wanted: &BTreeSet<usize>) -> Result<BTreeMap<usize, FlightTrack>> {
        let tracks = index.tracks(wanted, &|id| self.place(id))?;
        for place in wanted {
            let (flight, rows) = (&self.flights()[*place], tracks.get(place).map_or(0, |track| track.poses.len()));
            if rows != flight.frames {
                let frames = flight.frames;
                let what = format!("it has {rows} rows of `{}`, which has {frames} frames", flight.trajectory_id);
                let folder = self.folder().join("data/frames");
                return Err(damaged(&folder, &what, "rows are missing or duplicated"));
            }
        }
        Ok(tracks)
    }
}

impl RowIndex {
    /// Tracks of some trajectories, by the numbers that `number_of` gives their ids.
    ///
    /// # Errors
    /// A missing column, a row without a value, or frames that are out of order.
    pub fn tracks(
        &self,
        wanted: &BTreeSet<usize>,
        number_of: &dyn Fn(&str) -> Option<usize>,
    ) -> Result<BTreeMap<usize, FlightTrack>> {
        let mut tracks: BTreeMap<usize, FlightTrack> = BTreeMap::new();
        self.visit(wanted, &mut |rows, path| {
            let columns = Columns::of(rows)?;
            let mut last: Option<(&str, Option<usize>)> = None;
            for row in 0..rows.len() {
                let id = columns.ids.text(row);
                let number = match last {
                    Some((name, number)) if name == id => number,
                    _ => number_of(id).filter(|number| wanted.contains(number)),
                };
                last = Some((id, number));
                if let Some(number) = number {
                    columns.push(row, path, id, tracks.entry(number).or_default())?;
                }
            }
            Ok(())
        })?;
        Ok(tracks)
    }
}

/// Columns of tracks, in the rows of one group.
struct Columns<'f> {
    ids: RowValues<'f, String>,
    frame: RowValues<'f, u32>,
    position: [RowValues<'f, f64>; 3],
    /// Pitch, yaw, roll, degrees.
    angles: [RowValues<'f, f64>; 3],
    feet: [RowValues<'f, f64>; 3],
    heading: RowValues<'f, f64>,
    visible: RowValues<'f, f64>,
    boxes: RowValues<'f, Option<Edges>>,
    expert_frame: RowValues<'f, Option<u32>>,
}

impl<'f> Columns<'f> {
    fn of(rows: &Rows<'f>) -> Result<Self> {
        Ok(Self {
            ids: rows.values(Frames::trajectory_id)?,
            frame: rows.values(Frames::frame)?,
            position: [
                rows.values(Frames::drone_x_m)?,
                rows.values(Frames::drone_y_m)?,
                rows.values(Frames::drone_z_m)?,
            ],
            angles: [
                rows.values(Frames::drone_pitch_deg)?,
                rows.values(Frames::drone_yaw_deg)?,
                rows.values(Frames::drone_roll_deg)?,
            ],
            feet: [
                rows.values(Frames::target_x_m)?,
                rows.values(Frames::target_y_m)?,
                rows.values(Frames::target_z_m)?,
            ],
            heading: rows.values(Frames::target_heading_deg)?,
            visible: rows.values(Frames::visible_by_rays)?,
            boxes: rows.values(Frames::visible_box_px)?,
            expert_frame: rows.values(Frames::expert_frame)?,
        })
    }

    fn push(&self, row: usize, path: &Path, id: &str, track: &mut FlightTrack) -> Result<()> {
        let frame = self.frame.at(row)?;
        if frame as usize != track.poses.len() {
            let what = format!("frame {frame} of `{id}` is out of order");
            return Err(damaged(path, &what, format!("frame {} was expected", track.poses.len())));
        }
        let vector = |of: &[RowValues<'f, f64>; 3]| Ok::<_, Box<_>>([of[0].at(row)?, of[1].at(row)?, of[2].at(row)?]);
        let [pitch_rad, yaw_rad, roll_rad] = vector(&self.angles)?.map(f64::to_radians);
        let position_in_world = DVec3::from_array(vector(&self.position)?);
        track.poses.push(Pose { position_in_world, pitch_rad, yaw_rad, roll_rad });
        track.feet.push(DVec3::from_array(vector(&self.feet)?));
        track.heading_rad.push(self.heading.at(row)?.to_radians());
        track.visible.push(self.visible.at(row)?);
        track.boxes.push(self.boxes.at(row)?);
        track.expert_frame.push(self.expert_frame.at(row)?.unwrap_or(frame));
        Ok(())
    }
}
