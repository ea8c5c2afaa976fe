//! Table `trajectories`: one row per flight, with its certificate, weather, camera and log.

use super::frames::{ROLES, role_cell};
use super::windows::{self, DIFFICULTIES, SCENES};
use super::{Cell, Column, DatasetItem, Kind, Table};
use crate::flight_labels;
use cosfly_metrics::WindowFeatures;
use cosfly_planner::{Certificate, Perturbation};

/// The table.
pub fn table() -> Table<DatasetItem> {
    let parts = [identity(), scene(), belonging(), weather(), camera(), target(), certificate(), solution(), log()];
    Table {
        name: "trajectories",
        doc: "One row per flight: town, weather, camera, certificate, costs, and where its log is.",
        key: &["trajectory_id"],
        rows: |_| 1,
        per_frame: false,
        rows_per_group: 10_000,
        reads_previews: false,
        reads_expert: true,
        columns: parts.into_iter().flatten().collect(),
    }
}

fn identity() -> Vec<Column<DatasetItem>> {
    vec![
        Column::new("trajectory_id", Kind::Text, "unique name of the flight", |item, _| {
            (&item.record.trajectory_id).into()
        }),
        Column::new(
            "flight_id",
            Kind::Text,
            "what is flown: rows with the same one show the same poses, target and ids in different weathers",
            |item, _| (&item.record.flight_id).into(),
        ),
        Column::new("role", Kind::Label(&ROLES), "expert or perturbed", |item, _| role_cell(item.record.role)),
        Column::optional("expert_id", Kind::Text, "the expert of a perturbed flight; null for experts", |item, _| {
            item.record.pair.as_ref().map(|pair| &pair.expert_id).into()
        }),
        Column::new(
            "pedestrian_id",
            Kind::Text,
            "the pedestrian; all flights behind one are in the same split",
            |item, _| (&item.record.pedestrian_id).into(),
        ),
        Column::new("seed", Kind::Text, "seed of the item, decimal", |item, _| item.record.seed.to_string().into()),
        Column::new("frames", Kind::Integer, "number of frames", |item, _| item.record.len().into()),
        Column::new("dt_s", Kind::Real, "time between frames", |item, _| item.record.dt_s().into()),
        Column::new("duration_s", Kind::Real, "time of the last frame", |item, _| {
            item.record.trajectory.track.duration_s().into()
        }),
    ]
}

fn scene() -> Vec<Column<DatasetItem>> {
    vec![
        Column::new("town", Kind::Text, "name of the town", |item, _| (&item.record.town.name).into()),
        Column::new("town_geometry_blake3", Kind::Text, "BLAKE3 of the geometry, hexadecimal", |item, _| {
            (&item.record.town.geometry_digest).into()
        }),
        Column::new(
            "town_offset_m",
            Kind::Reals(3),
            "x = x_map - x_offset, y = -y_map - y_offset, z = z_map - z_offset",
            |item, _| item.record.town.origin.offset_m.into(),
        ),
        Column::optional("town_geo_reference", Kind::Text, "projection text of the map file", |item, _| {
            item.record.town.origin.geo_reference.as_ref().into()
        }),
        Column::new("synthetic_buildings", Kind::Flag, "buildings were invented, not in the map file", |item, _| {
            item.record.town.synthetic.buildings.into()
        }),
        Column::new("synthetic_trees", Kind::Flag, "trees were invented", |item, _| {
            item.record.town.synthetic.trees.into()
        }),
        Column::new("synthetic_furniture", Kind::Flag, "street furniture was invented", |item, _| {
            item.record.town.synthetic.furniture.into()
        }),
        Column::new("synthetic_notes", Kind::TextList, "what was invented, in words", |item, _| {
            item.record.town.synthetic.notes.clone().into()
        }),
    ]
}

fn belonging() -> Vec<Column<DatasetItem>> {
    vec![
        Column::new(
            "town_layout_blake3",
            Kind::Text,
            "BLAKE3 of the walkable ground's plan, the same for copies of a town with other names or buildings",
            |item, _| (&item.layout.digest).into(),
        ),
        Column::new(
            "town_layout_sketch",
            Kind::IntegerList,
            "64 numbers; the share that two towns have in common says how alike their plans are (MinHash)",
            |item, _| item.layout.sketch.clone().into(),
        ),
        Column::new("split_group", Kind::Text, "flights with the same one are in one split", |item, _| {
            (&item.membership.split_group).into()
        }),
        Column::new(
            "subset_rank",
            Kind::Real,
            "0..1, the same for all flights behind a pedestrian: those below 0.25 are a quarter of all, and part of \
             those below 0.5",
            |item, _| item.membership.subset_rank.into(),
        ),
        Column::new(
            "scene",
            Kind::Label(&SCENES),
            "seen: split `train` of this dataset has flights in the same town, by its ground plan",
            |item, _| windows::scene_cell(item),
        ),
        Column::optional(
            "difficulty",
            Kind::Label(&DIFFICULTIES),
            "median of the difficulties of its windows, see table `windows`; null without the expert",
            |item, _| {
                let mut all: Vec<_> = windows::all_features(item).iter().map(|it| it.difficulty()).collect();
                all.sort_unstable();
                all.get(all.len() / 2).map_or(Cell::Null, |median| windows::difficulty_cell(*median))
            },
        ),
        Column::optional("mean_turn_deg", Kind::Real, "mean of the windows' `turn_deg`", |item, _| {
            mean_of_windows(item, |it| it.turn_deg)
        }),
        Column::optional("mean_height_change_m", Kind::Real, "mean of the windows' `height_change_m`", |item, _| {
            mean_of_windows(item, |it| it.height_change_m)
        }),
        Column::optional("mean_occluded_share", Kind::Real, "mean of the windows' `occluded_share`", |item, _| {
            mean_of_windows(item, |it| it.occluded_share)
        }),
        Column::optional("mean_speed_mps", Kind::Real, "mean of the windows' `speed_mps`", |item, _| {
            mean_of_windows(item, |it| it.speed_mps)
        }),
    ]
}

fn mean_of_windows(item: &DatasetItem, feature: fn(&WindowFeatures) -> f64) -> Cell {
    let all = windows::all_features(item);
    (!all.is_empty()).then(|| all.iter().map(feature).sum::<f64>() / all.len() as f64).into()
}

fn weather() -> Vec<Column<DatasetItem>> {
    vec![
        Column::new("weather_preset", Kind::Text, "CARLA preset that the numbers start from", |item, _| {
            (&item.record.weather.name).into()
        }),
        Column::new("weather_cloudiness", Kind::Real, "CARLA's number, percent", |item, _| {
            item.record.weather.cloudiness.into()
        }),
        Column::new("weather_precipitation", Kind::Real, "CARLA's number, percent", |item, _| {
            item.record.weather.precipitation.into()
        }),
        Column::new("weather_precipitation_deposits", Kind::Real, "CARLA's number, percent", |item, _| {
            item.record.weather.precipitation_deposits.into()
        }),
        Column::new("weather_wind_intensity", Kind::Real, "CARLA's number, percent", |item, _| {
            item.record.weather.wind_intensity.into()
        }),
        Column::new(
            "weather_sun_azimuth_angle",
            Kind::Real,
            "direction towards the sun, measured as yaw (0 at +x, positive towards y), degrees",
            |item, _| item.record.weather.sun_azimuth_angle.into(),
        ),
        Column::new("weather_sun_altitude_angle", Kind::Real, "CARLA's number, degrees", |item, _| {
            item.record.weather.sun_altitude_angle.into()
        }),
        Column::new("weather_fog_density", Kind::Real, "CARLA's number, percent", |item, _| {
            item.record.weather.fog_density.into()
        }),
        Column::new("weather_fog_distance", Kind::Real, "CARLA's number, metres", |item, _| {
            item.record.weather.fog_distance.into()
        }),
        Column::new("weather_fog_falloff", Kind::Real, "CARLA's number, per metre of height, CARLA", |item, _| {
            item.record.weather.fog_falloff.into()
        }),
        Column::new("weather_wetness", Kind::Real, "CARLA's number, percent", |item, _| {
            item.record.weather.wetness.into()
        }),
        Column::new("weather_scattering_intensity", Kind::Real, "CARLA's number, CARLA", |item, _| {
            item.record.weather.scattering_intensity.into()
        }),
        Column::new("weather_mie_scattering_scale", Kind::Real, "CARLA's number, CARLA", |item, _| {
            item.record.weather.mie_scattering_scale.into()
        }),
        Column::new("weather_rayleigh_scattering_scale", Kind::Real, "CARLA's number, CARLA", |item, _| {
            item.record.weather.rayleigh_scattering_scale.into()
        }),
        Column::new("weather_dust_storm", Kind::Real, "CARLA's number, percent", |item, _| {
            item.record.weather.dust_storm.into()
        }),
    ]
}

fn camera() -> Vec<Column<DatasetItem>> {
    vec![
        Column::new("camera_width_px", Kind::Integer, "image width", |item, _| item.record.camera.width.into()),
        Column::new("camera_height_px", Kind::Integer, "image height", |item, _| item.record.camera.height.into()),
        Column::new("camera_fov_deg", Kind::Real, "horizontal field of view", |item, _| {
            item.record.camera.horizontal_fov_rad.to_degrees().into()
        }),
        Column::new("camera_focal_px", Kind::Real, "focal length of both axes", |item, _| {
            item.record.camera.focal_px().into()
        }),
        Column::new("camera_cx_px", Kind::Real, "optical centre from the left edge", |item, _| {
            (0.5 * f64::from(item.record.camera.width)).into()
        }),
        Column::new("camera_cy_px", Kind::Real, "optical centre from the top edge", |item, _| {
            (0.5 * f64::from(item.record.camera.height)).into()
        }),
        Column::new(
            "camera_k1",
            Kind::Real,
            "lens distortion, OpenCV's k1: r (1 + k1 r^2 + k2 r^4), r the tangent of the angle from the optical axis; field \
             of view and focal length are those without it",
            |item, _| item.record.lens.k1.into(),
        ),
        Column::new("camera_k2", Kind::Real, "OpenCV's k2", |item, _| item.record.lens.k2.into()),
        Column::new(
            "camera_mount_yaw_deg",
            Kind::Real,
            "turn of the camera against the drone around the drone's up axis, positive to the right; before the pitch",
            |item, _| item.record.mount.yaw_rad.to_degrees().into(),
        ),
        Column::new(
            "camera_mount_pitch_deg",
            Kind::Real,
            "turn of the camera against the drone, positive upwards; after the yaw",
            |item, _| item.record.mount.pitch_rad.to_degrees().into(),
        ),
        Column::new(
            "camera_shutter_s",
            Kind::Real,
            "colour is blurred over this time around `time_s`, depth and ids are of `time_s`; 0: no blur",
            |item, _| item.record.motion_blur.shutter_s.into(),
        ),
        Column::new(
            "camera_readout_s",
            Kind::Real,
            "time from the top row to the bottom row, the middle at `time_s`, in all channels; 0: all rows at once",
            |item, _| item.record.rolling_shutter.readout_s.into(),
        ),
        Column::new(
            "camera_noise_gaussian",
            Kind::Real,
            "deviation of the noise of colour, steps of 8 bits, everywhere",
            |item, _| item.record.noise.gaussian.into(),
        ),
        Column::new(
            "camera_noise_shot",
            Kind::Real,
            "the same at white, falling with the root of brightness; added in squares",
            |item, _| item.record.noise.shot.into(),
        ),
    ]
}

fn target() -> Vec<Column<DatasetItem>> {
    vec![
        Column::new("target_height_m", Kind::Real, "height of the body", |item, _| {
            item.record.trajectory.track.height_m.into()
        }),
        Column::new("target_radius_m", Kind::Real, "radius of the body seen from above", |item, _| {
            item.record.trajectory.track.radius_m.into()
        }),
        Column::new("target_length_m", Kind::Real, "way walked", |item, _| {
            item.record.trajectory.track.length_m().into()
        }),
        Column::new("mean_visible_by_pixels", Kind::Real, "mean of `frames.visible_by_pixels`", |item, _| {
            mean_visible_by_pixels(item).into()
        }),
        Column::new("frames_in_view", Kind::Integer, "frames with the target in the image", |item, _| {
            item.record.views.iter().filter(|view| view.in_view).count().into()
        }),
    ]
}

fn certificate() -> Vec<Column<DatasetItem>> {
    vec![
        Column::new(
            "certificate_holds",
            Kind::Flag,
            "all limits hold, checked against the unsimplified map",
            |item, _| certificate_of(item).holds.into(),
        ),
        Column::new("certificate_violations", Kind::TextList, "what does not hold, in words", |item, _| {
            certificate_of(item).violations.clone().into()
        }),
        Column::optional(
            "limit_clearance_m",
            Kind::Real,
            "smallest allowed distance from obstacles; null: none",
            |item, _| limit(certificate_of(item).limits.clearance_m),
        ),
        Column::optional("limit_speed_mps", Kind::Real, "largest allowed speed; null: none", |item, _| {
            limit(certificate_of(item).limits.speed_mps)
        }),
        Column::optional(
            "limit_acceleration_mps2",
            Kind::Real,
            "largest allowed acceleration; null: none",
            |item, _| limit(certificate_of(item).limits.acceleration_mps2),
        ),
        Column::optional("limit_jerk_mps3", Kind::Real, "largest allowed jerk; null: none", |item, _| {
            limit(certificate_of(item).limits.jerk_mps3)
        }),
        Column::new("mean_visibility", Kind::Real, "mean visibility by rays", |item, _| {
            certificate_of(item).mean_visibility.into()
        }),
        Column::new(
            "frames_half_visible",
            Kind::Real,
            "share of frames with visibility of at least one half",
            |item, _| certificate_of(item).frames_half_visible.into(),
        ),
        Column::new(
            "min_clearance_m",
            Kind::Real,
            "smallest distance of the swept path to an obstacle, at most 50",
            |item, _| certificate_of(item).min_clearance_m.into(),
        ),
        Column::new("max_speed_mps", Kind::Real, "largest speed", |item, _| certificate_of(item).max_speed_mps.into()),
        Column::new("max_acceleration_mps2", Kind::Real, "largest acceleration", |item, _| {
            certificate_of(item).max_acceleration_mps2.into()
        }),
        Column::new("max_jerk_mps3", Kind::Real, "largest jerk", |item, _| certificate_of(item).max_jerk_mps3.into()),
        Column::new("mean_distance_m", Kind::Real, "mean distance to the feet", |item, _| {
            certificate_of(item).mean_distance_m.into()
        }),
        Column::new(
            "mean_rear_angle_deg",
            Kind::Real,
            "mean angle from straight behind the target, horizontal; frames in which it stands are left out",
            |item, _| certificate_of(item).mean_rear_angle_deg.into(),
        ),
        Column::new("length_m", Kind::Real, "path length of the drone", |item, _| certificate_of(item).length_m.into()),
        Column::new("length_ratio", Kind::Real, "path length divided by the target's; 0 when it stands", |item, _| {
            certificate_of(item).length_ratio.into()
        }),
    ]
}

fn solution() -> Vec<Column<DatasetItem>> {
    vec![
        Column::new(
            "iterations",
            Kind::Integer,
            "steps of refinement or descent and of corridor smoothing; 0 for perturbed flights",
            |item, _| certificate_of(item).iterations.into(),
        ),
        Column::new(
            "lattice_visibility",
            Kind::Real,
            "mean visibility of the lattice's cheapest way, from which the flight was refined; 0 without a lattice",
            |item, _| certificate_of(item).lattice_visibility.into(),
        ),
        Column::new(
            "visibility_regret",
            Kind::Real,
            "how much less the flight sees than the lattice's way; 0 when as much or more",
            |item, _| certificate_of(item).visibility_regret.into(),
        ),
        Column::new(
            "attempts",
            Kind::Integer,
            "lattices tried, from the fast one to finer and calmer ones",
            |item, _| certificate_of(item).attempts.into(),
        ),
        Column::new("searches", Kind::Integer, "searches through the last lattice", |item, _| {
            certificate_of(item).searches.into()
        }),
        Column::new(
            "occlusion_ordered_s",
            Kind::Real,
            "for how long the target was to be lost on purpose, seconds",
            |item, _| certificate_of(item).occlusion_ordered_s.into(),
        ),
        Column::new("occlusion_reached_s", Kind::Real, "for how long of that it was lost, seconds", |item, _| {
            certificate_of(item).occlusion_reached_s.into()
        }),
        Column::new("filtered_boxes", Kind::Integer, "obstacle boxes left by the per-path filter", |item, _| {
            certificate_of(item).filtered_boxes.into()
        }),
        Column::new("term_names", Kind::TextList, "planner terms; empty for perturbed flights", |item, _| {
            Cell::Texts(flight_labels::costs(&item.record.trajectory).map(|term| term.name.clone()).collect())
        }),
        Column::new("term_weights", Kind::RealList, "their weights; empty for perturbed flights", |item, _| {
            Cell::Reals(flight_labels::costs(&item.record.trajectory).map(|term| term.weight).collect())
        }),
        Column::new(
            "term_sums",
            Kind::RealList,
            "their unweighted costs over all frames; empty for perturbed flights",
            |item, _| Cell::Reals(flight_labels::costs(&item.record.trajectory).map(|term| term.sum).collect()),
        ),
        Column::new(
            "label_names",
            Kind::TextList,
            "labels that plugins gave to the frames, see `frames.labels`; empty where none did",
            |item, _| {
                Cell::Texts(flight_labels::labels(&item.record.trajectory).map(|it| it.name.to_owned()).collect())
            },
        ),
        Column::new("label_plugins", Kind::TextList, "the plugin that gave each label, and its version", |item, _| {
            let plugins = flight_labels::labels(&item.record.trajectory);
            Cell::Texts(plugins.map(|it| format!("{} {}", it.plugin, it.version)).collect())
        }),
        Column::new(
            "convergence",
            Kind::RealList,
            "total cost against the planning boxes before and after refinement (preset `paper`: after each iteration of \
             descent) and of the published flight; empty for baselines and perturbed flights",
            |item, _| item.record.trajectory.convergence.clone().into(),
        ),
        Column::optional(
            "position_probability",
            Kind::Real,
            "of the position event per frame; null for experts",
            |item, _| perturbation(item).map(|it| it.position_probability).into(),
        ),
        Column::optional(
            "rotation_probability",
            Kind::Real,
            "of the rotation event per frame; null for experts",
            |item, _| perturbation(item).map(|it| it.rotation_probability).into(),
        ),
    ]
}

fn log() -> Vec<Column<DatasetItem>> {
    vec![
        Column::new("mcap_path", Kind::Text, "the flight's log, from the dataset's folder", |item, _| {
            (&item.mcap_path).into()
        }),
        Column::new("mcap_bytes", Kind::Integer, "its size", |item, _| item.log.bytes.into()),
        Column::new("mcap_sha256", Kind::Text, "its SHA-256, hexadecimal", |item, _| (&item.log.sha256).into()),
        Column::new("mcap_messages", Kind::Integer, "its number of messages", |item, _| item.log.messages.into()),
    ]
}

fn certificate_of(item: &DatasetItem) -> &Certificate {
    &item.record.trajectory.certificate
}

/// A limit as a cell; infinite limits are none.
fn limit(value: f64) -> Cell {
    value.is_finite().then_some(value).into()
}

fn perturbation(item: &DatasetItem) -> Option<&Perturbation> {
    item.record.trajectory.perturbation.as_ref()
}

fn mean_visible_by_pixels(item: &DatasetItem) -> f64 {
    let views = &item.record.views;
    views.iter().map(|view| view.visible_by_pixels).sum::<f64>() / views.len().max(1) as f64
}
