//! Flights one after the other with all that the tables say of their frames: what exports are made of.

use super::columns::{self, Rows, damaged};
use super::flights::{FRAME_COLUMNS, PublishedDataset, PublishedFlight, PublishedFrame, table_files};
use crate::CaptionRecord;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_frames::DVec3;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// A row of table `frames` with its disturbance.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameRow {
    /// Poses, target, visibility and boxes.
    pub frame: PublishedFrame,
    /// Whether the body covers at least one pixel centre, occluded or not.
    pub in_view: bool,
    /// Visible pixels of the target.
    pub visible_pixels: u32,
    /// How the frame departs from the expert's; none in an expert's flight.
    pub disturbance: Option<Disturbance>,
}

/// How a frame of a perturbed flight departs from its expert's.
#[derive(Clone, Debug, PartialEq)]
pub struct Disturbance {
    /// The expert's frame.
    pub expert_frame: u32,
    /// Whether the position was disturbed.
    pub position: bool,
    /// Whether the rotation was.
    pub rotation: bool,
    /// Displacement of the drone, metres.
    pub drone_offset_in_world: DVec3,
    /// Displacement of the point aimed at, metres.
    pub aim_offset_in_world: DVec3,
    /// Turn added to the pitch, degrees.
    pub pitch_offset_deg: f64,
    /// Turn added to the yaw, degrees.
    pub yaw_offset_deg: f64,
}

const MORE_COLUMNS: [&str; 9] = [
    "in_view",
    "visible_pixels",
    "expert_frame",
    "position_event",
    "rotation_event",
    "drone_offset_in_world_m",
    "aim_offset_in_world_m",
    "pitch_offset_deg",
    "yaw_offset_deg",
];

impl PublishedDataset {
    /// Gives flights that are `wanted` with all their frames to `visit`, in the order of table `frames`. One flight is in
    /// memory at a time.
    ///
    /// # Errors
    /// What is wrong with the table, such as frames that are missing; what `visit` says.
    pub fn walk(
        &self,
        wanted: &dyn Fn(&PublishedFlight) -> bool,
        visit: &mut dyn FnMut(&PublishedFlight, Vec<FrameRow>) -> Result<()>,
    ) -> Result<()> {
        let mut awaited: BTreeMap<&str, &PublishedFlight> =
            self.flights().iter().map(|it| (&*it.trajectory_id, it)).collect();
        awaited.retain(|_, flight| wanted(flight));
        let splits: BTreeSet<&str> = awaited.values().map(|flight| &*flight.split).collect();
        let is_read = |name: &str| FRAME_COLUMNS.contains(&name) || MORE_COLUMNS.contains(&name);
        let mut open: Option<(&PublishedFlight, Vec<FrameRow>)> = None;
        for (split, path) in table_files(&self.folder().join("data/frames"))? {
            if !splits.contains(&*split) {
                continue;
            }
            columns::read(&path, &is_read, &mut |rows| {
                for row in 0..rows.len() {
                    let id = rows.text_at("trajectory_id", row)?;
                    if open.as_ref().is_none_or(|(flight, _)| flight.trajectory_id != id) {
                        end(open.take(), visit)?;
                        open =
                            awaited.remove(id).map(|flight| (flight, Vec::with_capacity(flight.frames.min(1 << 16))));
                    }
                    if let Some((flight, frames)) = &mut open {
                        frames.push(FrameRow::read(rows, row, &path, flight, frames.len())?);
                    }
                }
                Ok(())
            })?;
        }
        end(open.take(), visit)?;
        match awaited.values().next() {
            Some(flight) => Err(incomplete(flight, 0)),
            None => Ok(()),
        }
    }

    /// The captions of all flights, by trajectory id.
    ///
    /// # Errors
    /// What is wrong with the table.
    pub fn captions(&self) -> Result<BTreeMap<String, Vec<CaptionRecord>>> {
        let mut captions: BTreeMap<String, Vec<CaptionRecord>> = BTreeMap::new();
        let folder = self.folder().join("data/captions");
        for (_, path) in if folder.is_dir() { table_files(&folder)? } else { vec![] } {
            columns::read(&path, &|_| true, &mut |rows| {
                for row in 0..rows.len() {
                    let text = |name: &str| rows.text_at(name, row).map(str::to_owned);
                    let caption =
                        CaptionRecord { language: text("language")?, style: text("style")?, text: text("text")? };
                    captions.entry(text("trajectory_id")?).or_default().push(caption);
                }
                Ok(())
            })?;
        }
        Ok(captions)
    }
}

fn end(
    open: Option<(&PublishedFlight, Vec<FrameRow>)>,
    visit: &mut dyn FnMut(&PublishedFlight, Vec<FrameRow>) -> Result<()>,
) -> Result<()> {
    match open {
        Some((flight, frames)) if frames.len() == flight.frames => visit(flight, frames),
        Some((flight, frames)) => Err(incomplete(flight, frames.len())),
        None => Ok(()),
    }
}

fn incomplete(flight: &PublishedFlight, rows: usize) -> Box<Diagnostic> {
    let (id, frames) = (&flight.trajectory_id, flight.frames);
    let message = format!("table `frames` has {rows} rows of `{id}` together; it has {frames} frames");
    Diagnostic::new("dataset-damaged", Fault::Input, message)
        .hint("`cosfly verify` lists everything that is wrong with a dataset")
}

impl FrameRow {
    fn read(rows: &Rows<'_>, row: usize, path: &Path, flight: &PublishedFlight, place: usize) -> Result<Self> {
        let number = rows.count("frame", row)?;
        if number as usize != place {
            let what = format!("frame {number} of `{}` is out of order", flight.trajectory_id);
            return Err(damaged(path, &what, format!("frame {place} should be there")));
        }
        let disturbance = match rows.count_or_null("expert_frame", row)? {
            None => None,
            Some(expert_frame) => Some(Disturbance {
                expert_frame,
                position: rows.flag("position_event", row)?,
                rotation: rows.flag("rotation_event", row)?,
                drone_offset_in_world: DVec3::from_array(rows.vector("drone_offset_in_world_m", row)?),
                aim_offset_in_world: DVec3::from_array(rows.vector("aim_offset_in_world_m", row)?),
                pitch_offset_deg: rows.real("pitch_offset_deg", row)?,
                yaw_offset_deg: rows.real("yaw_offset_deg", row)?,
            }),
        };
        Ok(Self {
            frame: PublishedFrame::read(rows, row)?,
            in_view: rows.flag("in_view", row)?,
            visible_pixels: rows.count("visible_pixels", row)?,
            disturbance,
        })
    }
}
