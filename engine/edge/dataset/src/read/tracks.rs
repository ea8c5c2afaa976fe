//! Poses, targets and visibility of all flights of a dataset at once, without pictures: what predictions are judged by.

use super::columns::{self, Rows, damaged};
use super::flights::{PublishedDataset, PublishedFlight, table_files};
use arrow::array::StringArray;
use cosfly_diagnose::Result;
use cosfly_frames::{DVec3, Pose};
use std::collections::BTreeMap;
use std::path::Path;

/// The frames of a flight, one entry of each list per frame. World frame, metres, radians.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FlightTrack {
    /// Poses of the drone.
    pub poses: Vec<Pose>,
    /// The target's feet.
    pub feet: Vec<DVec3>,
    /// The target's walking direction.
    pub heading_rad: Vec<f64>,
    /// Share of the target's body that rays from the camera reach, 0..=1.
    pub visible: Vec<f64>,
    /// Edges around the target's visible pixels: left, top, right, bottom.
    pub boxes: Vec<Option<[f32; 4]>>,
    /// The expert's frame of each frame of a perturbed flight; its own for an expert.
    pub expert_frame: Vec<u32>,
}

const COLUMNS: [&str; 15] = [
    "trajectory_id",
    "frame",
    "drone_x_m",
    "drone_y_m",
    "drone_z_m",
    "drone_pitch_deg",
    "drone_yaw_deg",
    "drone_roll_deg",
    "target_x_m",
    "target_y_m",
    "target_z_m",
    "target_heading_deg",
    "visible_by_rays",
    "visible_box_px",
    "expert_frame",
];

/// Frames that room is made for at most before they are there.
const MOST_ROOM: usize = 1 << 16;

impl FlightTrack {
    /// An empty one with room for `frames` frames.
    fn with_room(frames: usize) -> Self {
        Self {
            poses: Vec::with_capacity(frames),
            feet: Vec::with_capacity(frames),
            heading_rad: Vec::with_capacity(frames),
            visible: Vec::with_capacity(frames),
            boxes: Vec::with_capacity(frames),
            expert_frame: Vec::with_capacity(frames),
        }
    }
}

impl PublishedDataset {
    /// The track of every flight, in the order of [`Self::flights`]. Reads each file of table `frames` once.
    ///
    /// # Errors
    /// What is wrong with the table: a column that is not there, a number that is none, frames that are missing.
    pub fn tracks(&self) -> Result<Vec<FlightTrack>> {
        let mut tracks: Vec<FlightTrack> =
            self.flights().iter().map(|flight| FlightTrack::with_room(flight.frames.min(MOST_ROOM))).collect();
        let places: BTreeMap<&str, usize> =
            self.flights().iter().enumerate().map(|(place, flight)| (flight.trajectory_id.as_str(), place)).collect();
        for (_, path) in table_files(&self.folder().join("data/frames"))? {
            let mut last = None;
            columns::read(&path, &|name| COLUMNS.contains(&name), &mut |rows| {
                let batch = Batch::of(rows)?;
                for row in 0..rows.len() {
                    let id = batch.ids.value(row);
                    if last.as_ref().is_none_or(|(name, _)| name != id) {
                        let place = places.get(id).copied();
                        let unknown =
                            || damaged(&path, &format!("flight `{id}` is in no table of flights"), "a stray row");
                        last = Some((id.to_owned(), place.ok_or_else(unknown)?));
                    }
                    if let Some((_, place)) = &last {
                        batch.push(row, &path, &self.flights()[*place], &mut tracks[*place])?;
                    }
                }
                Ok(())
            })?;
        }
        for (flight, track) in self.flights().iter().zip(&tracks) {
            if track.poses.len() != flight.frames {
                let (rows, frames) = (track.poses.len(), flight.frames);
                let what = format!("it has {rows} rows of `{}`, which has {frames} frames", flight.trajectory_id);
                return Err(damaged(&self.folder().join("data/frames"), &what, "rows are missing or too many"));
            }
        }
        Ok(tracks)
    }
}

/// The columns of some rows.
struct Batch<'a> {
    ids: &'a StringArray,
    boxes: Vec<Option<[f32; 4]>>,
    expert_frame: Vec<Option<u32>>,
    frame: &'a [i64],
    /// Position, angles, feet, heading, visibility.
    reals: [&'a [f64]; 11],
}

impl<'a> Batch<'a> {
    fn of(rows: &'a Rows<'a>) -> Result<Self> {
        let mut reals: [&[f64]; 11] = [&[]; 11];
        for (column, name) in reals.iter_mut().zip(&COLUMNS[2..13]) {
            *column = rows.reals(name)?;
        }
        Ok(Self {
            ids: rows.texts("trajectory_id")?,
            boxes: rows.boxes("visible_box_px")?,
            expert_frame: rows.counts_or_null("expert_frame")?,
            frame: rows.integers("frame")?,
            reals,
        })
    }

    fn push(&self, row: usize, path: &Path, flight: &PublishedFlight, track: &mut FlightTrack) -> Result<()> {
        if usize::try_from(self.frame[row]) != Ok(track.poses.len()) {
            let what = format!("frame {} of `{}` is out of order", self.frame[row], flight.trajectory_id);
            return Err(damaged(path, &what, format!("frame {} should be there", track.poses.len())));
        }
        let [x, y, z, pitch, yaw, roll, feet_x, feet_y, feet_z, heading, visible] =
            self.reals.map(|column| column[row]);
        track.poses.push(Pose {
            position_in_world: DVec3::new(x, y, z),
            pitch_rad: pitch.to_radians(),
            yaw_rad: yaw.to_radians(),
            roll_rad: roll.to_radians(),
        });
        track.feet.push(DVec3::new(feet_x, feet_y, feet_z));
        track.heading_rad.push(heading.to_radians());
        track.visible.push(visible);
        track.boxes.push(self.boxes[row]);
        let own = track.expert_frame.len() as u32;
        track.expert_frame.push(self.expert_frame[row].unwrap_or(own));
        Ok(())
    }
}
