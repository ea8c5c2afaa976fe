//! Rows of table `frames`, trajectory by trajectory.

use super::damage::damaged;
use super::dataset::PublishedDataset;
use super::row_index::RowIndex;
use super::rows::{Rows, read};
use super::trajectory::PublishedFlight;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_frames::{DVec3, Pose, TargetState};
use cosfly_schema::tables::{Edges, Frames};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// A row of table `frames`, without costs, labels and preview. World frame: CARLA's, metres, radians.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameRow {
    /// Number of the frame, from 0.
    pub frame: u32,
    /// Time of the frame, seconds.
    pub time_s: f64,
    /// Pose of the drone.
    pub pose: Pose,
    /// Pose of the camera.
    pub camera_pose: Pose,
    /// State of the target.
    pub target: TargetState,
    /// Distance from the camera to the target's feet, metres.
    pub distance_m: f64,
    /// Distance from the drone to the nearest obstacle, metres.
    pub clearance_m: f64,
    /// Whether the body covers at least one pixel centre, occluded or not.
    pub in_view: bool,
    /// Share of body points reached by rays, 0..=1.
    pub visible_by_rays: f64,
    /// Visible pixels / pixels without obstacles, 0..=1.
    pub visible_by_pixels: f64,
    /// Share of hundreds of rays that reach the body, 0..=1; `None` out of view.
    pub visible_by_dense_rays: Option<f64>,
    /// Number of visible pixels of the target.
    pub visible_pixels: u32,
    /// Edges around the visible pixels: left, top, right, bottom.
    pub visible_box_px: Option<Edges>,
    /// Edges around the pixels without obstacles: left, top, right, bottom.
    pub full_box_px: Option<Edges>,
    /// Instance id of the main occluder of the target; 0 when there is none.
    pub occluder_instance: u32,
    /// Number of visible bystanders who wear what the target wears.
    pub look_alikes: u32,
    /// Step to the next frame along the world's axes: dx, dy, dz (m), dpitch, dyaw, droll (degrees); `None` on the last
    /// frame.
    pub action_in_world: Option<[f64; 6]>,
    /// The next pose in this one's body frame: dx, dy, dz (m), dpitch, dyaw, droll (degrees); `None` on the last frame.
    pub action_in_body: Option<[f64; 6]>,
    /// Disturbance relative to the expert's frame; `None` in an expert's trajectory.
    pub disturbance: Option<Disturbance>,
}

/// Disturbance of a perturbed trajectory's frame relative to the expert's.
#[derive(Clone, Debug, PartialEq)]
pub struct Disturbance {
    /// Frame of the expert.
    pub expert_frame: u32,
    /// Whether the position was disturbed.
    pub position: bool,
    /// Whether the rotation was disturbed.
    pub rotation: bool,
    /// Displacement of the drone, metres.
    pub drone_offset_in_world: DVec3,
    /// Displacement of the aim point of the camera, metres.
    pub aim_offset_in_world: DVec3,
    /// Rotation added to the pitch, degrees.
    pub pitch_offset_deg: f64,
    /// Rotation added to the yaw, degrees.
    pub yaw_offset_deg: f64,
}

/// Callback for a trajectory and its frames, in order.
type Visit<'a> = &'a mut dyn FnMut(&PublishedFlight, Vec<FrameRow>) -> Result<()>;

/// Most frames for which memory is reserved in advance.
const MOST_ROOM: usize = 1 << 16;

impl PublishedDataset {
    /// Calls `visit` for every `wanted` trajectory with all its frames, in the order of table `frames`. One trajectory
    /// is in memory at a time.
    ///
    /// # Errors
    /// A missing column, a row without a value, missing frames, or an error of `visit`.
    pub fn walk(&self, wanted: &dyn Fn(&PublishedFlight) -> bool, visit: Visit<'_>) -> Result<()> {
        let mut awaited: BTreeMap<&str, &PublishedFlight> =
            self.flights().iter().map(|it| (&*it.trajectory_id, it)).collect();
        awaited.retain(|_, flight| wanted(flight));
        let splits: BTreeSet<&str> = awaited.values().map(|flight| &*flight.split).collect();
        let mut open: Option<(&PublishedFlight, Vec<FrameRow>)> = None;
        for (split, path) in self.files("frames")? {
            if awaited.is_empty() && open.is_none() || !splits.contains(&*split) {
                continue;
            }
            read(&path, &mut |rows| {
                let ids = rows.values(Frames::trajectory_id)?;
                for row in 0..rows.len() {
                    let id = ids.text(row);
                    if open.as_ref().is_none_or(|(flight, _)| flight.trajectory_id != id) {
                        end(open.take(), visit)?;
                        open = awaited.remove(id).map(|it| (it, Vec::with_capacity(it.frames.min(MOST_ROOM))));
                    }
                    if let Some((flight, frames)) = &mut open {
                        push(frames, FrameRow::read(rows, row)?, flight, &path)?;
                    }
                }
                Ok(())
            })?;
        }
        end(open.take(), visit)?;
        awaited.values().next().map_or(Ok(()), |flight| Err(incomplete(flight, 0)))
    }

    /// All frames of one trajectory, in order.
    ///
    /// # Errors
    /// A missing column, a row without a value, or missing frames.
    pub fn frames(&self, index: &RowIndex, flight: &PublishedFlight) -> Result<Vec<FrameRow>> {
        let place = self.place(&flight.trajectory_id);
        let mut frames: Vec<FrameRow> = Vec::with_capacity(flight.frames.min(MOST_ROOM));
        index.visit(&place.into_iter().collect(), &mut |rows, path| {
            let ids = rows.values(Frames::trajectory_id)?;
            for row in (0..rows.len()).filter(|row| ids.text(*row) == flight.trajectory_id) {
                push(&mut frames, FrameRow::read(rows, row)?, flight, path)?;
            }
            Ok(())
        })?;
        if frames.len() == flight.frames { Ok(frames) } else { Err(incomplete(flight, frames.len())) }
    }
}

fn push(frames: &mut Vec<FrameRow>, frame: FrameRow, flight: &PublishedFlight, path: &Path) -> Result<()> {
    if frame.frame as usize != frames.len() {
        let what = format!("frame {} of `{}` is out of order", frame.frame, flight.trajectory_id);
        return Err(damaged(path, &what, format!("frame {} was expected", frames.len())));
    }
    frames.push(frame);
    Ok(())
}

fn end(open: Option<(&PublishedFlight, Vec<FrameRow>)>, visit: Visit<'_>) -> Result<()> {
    match open {
        Some((flight, frames)) if frames.len() == flight.frames => visit(flight, frames),
        Some((flight, frames)) => Err(incomplete(flight, frames.len())),
        None => Ok(()),
    }
}

fn incomplete(flight: &PublishedFlight, rows: usize) -> Box<Diagnostic> {
    let (id, frames) = (&flight.trajectory_id, flight.frames);
    let message = format!("table `frames` has {rows} rows of `{id}` together; the trajectory has {frames} frames");
    Diagnostic::new("dataset-damaged", Fault::Input, message)
        .hint("`cosfly verify` lists everything that is wrong with a dataset")
}

impl FrameRow {
    /// Reads a row of table `frames`.
    ///
    /// # Errors
    /// A missing column, or a row without a value.
    pub fn read(rows: &Rows<'_>, row: usize) -> Result<Self> {
        let pose = Pose {
            position_in_world: DVec3::new(
                rows.get(Frames::drone_x_m, row)?,
                rows.get(Frames::drone_y_m, row)?,
                rows.get(Frames::drone_z_m, row)?,
            ),
            pitch_rad: rows.get(Frames::drone_pitch_deg, row)?.to_radians(),
            yaw_rad: rows.get(Frames::drone_yaw_deg, row)?.to_radians(),
            roll_rad: rows.get(Frames::drone_roll_deg, row)?.to_radians(),
        };
        // Datasets from before the gimbal have no separate attitude of the camera.
        let mut camera_pose = if rows.has(Frames::camera_pitch_deg) {
            Pose {
                pitch_rad: rows.get(Frames::camera_pitch_deg, row)?.to_radians(),
                yaw_rad: rows.get(Frames::camera_yaw_deg, row)?.to_radians(),
                roll_rad: rows.get(Frames::camera_roll_deg, row)?.to_radians(),
                ..pose
            }
        } else {
            pose
        };
        if let Some(place) = rows.get_or(Frames::camera_in_world_m, row, None)? {
            camera_pose.position_in_world = DVec3::from_array(place);
        }
        Ok(Self {
            frame: rows.get(Frames::frame, row)?,
            time_s: rows.get(Frames::time_s, row)?,
            pose,
            camera_pose,
            target: TargetState {
                feet_in_world: DVec3::new(
                    rows.get(Frames::target_x_m, row)?,
                    rows.get(Frames::target_y_m, row)?,
                    rows.get(Frames::target_z_m, row)?,
                ),
                heading_rad: rows.get(Frames::target_heading_deg, row)?.to_radians(),
                speed_mps: rows.get(Frames::target_speed_mps, row)?,
            },
            distance_m: rows.get(Frames::distance_m, row)?,
            clearance_m: rows.get(Frames::clearance_m, row)?,
            in_view: rows.get(Frames::in_view, row)?,
            visible_by_rays: rows.get(Frames::visible_by_rays, row)?,
            visible_by_pixels: rows.get(Frames::visible_by_pixels, row)?,
            visible_by_dense_rays: rows.get_or(Frames::visible_by_dense_rays, row, None)?,
            visible_pixels: rows.get(Frames::visible_pixels, row)?,
            visible_box_px: rows.get(Frames::visible_box_px, row)?,
            full_box_px: rows.get(Frames::full_box_px, row)?,
            occluder_instance: rows.get(Frames::occluder_instance, row)?,
            look_alikes: rows.get(Frames::look_alikes, row)?,
            action_in_world: rows.get(Frames::action_in_world, row)?,
            action_in_body: rows.get(Frames::action_in_body, row)?,
            disturbance: Disturbance::read(rows, row)?,
        })
    }
}

impl Disturbance {
    fn read(rows: &Rows<'_>, row: usize) -> Result<Option<Self>> {
        let Some(expert_frame) = rows.get(Frames::expert_frame, row)? else { return Ok(None) };
        let vector = |numbers: Option<[f64; 3]>| numbers.map_or(DVec3::ZERO, DVec3::from_array);
        Ok(Some(Self {
            expert_frame,
            position: rows.get(Frames::position_event, row)?.unwrap_or(false),
            rotation: rows.get(Frames::rotation_event, row)?.unwrap_or(false),
            drone_offset_in_world: vector(rows.get(Frames::drone_offset_in_world_m, row)?),
            aim_offset_in_world: vector(rows.get(Frames::aim_offset_in_world_m, row)?),
            pitch_offset_deg: rows.get(Frames::pitch_offset_deg, row)?.unwrap_or(0.0),
            yaw_offset_deg: rows.get(Frames::yaw_offset_deg, row)?.unwrap_or(0.0),
        }))
    }
}
