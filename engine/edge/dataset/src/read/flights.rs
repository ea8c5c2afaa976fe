//! The flights of a published dataset and what its tables say of their frames.

use super::columns::{self, Rows};
use super::log::LogReader;
use crate::splits::TownLayout;
use cosfly_diagnose::{Diagnostic, Fault, Result, nearest_name};
use cosfly_frames::{DVec3, Pose, TargetState};
use cosfly_render::Camera;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Component, Path, PathBuf};

/// Ids that an error lists at most.
const LISTED: usize = 8;

/// A published dataset whose table of flights has been read.
#[derive(Clone, Debug)]
pub struct PublishedDataset {
    folder: PathBuf,
    flights: Vec<PublishedFlight>,
}

/// A row of table `trajectories`.
#[derive(Clone, Debug, PartialEq)]
pub struct PublishedFlight {
    /// Unique in the dataset.
    pub trajectory_id: String,
    /// The expert of a perturbed flight.
    pub expert_id: Option<String>,
    /// Whom it follows.
    pub pedestrian_id: String,
    /// Name of the town.
    pub town: String,
    /// Digest of the town's geometry; towns with the same one are the same place. Empty when it is not told.
    pub town_geometry: String,
    /// Its ground plan; without a sketch, and with the geometry's digest, in datasets from before the column was there.
    pub town_layout: TownLayout,
    /// Flights with the same one must stay in one split; empty when it is not told.
    pub split_group: String,
    /// `x = x_map - x_offset`, `y = -y_map - y_offset`, `z = z_map - z_offset`, metres.
    pub town_offset_m: DVec3,
    /// Name of the weather preset.
    pub weather: String,
    /// CARLA's weather numbers by their names.
    pub weather_numbers: BTreeMap<String, f64>,
    /// Number of frames.
    pub frames: usize,
    /// Time between frames, seconds.
    pub dt_s: f64,
    /// The camera of all frames, without what its lens bends.
    pub camera: Camera,
    /// OpenCV's k1 and k2 of the lens.
    pub lens_k: [f64; 2],
    /// Height of the body, metres.
    pub target_height_m: f64,
    /// Radius of the body, metres.
    pub target_radius_m: f64,
    /// Its log, from the dataset's folder.
    pub mcap_path: String,
    /// Name of its split.
    pub split: String,
}

/// A row of table `frames`.
#[derive(Clone, Debug, PartialEq)]
pub struct PublishedFrame {
    /// Pose of the drone in the world.
    pub pose: Pose,
    /// Pose of the camera, which is in the same place and may be turned against the drone.
    pub camera_pose: Pose,
    /// The target.
    pub target: TargetState,
    /// Share of body points reached by rays, 0..=1.
    pub visible_by_rays: f64,
    /// Visible pixels / pixels without obstacles, 0..=1.
    pub visible_by_pixels: f64,
    /// From the drone to the nearest obstacle, metres.
    pub clearance_m: f64,
    /// Edges around the visible pixels: left, top, right, bottom.
    pub visible_box_px: Option<[f32; 4]>,
    /// The same without obstacles.
    pub full_box_px: Option<[f32; 4]>,
}

impl PublishedDataset {
    /// Opens the dataset in `folder`; its flights are in the order of its splits and tables.
    ///
    /// # Errors
    /// `dataset-none` where there is no dataset, otherwise what is wrong with its files.
    pub fn open(folder: &Path) -> Result<Self> {
        let tables = folder.join("data/trajectories");
        if !tables.is_dir() {
            return Err(no_dataset(folder));
        }
        let mut flights = vec![];
        for (split, path) in table_files(&tables)? {
            let wanted = |name: &str| FLIGHT_COLUMNS.contains(&name) || name.starts_with(WEATHER);
            columns::read(&path, &wanted, &mut |rows| {
                for row in 0..rows.len() {
                    flights.push(PublishedFlight::read(rows, row, &split)?);
                }
                Ok(())
            })?;
        }
        if flights.is_empty() {
            return Err(no_dataset(folder));
        }
        Ok(Self { folder: folder.to_owned(), flights })
    }

    /// Where it is.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// All flights.
    pub fn flights(&self) -> &[PublishedFlight] {
        &self.flights
    }

    /// Items without a flight, with their reasons.
    ///
    /// # Errors
    /// What is wrong with table `rejected`.
    pub fn rejections(&self) -> Result<BTreeMap<String, String>> {
        let tables = self.folder.join("data/rejected");
        let mut found = BTreeMap::new();
        if !tables.is_dir() {
            return Ok(found);
        }
        for (_, path) in table_files(&tables)? {
            columns::read(&path, &|name| ["trajectory_id", "reason"].contains(&name), &mut |rows| {
                for row in 0..rows.len() {
                    let id = rows.text_at("trajectory_id", row)?.to_owned();
                    found.insert(id, rows.text_or("reason", row, "")?);
                }
                Ok(())
            })?;
        }
        Ok(found)
    }

    /// The flight called `id`.
    ///
    /// # Errors
    /// `dataset-no-flight`, which names the nearest ids.
    pub fn flight(&self, id: &str) -> Result<&PublishedFlight> {
        self.flights.iter().find(|flight| flight.trajectory_id == id).ok_or_else(|| {
            let message = format!("`{}` has no trajectory `{id}`", self.folder.display());
            let refusal = Diagnostic::new("dataset-no-flight", Fault::Recipe, message);
            let ids: Vec<&str> = self.flights.iter().map(|flight| flight.trajectory_id.as_str()).collect();
            let refusal = match nearest_name(id, ids.iter().copied()) {
                Some(near) => refusal.hint(format!("did you mean `{near}`?")),
                None => refusal,
            };
            let shown: Vec<String> = ids.iter().take(LISTED).map(|id| format!("`{id}`")).collect();
            let more = if ids.len() > LISTED { format!(" and {} more", ids.len() - LISTED) } else { String::new() };
            refusal.hint(format!("its trajectories are {}{more}", shown.join(", ")))
        })
    }

    /// An expert and its perturbed twins, whichever of them `flight` is; the expert first.
    pub fn family<'a>(&'a self, flight: &'a PublishedFlight) -> Vec<&'a PublishedFlight> {
        let expert = flight.expert_id.as_deref().unwrap_or(&flight.trajectory_id);
        let mut family: Vec<_> = self.flights.iter().filter(|it| it.trajectory_id == expert).collect();
        family.extend(self.flights.iter().filter(|it| it.expert_id.as_deref() == Some(expert)));
        family
    }

    /// How many others the pictures of some flights show, each counted once a flight.
    pub fn others_seen(&self, flights: &[&PublishedFlight]) -> Result<usize> {
        let folder = self.folder.join("data/people");
        let mut seen = BTreeSet::new();
        for (_, path) in if folder.is_dir() { table_files(&folder)? } else { vec![] } {
            columns::read(&path, &|name| ["trajectory_id", "instance"].contains(&name), &mut |rows| {
                for row in 0..rows.len() {
                    let id = rows.text("trajectory_id", row)?;
                    if let Some(flight) = flights.iter().position(|it| Some(&it.trajectory_id) == id.as_ref()) {
                        seen.insert((flight, rows.count("instance", row)?));
                    }
                }
                Ok(())
            })?;
        }
        Ok(seen.len())
    }

    /// The log of `flight`.
    pub fn log(&self, flight: &PublishedFlight) -> Result<LogReader> {
        let inside = Path::new(&flight.mcap_path).components().all(|part| matches!(part, Component::Normal(_)));
        if !inside {
            let message = format!("the log `{}` lies outside of the dataset", flight.mcap_path);
            return Err(Diagnostic::new("dataset-damaged", Fault::Input, message));
        }
        LogReader::open(&self.folder.join(&flight.mcap_path), flight.dt_s)
    }

    /// All frames of `flight`, in order.
    pub fn frames(&self, flight: &PublishedFlight) -> Result<Vec<PublishedFrame>> {
        let mut frames: BTreeMap<u32, PublishedFrame> = BTreeMap::new();
        for (split, path) in table_files(&self.folder.join("data/frames"))? {
            if split != flight.split {
                continue;
            }
            columns::read(&path, &|name| FRAME_COLUMNS.contains(&name), &mut |rows| {
                for row in 0..rows.len() {
                    if rows.text("trajectory_id", row)?.as_deref() == Some(&flight.trajectory_id) {
                        frames.insert(rows.count("frame", row)?, PublishedFrame::read(rows, row)?);
                    }
                }
                Ok(())
            })?;
        }
        let complete = frames.len() == flight.frames && frames.keys().zip(0..).all(|(found, number)| *found == number);
        if !complete {
            let message = format!(
                "table `frames` has {} rows of `{}`; it has {} frames",
                frames.len(),
                flight.trajectory_id,
                flight.frames
            );
            return Err(Diagnostic::new("dataset-damaged", Fault::Input, message));
        }
        Ok(frames.into_values().collect())
    }
}

fn no_dataset(folder: &Path) -> Box<Diagnostic> {
    let (shown, is_file) = (folder.display(), folder.is_file());
    let message = match (folder.exists(), is_file) {
        (false, _) => format!("`{shown}` does not exist"),
        (true, true) => format!("`{shown}` is a file, not the folder of a dataset"),
        (true, false) => format!("`{shown}` is not a published dataset: it has no table of flights"),
    };
    let refusal = Diagnostic::new("dataset-none", Fault::Input, message);
    match folder.extension().and_then(|extension| extension.to_str()) {
        Some("toml") => refusal.hint("run the recipe first, then give the folder that it printed, such as `out/small`"),
        _ => refusal.hint("give the folder that `cosfly run` delivered, such as `out/carla_town`"),
    }
}

/// Parquet files of a table with the names of their splits, in the order of train, val, test.
pub(super) fn table_files(folder: &Path) -> Result<Vec<(String, PathBuf)>> {
    let refused = |error: std::io::Error| Diagnostic::io(format!("read `{}`", folder.display()), &error);
    let mut files = vec![];
    for entry in std::fs::read_dir(folder).map_err(refused)? {
        let path = entry.map_err(refused)?.path();
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        if let (Some((split, _)), true) = (name.split_once('-'), name.ends_with(".parquet")) {
            let place = crate::publish::Split::ALL.iter().position(|it| it.name() == split).unwrap_or(usize::MAX);
            files.push((place, split.to_owned(), path));
        }
    }
    files.sort();
    Ok(files.into_iter().map(|(_, split, path)| (split, path)).collect())
}

/// What names of weather columns begin with.
const WEATHER: &str = "weather_";
const FLIGHT_COLUMNS: [&str; 19] = [
    "trajectory_id",
    "expert_id",
    "pedestrian_id",
    "town",
    "town_geometry_blake3",
    "town_layout_blake3",
    "town_layout_sketch",
    "split_group",
    "town_offset_m",
    "frames",
    "dt_s",
    "camera_width_px",
    "camera_height_px",
    "camera_fov_deg",
    "camera_k1",
    "camera_k2",
    "target_height_m",
    "target_radius_m",
    "mcap_path",
];
pub(super) const FRAME_COLUMNS: [&str; 21] = [
    "trajectory_id",
    "frame",
    "drone_x_m",
    "drone_y_m",
    "drone_z_m",
    "drone_pitch_deg",
    "drone_yaw_deg",
    "drone_roll_deg",
    "camera_pitch_deg",
    "camera_yaw_deg",
    "camera_roll_deg",
    "target_x_m",
    "target_y_m",
    "target_z_m",
    "target_heading_deg",
    "target_speed_mps",
    "visible_by_rays",
    "visible_by_pixels",
    "clearance_m",
    "visible_box_px",
    "full_box_px",
];

impl PublishedFlight {
    fn layout(rows: &Rows<'_>, row: usize) -> Result<TownLayout> {
        let geometry = rows.text_or("town_geometry_blake3", row, "")?;
        let known = if geometry.is_empty() { rows.text_or("town", row, "")? } else { geometry };
        let digest = rows.text_or("town_layout_blake3", row, &known)?;
        Ok(TownLayout { digest, sketch: rows.integers_or_none("town_layout_sketch", row)? })
    }

    fn read(rows: &Rows<'_>, row: usize, split: &str) -> Result<Self> {
        let text = |name: &str| Ok::<_, Box<Diagnostic>>(rows.text(name, row)?.unwrap_or_default());
        let mut weather_numbers = BTreeMap::new();
        for column in rows.names() {
            if let Some(name) = column.strip_prefix(WEATHER).filter(|name| *name != "preset")
                && let Ok(value) = rows.real(&column, row)
            {
                weather_numbers.insert(name.to_owned(), value);
            }
        }
        Ok(Self {
            trajectory_id: text("trajectory_id")?,
            expert_id: rows.text("expert_id", row)?.filter(|id| !id.is_empty()),
            pedestrian_id: text("pedestrian_id")?,
            town: text("town")?,
            town_geometry: rows.text_or("town_geometry_blake3", row, "")?,
            town_layout: Self::layout(rows, row)?,
            split_group: rows.text_or("split_group", row, "")?,
            town_offset_m: DVec3::from_array(rows.vector("town_offset_m", row)?),
            weather: text("weather_preset")?,
            weather_numbers,
            frames: rows.count("frames", row)? as usize,
            dt_s: rows.real("dt_s", row)?,
            camera: Camera {
                width: rows.count("camera_width_px", row)?,
                height: rows.count("camera_height_px", row)?,
                horizontal_fov_rad: rows.real("camera_fov_deg", row)?.to_radians(),
            },
            lens_k: [rows.real_or("camera_k1", row, 0.0)?, rows.real_or("camera_k2", row, 0.0)?],
            target_height_m: rows.real("target_height_m", row)?,
            target_radius_m: rows.real("target_radius_m", row)?,
            mcap_path: text("mcap_path")?,
            split: split.to_owned(),
        })
    }
}

impl PublishedFrame {
    pub(super) fn read(rows: &Rows<'_>, row: usize) -> Result<Self> {
        let real = |name: &str| rows.real(name, row);
        let pose = Pose {
            position_in_world: DVec3::new(real("drone_x_m")?, real("drone_y_m")?, real("drone_z_m")?),
            pitch_rad: real("drone_pitch_deg")?.to_radians(),
            yaw_rad: real("drone_yaw_deg")?.to_radians(),
            roll_rad: real("drone_roll_deg")?.to_radians(),
        };
        let of_camera = |name: &str, drone_rad: f64| {
            let degrees = rows.real_or(name, row, drone_rad.to_degrees());
            degrees.map(f64::to_radians)
        };
        let camera_pose = Pose {
            pitch_rad: of_camera("camera_pitch_deg", pose.pitch_rad)?,
            yaw_rad: of_camera("camera_yaw_deg", pose.yaw_rad)?,
            roll_rad: of_camera("camera_roll_deg", pose.roll_rad)?,
            ..pose
        };
        Ok(Self {
            pose,
            camera_pose,
            target: TargetState {
                feet_in_world: DVec3::new(real("target_x_m")?, real("target_y_m")?, real("target_z_m")?),
                heading_rad: real("target_heading_deg")?.to_radians(),
                speed_mps: real("target_speed_mps")?,
            },
            visible_by_rays: real("visible_by_rays")?,
            visible_by_pixels: real("visible_by_pixels")?,
            clearance_m: real("clearance_m")?,
            visible_box_px: rows.edges("visible_box_px", row)?,
            full_box_px: rows.edges("full_box_px", row)?,
        })
    }
}
