//! A row of table `trajectories`.

use super::rows::Rows;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_domain::{Camera, Lens, LensModel, Mount};
use cosfly_frames::DVec3;
use cosfly_schema::TownLayout;
use cosfly_schema::log::FrameTimes;
use cosfly_schema::tables::{Trajectories, WEATHER_NUMBERS};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// A published trajectory.
#[derive(Clone, Debug, PartialEq)]
pub struct PublishedFlight {
    /// Id, unique in the dataset.
    pub trajectory_id: String,
    /// Name of the flight, the same for all weathers of a paired rendering, and for all cameras.
    pub flight_id: String,
    /// Expert of a perturbed trajectory.
    pub expert_id: Option<String>,
    /// Pedestrian who is followed.
    pub pedestrian_id: String,
    /// Name of the town.
    pub town: String,
    /// Digest of the town's geometry, equal for equal towns. Empty in datasets from before the column existed.
    pub town_geometry: String,
    /// Ground plan of the town; in datasets from before the column existed without a sketch and with the geometry's
    /// digest.
    pub town_layout: Arc<TownLayout>,
    /// Split group: trajectories of one group must stay in one split. Empty in datasets from before the column existed.
    pub split_group: String,
    /// Offset of the world frame in the map file, metres: `x = x_map - x_offset`, `y = -y_map - y_offset`, `z = z_map -
    /// z_offset`.
    pub town_offset_m: DVec3,
    /// Name of the weather preset.
    pub weather: String,
    /// CARLA's weather numbers by their names.
    pub weather_numbers: Arc<BTreeMap<String, f64>>,
    /// Number of frames.
    pub frames: usize,
    /// Time between frames, seconds.
    pub dt_s: f64,
    /// Time of the first frame after the beginning of the flight, nanoseconds: the offset of the camera.
    pub begins_ns: u64,
    /// Frames of the flight from one picture to the next.
    pub every: u32,
    /// Name of the camera, where several film each flight.
    pub camera_name: Option<String>,
    /// Ideal camera of all frames, without its lens.
    pub camera: Camera,
    /// Distortion of the lens.
    pub lens: Lens,
    /// Place and rotation of the camera relative to the drone.
    pub mount: Mount,
    /// Distance between the two cameras of a stereo pair, metres; `None` for a single camera.
    pub base_line_m: Option<f64>,
    /// Time from the top row to the bottom row of an image, seconds.
    pub readout_s: f64,
    /// Height of the target's body, metres.
    pub target_height_m: f64,
    /// Radius of the target's body, metres.
    pub target_radius_m: f64,
    /// Colours of the target's top and trousers in words, and whether it wears a backpack; `None` without a body, and in
    /// datasets from before the columns existed.
    pub target_clothes: Option<(String, String, bool)>,
    /// Whether the target holds an open umbrella.
    pub target_has_umbrella: bool,
    /// Kind of the followed body, `pedestrian` in datasets that do not state one; `None` where nobody is followed.
    pub target_kind: Option<String>,
    /// Limits of clearance (m), speed (m/s), acceleration (m/s^2), jerk (m/s^3), yaw and pitch rate (degrees/s); `None` where
    /// there is no limit.
    pub limits: [Option<f64>; 6],
    /// Path of the log, from the dataset's folder.
    pub mcap_path: String,
    /// Name of the split.
    pub split: String,
}

impl PublishedFlight {
    /// Reads a row of table `trajectories` of split `split`.
    ///
    /// # Errors
    /// A missing column, or a row without a value.
    pub fn read(rows: &Rows<'_>, row: usize, split: &str) -> Result<Self> {
        let mut weather_numbers = BTreeMap::new();
        for number in &WEATHER_NUMBERS {
            if rows.has(number.column) {
                weather_numbers.insert(number.name.to_owned(), rows.get(number.column, row)?);
            }
        }
        let trajectory_id = rows.get(Trajectories::trajectory_id, row)?;
        if !is_file_name(&trajectory_id) {
            let message =
                format!("the id `{trajectory_id}` of a trajectory (row {row}, split {split}) can be no name of a file");
            return Err(Diagnostic::new("dataset-damaged", Fault::Input, message)
                .hint("ids are letters, digits, `.`, `_` and `-`; somebody has changed table `trajectories`"));
        }
        let (frames, dt_s) = (rows.get(Trajectories::frames, row)? as usize, rows.get(Trajectories::dt_s, row)?);
        let filmed_s = frames.saturating_sub(1) as f64 * dt_s;
        let begins_s = rows.get_or(Trajectories::duration_s, row, filmed_s)? - filmed_s;
        Ok(Self {
            trajectory_id,
            flight_id: rows.get_or(Trajectories::flight_id, row, String::new())?,
            expert_id: rows.get(Trajectories::expert_id, row)?.filter(|id| !id.is_empty()),
            pedestrian_id: rows.get(Trajectories::pedestrian_id, row)?,
            town: rows.get(Trajectories::town, row)?,
            town_geometry: rows.get_or(Trajectories::town_geometry_blake3, row, String::new())?,
            town_layout: Arc::new(layout(rows, row)?),
            split_group: rows.get_or(Trajectories::split_group, row, String::new())?,
            town_offset_m: DVec3::from_array(rows.get(Trajectories::town_offset_m, row)?),
            weather: rows.get(Trajectories::weather_preset, row)?,
            weather_numbers: Arc::new(weather_numbers),
            frames,
            dt_s,
            begins_ns: (begins_s * 1e9).round() as u64,
            every: rows.get_or(Trajectories::camera_every, row, 1)?,
            camera_name: rows.get_or(Trajectories::camera_name, row, None)?,
            camera: Camera {
                width: rows.get(Trajectories::camera_width_px, row)?,
                height: rows.get(Trajectories::camera_height_px, row)?,
                horizontal_fov_rad: rows.get(Trajectories::camera_fov_deg, row)?.to_radians(),
            },
            lens: Lens {
                model: LensModel::called(&rows.get_or(Trajectories::camera_lens_model, row, "brown".to_owned())?)
                    .unwrap_or_default(),
                k3: rows.get_or(Trajectories::camera_k3, row, 0.0)?,
                k4: rows.get_or(Trajectories::camera_k4, row, 0.0)?,
                k1: rows.get_or(Trajectories::camera_k1, row, 0.0)?,
                k2: rows.get_or(Trajectories::camera_k2, row, 0.0)?,
            },
            base_line_m: rows.get_or(Trajectories::camera_base_line_m, row, None)?,
            mount: Mount {
                position_in_body_m: DVec3::from_array(rows.get_or(
                    Trajectories::camera_mount_position_in_body_m,
                    row,
                    [0.0; 3],
                )?),
                right_m: rows.get_or(Trajectories::camera_mount_right_m, row, 0.0)?,
                roll_rad: rows.get_or(Trajectories::camera_mount_roll_deg, row, 0.0)?.to_radians(),
                pitch_rad: rows.get_or(Trajectories::camera_mount_pitch_deg, row, 0.0)?.to_radians(),
                yaw_rad: rows.get_or(Trajectories::camera_mount_yaw_deg, row, 0.0)?.to_radians(),
                levelled: rows.get_or(Trajectories::camera_mount_levelled, row, false)?,
            },
            readout_s: rows.get_or(Trajectories::camera_readout_s, row, 0.0)?,
            target_height_m: rows.get(Trajectories::target_height_m, row)?,
            target_radius_m: rows.get(Trajectories::target_radius_m, row)?,
            target_clothes: clothes(rows, row)?,
            target_has_umbrella: rows.get_or(Trajectories::target_has_umbrella, row, None)?.unwrap_or(false),
            target_kind: rows.get_or(Trajectories::target_kind, row, Some("pedestrian".to_owned()))?,
            limits: [
                rows.get_or(Trajectories::limit_clearance_m, row, None)?,
                rows.get_or(Trajectories::limit_speed_mps, row, None)?,
                rows.get_or(Trajectories::limit_acceleration_mps2, row, None)?,
                rows.get_or(Trajectories::limit_jerk_mps3, row, None)?,
                rows.get_or(Trajectories::limit_yaw_rate_deg_s, row, None)?,
                rows.get_or(Trajectories::limit_pitch_rate_deg_s, row, None)?,
            ],
            mcap_path: rows.get(Trajectories::mcap_path, row)?,
            split: split.to_owned(),
        })
    }

    /// Times of the frames.
    pub fn times(&self) -> FrameTimes {
        FrameTimes { begins_ns: self.begins_ns, dt_s: self.dt_s }
    }
}

/// Whether an id can be part of a path inside of a folder: exports and previews name files after it.
fn is_file_name(id: &str) -> bool {
    let is_letter = |letter: char| !letter.is_control() && !matches!(letter, '/' | '\\');
    (1..=200).contains(&id.len()) && !id.starts_with('.') && id.chars().all(is_letter)
}

/// Contents that many flights have, each kept once.
#[derive(Debug, Default)]
pub struct Shared {
    layouts: BTreeSet<Arc<TownLayout>>,
    weathers: Vec<Arc<BTreeMap<String, f64>>>,
}

impl Shared {
    /// Replaces the contents of a flight by equal ones of earlier flights.
    pub fn share(&mut self, flight: &mut PublishedFlight) {
        match self.layouts.get(&flight.town_layout) {
            Some(known) => flight.town_layout = Arc::clone(known),
            None => drop(self.layouts.insert(Arc::clone(&flight.town_layout))),
        }
        match self.weathers.iter().rev().take(MOST_WEATHERS).find(|it| **it == flight.weather_numbers) {
            Some(known) => flight.weather_numbers = Arc::clone(known),
            None => self.weathers.push(Arc::clone(&flight.weather_numbers)),
        }
    }
}

/// Weathers that a flight's is compared with; datasets have some dozen.
const MOST_WEATHERS: usize = 64;

fn clothes(rows: &Rows<'_>, row: usize) -> Result<Option<(String, String, bool)>> {
    let top = rows.get_or(Trajectories::target_top_colour, row, None)?;
    let trousers = rows.get_or(Trajectories::target_trousers_colour, row, None)?;
    let backpack = rows.get_or(Trajectories::target_has_backpack, row, None)?;
    Ok(top.zip(trousers).zip(backpack).map(|((top, trousers), backpack)| (top, trousers, backpack)))
}

fn layout(rows: &Rows<'_>, row: usize) -> Result<TownLayout> {
    let geometry = rows.get_or(Trajectories::town_geometry_blake3, row, String::new())?;
    let known = if geometry.is_empty() { rows.get(Trajectories::town, row)? } else { geometry };
    Ok(TownLayout {
        digest: rows.get_or(Trajectories::town_layout_blake3, row, known)?,
        sketch: rows.get_or(Trajectories::town_layout_sketch, row, vec![])?,
    })
}

#[cfg(test)]
mod tests {
    use super::is_file_name;

    #[test]
    fn ids_that_lead_out_of_a_folder_are_none() {
        for id in ["perturbed-p00000", "perturbed-p00000.windy", "走"] {
            assert!(is_file_name(id), "{id}");
        }
        for id in ["", "..", "../x", "/tmp/x", "a/b", "a\\b", ".hidden", "a\nb"] {
            assert!(!is_file_name(id), "{id}");
        }
    }
}
