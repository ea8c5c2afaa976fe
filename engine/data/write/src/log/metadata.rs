//! The metadata records of a log: trajectory, weather, camera, conventions, labels, instances.

use crate::frame_pack::PackHeader;
use cosfly_domain::channels::instance;
use cosfly_domain::{BodyKindRow, Obstacle, SemanticLabel, TARGET_INSTANCE, Town, object_instance};
use cosfly_optics::{READOUT_KEYS, ReadoutStrips};
use cosfly_schema::log::BODIES_3D_ROWS;
use cosfly_schema::tables::kind_name;
use cosfly_schema::{DepthEncoding, OtherBody, RenderedTrajectory};
use serde::Serialize;
use serde_json::{Map, Value};
use std::collections::BTreeMap;

/// Layout of our logs; raised when channels or conventions change.
pub const LOG_VERSION: u32 = 1;

/// All records: name and entries.
pub fn records(
    record: &RenderedTrajectory,
    header: &PackHeader,
    town: &Town,
) -> Vec<(&'static str, BTreeMap<String, String>)> {
    vec![
        ("cosfly.trajectory", trajectory(record)),
        ("cosfly.weather", weather(record)),
        ("cosfly.camera", camera(record)),
        ("cosfly.conventions", conventions(header, record.lens.is_wide(&record.camera))),
        ("cosfly.semantic_labels", labels()),
        ("cosfly.instances", instances(town, record)),
    ]
}

fn entries<const N: usize>(pairs: [(&str, String); N]) -> BTreeMap<String, String> {
    pairs.into_iter().map(|(key, value)| (key.to_owned(), value)).collect()
}

fn trajectory(record: &RenderedTrajectory) -> BTreeMap<String, String> {
    let synthetic = &record.town.synthetic;
    let mut all = entries([
        ("log_version", LOG_VERSION.to_string()),
        ("trajectory_id", record.trajectory_id.clone()),
        ("flight_id", record.flight_id.clone()),
        ("role", record.role.name().into()),
        ("expert_id", record.pair.as_ref().map_or(String::new(), |pair| pair.expert_id.clone())),
        ("pedestrian_id", record.pedestrian_id.clone()),
        ("seed", record.seed.to_string()),
        ("frames", record.len().to_string()),
        ("dt_s", record.dt_s().to_string()),
        ("town", record.town.name.clone()),
        ("town_geometry_blake3", record.town.geometry_digest.clone()),
        ("town_offset_m", format!("{:?}", record.town.origin.offset_m.to_array())),
        ("town_geo_reference", record.town.origin.geo_reference.clone().unwrap_or_default()),
        ("synthetic_buildings", synthetic.buildings.to_string()),
        ("synthetic_trees", synthetic.trees.to_string()),
        ("synthetic_furniture", synthetic.furniture.to_string()),
        ("synthetic_notes", synthetic.notes.join("\n")),
    ]);
    // By this number somebody notices that the flight's boxes are missing.
    if !record.bodies_3d.is_empty() {
        all.insert(BODIES_3D_ROWS.to_owned(), record.bodies_3d.len().to_string());
    }
    all
}

/// The numbers of a noun by the names of its fields.
fn numbers(noun: &impl Serialize) -> impl Iterator<Item = (String, String)> {
    let fields = match serde_json::to_value(noun) {
        Ok(Value::Object(fields)) => fields,
        _ => Map::new(),
    };
    fields.into_iter().filter_map(|(name, value)| Some((name, value.as_f64()?.to_string())))
}

fn weather(record: &RenderedTrajectory) -> BTreeMap<String, String> {
    let mut entries: BTreeMap<String, String> =
        weather_numbers(record).into_iter().map(|(name, value)| (name.to_owned(), value.to_string())).collect();
    entries.insert("preset".into(), record.weather.name.clone());
    entries
}

/// CARLA's 14 weather numbers with their names.
pub fn weather_numbers(record: &RenderedTrajectory) -> [(&'static str, f64); 14] {
    let weather = &record.weather;
    [
        ("cloudiness", weather.cloudiness),
        ("precipitation", weather.precipitation),
        ("precipitation_deposits", weather.precipitation_deposits),
        ("wind_intensity", weather.wind_intensity),
        ("sun_azimuth_angle", weather.sun_azimuth_angle),
        ("sun_altitude_angle", weather.sun_altitude_angle),
        ("fog_density", weather.fog_density),
        ("fog_distance", weather.fog_distance),
        ("fog_falloff", weather.fog_falloff),
        ("wetness", weather.wetness),
        ("scattering_intensity", weather.scattering_intensity),
        ("mie_scattering_scale", weather.mie_scattering_scale),
        ("rayleigh_scattering_scale", weather.rayleigh_scattering_scale),
        ("dust_storm", weather.dust_storm),
    ]
}

fn camera(record: &RenderedTrajectory) -> BTreeMap<String, String> {
    let camera = &record.camera;
    let mut all = entries([
        ("width_px", camera.width.to_string()),
        ("height_px", camera.height.to_string()),
        ("horizontal_fov_deg", camera.horizontal_fov_rad.to_degrees().to_string()),
        ("focal_px", camera.focal_px().to_string()),
        ("k1", record.lens.k1.to_string()),
        ("k2", record.lens.k2.to_string()),
        ("k3", record.lens.k3.to_string()),
        ("k4", record.lens.k4.to_string()),
        ("lens_model", record.lens.model.name().into()),
        ("mount_position_in_body_m", format!("{:?}", record.mount.position_in_body_m.to_array())),
        ("mount_right_m", record.mount.right_m.to_string()),
        ("mount_roll_deg", record.mount.roll_rad.to_degrees().to_string()),
        ("mount_yaw_deg", record.mount.yaw_rad.to_degrees().to_string()),
        ("mount_pitch_deg", record.mount.pitch_rad.to_degrees().to_string()),
        ("mount_levelled", record.mount.levelled.to_string()),
        ("shutter_s", record.motion_blur.shutter_s.to_string()),
        ("readout_s", record.rolling_shutter.readout_s.to_string()),
        ("noise_gaussian", record.noise.gaussian.to_string()),
        ("noise_shot", record.noise.shot.to_string()),
    ]);
    all.extend(numbers(&record.optics));
    if !record.rolling_shutter.is_none() {
        // When each row was taken: flow and depth are of these moments.
        let strips = ReadoutStrips::of(&record.rolling_shutter, camera, &record.lens);
        let lists = [&strips.ends_px, &strips.offsets_s].map(|list| format!("{list:?}"));
        all.extend(READOUT_KEYS.map(str::to_owned).into_iter().zip(lists));
    }
    if record.begins_ns > 0 {
        all.insert("offset_s".to_owned(), record.times().s(0).to_string());
    }
    all.extend(record.camera_name.iter().map(|name| ("name".to_owned(), name.clone())));
    all
}

fn conventions(header: &PackHeader, is_wide: bool) -> BTreeMap<String, String> {
    let depth_grid = match header.encoding.depth {
        DepthEncoding::Grid => "rounded to multiples of 2^-10 m",
        DepthEncoding::Lossless => "as rendered",
    };
    let depth = if is_wide { "distance along the ray of the pixel" } else { "planar: distance along the optical axis" };
    let mut conventions = entries([
        ("time", "frame i is at i * dt_s, later by `offset_s` of the camera where it has one; time 0 is the first frame of the flight".into()),
        ("map_frame", "right-handed, metres: x = x of CARLA, y = -y of CARLA, z up".into()),
        ("drone_frame", "x ahead, y left, z up; the camera sits and looks as its mount says, along x from the origin where that is 0".into()),
        ("camera_optical_frame", "x right, y down, z ahead".into()),
        ("target_frame", "origin on the ground between the feet, x in walking direction, z up".into()),
        ("depth", format!("{depth}, metres, 32-bit float; +inf for sky")),
        ("depth_values", depth_grid.into()),
        ("semantic", "CARLA label ids of 0.9.14 and later".into()),
        ("instance", "0 ground and sky, 1 the target, object id + 2, then people; unsigned, little-endian".into()),
        ("instance_encoding", header.format_of(&instance::CHANNEL).encoding.into()),
        ("pixels", "row-major from the top-left pixel, sampled at pixel centres; through a lens, depth and ids are the nearest sample".into()),
        ("boxes", "left, top, right, bottom edges in pixels from the top-left corner of the image".into()),
    ]);
    let on_request = header.channels.iter().filter(|channel| channel.is_on_request());
    conventions.extend(on_request.map(|channel| (channel.name.to_owned(), channel.doc.to_owned())));
    conventions
}

fn labels() -> BTreeMap<String, String> {
    SemanticLabel::ALL
        .iter()
        .map(|label| {
            let [r, g, b] = label.colour();
            (format!("{:02}", label.id()), format!("{} #{r:02x}{g:02x}{b:02x}", label.name()))
        })
        .collect()
}

/// Object of each instance id: kind, CARLA label id, and corners of the space that its boxes fill, frame `map`; of
/// people, their walk and height.
fn instances(town: &Town, record: &RenderedTrajectory) -> BTreeMap<String, String> {
    let mut obstacles: Vec<&Obstacle> = town.obstacles.iter().collect();
    obstacles.sort_by_key(|obstacle| obstacle.object_id);
    let id = |instance: u32| format!("{instance:07}");
    let entry = |group: &[&Obstacle]| {
        let around = group.iter().map(|obstacle| obstacle.shape.bounds_in_world());
        let around = around.reduce(|(low, high), (a, b)| (low.min(a), high.max(b)));
        let (low, high) = around.unwrap_or_default();
        let kind = group[0].kind;
        let value = format!(
            "{} label {} from ({:.2}, {:.2}, {:.2}) to ({:.2}, {:.2}, {:.2}) m",
            kind_name(kind),
            kind.label().id(),
            low.x,
            -high.y,
            low.z,
            high.x,
            -low.y,
            high.z
        );
        (id(object_instance(group[0].object_id)), value)
    };
    let body = |body: &OtherBody| {
        let BodyKindRow { noun, label, .. } = body.plan.kind.row();
        let label = label.id();
        let value = format!("{noun} label {label} of body {}, {:.2} m high", body.body_id, body.plan.size_m.z);
        (id(body.instance), value)
    };
    let fixed = [(0, "ground and sky"), (TARGET_INSTANCE, "the target")];
    let fixed = fixed.map(|(instance, what)| (id(instance), what.to_owned()));
    let groups = obstacles.chunk_by(|a, b| a.object_id == b.object_id);
    groups.map(entry).chain(record.others.iter().map(body)).chain(fixed).collect()
}
