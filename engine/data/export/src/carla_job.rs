//! The job file with which `plugins/carla/replay.py` flies published flights through a CARLA server again.

use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_domain::Lens;
use cosfly_fingerprint::Digest;
use cosfly_frames::DVec3;
use cosfly_read::{FrameRow, PublishedDataset, PublishedFlight};
use serde::Serialize;
use std::collections::BTreeMap;
use std::io::Write;

/// Version of the file, raised when older scripts would misread newer jobs.
const VERSION: u32 = 1;

/// Writes a job over `flights` of `dataset` to `out`, one flight at a time. Lengths in metres, angles in degrees, all in the
/// frame of CARLA's own world. `ignored_m` is the `<offset>` of the map's header, map frame: a server does not add it.
///
/// # Errors
/// `carla-lens` for a flight with a lens that CARLA lacks, before anything is written; damage of the dataset; a full disk.
pub fn write(
    dataset: &PublishedDataset,
    flights: &[&PublishedFlight],
    ignored_m: DVec3,
    out: &mut dyn Write,
) -> Result<()> {
    flights.iter().try_for_each(|flight| check_lens(flight))?;
    let failed = |error: std::io::Error| Diagnostic::io("write the job", &error);
    let index = dataset.row_index("frames")?;
    write!(out, "{{\"format\":\"cosfly-carla-job\",\"version\":{VERSION},\"flights\":[").map_err(failed)?;
    for (number, flight) in flights.iter().enumerate() {
        let flight = JobFlight::new(flight, ignored_m, &dataset.frames(&index, flight)?);
        let text = serde_json::to_string(&flight).expect("a job is plain JSON");
        let comma = if number > 0 { "," } else { "" };
        write!(out, "{comma}{text}").map_err(failed)?;
    }
    writeln!(out, "]}}").map_err(failed)
}

fn check_lens(flight: &PublishedFlight) -> Result<()> {
    if flight.lens.is_none() {
        return Ok(());
    }
    let Lens { model, k1, k2, .. } = flight.lens;
    let message = format!("the lens of `{}` is bent (`{}`, k1 = {k1}, k2 = {k2})", flight.trajectory_id, model.name());
    Err(Diagnostic::new("carla-lens", Fault::Recipe, message)
        .hint("CARLA's lens is bent by another formula; render the flights without `lens`"))
}

/// One flight.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct JobFlight {
    trajectory_id: String,
    /// CARLA's map.
    town: String,
    /// Path of the log whose pictures are replaced, from the dataset's folder.
    log: String,
    dt_s: f64,
    camera: JobCamera,
    weather_preset: String,
    /// Attributes of `carla.WeatherParameters`.
    weather: BTreeMap<String, f64>,
    target: JobTarget,
    frames: Vec<JobFrame>,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
struct JobCamera {
    width_px: u32,
    height_px: u32,
    fov_deg: f64,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
struct JobTarget {
    height_m: f64,
    radius_m: f64,
    /// Number of a walker of the server, modulo their count: drawn from the pedestrian's id, so that twins look alike.
    walker: u32,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
struct JobFrame {
    /// x, y, z, pitch, yaw, roll of the camera.
    camera: [f64; 6],
    /// x, y, z of the ground between the feet, heading as yaw, speed in m/s.
    target: [f64; 5],
}

impl JobFlight {
    fn new(flight: &PublishedFlight, ignored_m: DVec3, frames: &[FrameRow]) -> Self {
        let ignored_m = DVec3::new(ignored_m.x, -ignored_m.y, ignored_m.z);
        let (camera, offset) = (&flight.camera, flight.town_offset_m - ignored_m);
        let walker = Digest::of(flight.pedestrian_id.as_bytes()).0;
        Self {
            trajectory_id: flight.trajectory_id.clone(),
            town: flight.town.clone(),
            log: flight.mcap_path.clone(),
            dt_s: flight.dt_s,
            camera: JobCamera {
                width_px: camera.width,
                height_px: camera.height,
                fov_deg: camera.horizontal_fov_rad.to_degrees(),
            },
            weather_preset: flight.weather.clone(),
            weather: (*flight.weather_numbers).clone(),
            target: JobTarget {
                height_m: flight.target_height_m,
                radius_m: flight.target_radius_m,
                walker: u32::from_le_bytes([walker[0], walker[1], walker[2], 0]),
            },
            frames: frames.iter().map(|frame| JobFrame::new(frame, offset)).collect(),
        }
    }
}

impl JobFrame {
    /// Our world lies `offset` away from CARLA's, whose x and -y are those of the map file.
    fn new(frame: &FrameRow, offset: DVec3) -> Self {
        let (pose, target) = (&frame.camera_pose, &frame.target);
        let (place, feet) = (pose.position_in_world + offset, target.feet_in_world + offset);
        let angles = [pose.pitch_rad, pose.yaw_rad, pose.roll_rad].map(f64::to_degrees);
        Self {
            camera: [place.x, place.y, place.z, angles[0], angles[1], angles[2]],
            target: [feet.x, feet.y, feet.z, target.heading_rad.to_degrees(), target.speed_mps],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_sample as sample;
    use cosfly_schema::{DatasetConfig, EncodingConfig};

    fn published() -> (tempfile::TempDir, PublishedDataset) {
        let folder = tempfile::tempdir().unwrap();
        sample::write_to_folder(folder.path(), &DatasetConfig::default(), EncodingConfig::default()).unwrap();
        let dataset = PublishedDataset::open(folder.path()).unwrap();
        (folder, dataset)
    }

    #[test]
    fn a_job_holds_poses_weather_and_camera_of_every_flight() {
        let (_folder, dataset) = published();
        let flights: Vec<_> = dataset.flights().iter().collect();
        let mut text = vec![];
        write(&dataset, &flights, DVec3::ZERO, &mut text).unwrap();
        let job: serde_json::Value = serde_json::from_slice(&text).unwrap();
        assert_eq!((job["format"].as_str(), job["version"].as_u64()), (Some("cosfly-carla-job"), Some(1)));
        let flights = job["flights"].as_array().unwrap();
        assert_eq!(flights.len(), 4);
        let given = sample::flight(0, cosfly_schema::Role::Expert).record;
        let first = flights.iter().find(|flight| flight["trajectory_id"] == given.trajectory_id.as_str()).unwrap();
        assert_eq!((first["weather"].as_object().unwrap().len(), &first["weather"]["fog_density"]), (14, &2.0.into()));
        assert_eq!(first["frames"].as_array().unwrap().len(), given.len());
        let pose = &given.trajectory.poses_in_world[3];
        let bent = PublishedFlight { lens: Lens::brown(0.1, 0.0), ..dataset.flights()[0].clone() };
        assert_eq!(write(&dataset, &[&bent], DVec3::ZERO, &mut vec![]).unwrap_err().code, "carla-lens");
        let camera = &first["frames"][3]["camera"];
        assert_eq!(camera[1].as_f64(), Some(pose.position_in_world.y));
        assert!((camera[4].as_f64().unwrap() - pose.yaw_rad.to_degrees()).abs() < 1e-9);
        let twins: Vec<_> = flights.iter().filter(|it| it["log"].as_str().unwrap().contains("p00000")).collect();
        assert!(twins.len() == 2 && twins[0]["target"] == twins[1]["target"]);
    }

    #[test]
    fn an_offset_of_the_header_that_a_server_ignores_is_left_out() {
        let (_folder, dataset) = published();
        let flight = &dataset.flights()[0];
        let frames = dataset.frames(&dataset.row_index("frames").unwrap(), flight).unwrap();
        let camera = |ignored_m: DVec3| JobFlight::new(flight, ignored_m, &frames).frames[0].camera;
        let (with, without) = (camera(DVec3::ZERO), camera(DVec3::new(300.0, 500.0, 7.0)));
        let moved = [0, 1, 2].map(|axis| (without[axis] - with[axis]).round());
        assert_eq!(moved, [-300.0, 500.0, -7.0]);
    }

    #[test]
    fn the_offset_of_the_town_is_taken_back() {
        let (_folder, dataset) = published();
        let frame = FrameRow {
            camera_pose: cosfly_frames::Pose::looking_at(DVec3::new(1.0, 2.0, 30.0), DVec3::ZERO),
            target: cosfly_frames::TargetState { feet_in_world: DVec3::ZERO, heading_rad: 0.0, speed_mps: 1.0 },
            ..dataset.frames(&dataset.row_index("frames").unwrap(), &dataset.flights()[0]).unwrap().remove(0)
        };
        let job = JobFrame::new(&frame, DVec3::new(100.0, -50.0, 5.0));
        assert_eq!(
            (job.camera[..3].to_vec(), job.target[..3].to_vec()),
            (vec![101.0, -48.0, 35.0], vec![100.0, -50.0, 5.0])
        );
    }
}
