//! A tiny synthetic dataset for tests and examples: two pedestrians on a plane, each with an expert and a perturbed
//! flight, with very small ray-cast images.

mod folder;
mod many;

pub use folder::{write_flights, write_to_folder};
pub use many::{ManyFlights, write_many};

use cosfly_domain::channels::{ALL, SeenPoint};
use cosfly_domain::{
    Around, BodyKind, Camera, Certificate, ChannelImage, ChannelSet, FrameImages, FramePerturbation, Lens, Limits,
    MapOrigin, MotionBlur, Mount, Noise, Obstacle, ObstacleKind, OrientedBox, Outfit, PersonView, Perturbation,
    PerturbationKind, PixelBox, RollingShutter, Season, SemanticLabel, SimplificationReport, Synthetic,
    TARGET_INSTANCE, TargetView, TermCost, Town, Trajectory, Weather,
};
use cosfly_figures::Clothes;
use cosfly_frames::{DVec3, Pose, Seed, TargetState, TargetTrack, real};
use cosfly_planner::certificate::view_rates_deg_s;
use cosfly_schema::{
    CaptionRecord, EncodingConfig, OtherPerson, PairInfo, Rejection, RenderedTrajectory, Role, Sighting, TownInfo,
};
use cosfly_write::frame_pack::{FramePackWriter, PackHeader};

/// Number of frames of every flight.
pub const FRAMES: usize = 5;
const HEIGHT_M: f64 = 1.8;
const RADIUS_M: f64 = 0.35;
/// Instance id of the bystander who walks ahead of every target.
const COMPANION: u32 = 7;

/// One flight with its pixels and captions.
pub struct SampleFlight {
    /// Record of the flight.
    pub record: RenderedTrajectory,
    /// Images, one per frame.
    pub images: Vec<FrameImages>,
    /// Captions of the flight.
    pub captions: Vec<CaptionRecord>,
}

impl SampleFlight {
    /// Channels of the images.
    pub fn channels(&self) -> ChannelSet {
        let drawn = self.images.first().map_or(&[][..], |images| &images.on_request[..]);
        ChannelSet::of(|channel| !channel.is_on_request() || drawn.iter().any(|image| image.channel == channel))
    }

    /// Draws all optional channels, as if every surface were level.
    pub fn draw_on_request(&mut self) {
        let camera = &self.record.camera;
        for (images, pose) in self.images.iter_mut().zip(&self.record.trajectory.poses_in_world) {
            let points: Vec<SeenPoint> = (0..images.depth_m.len()).map(|at| point(images, camera, pose, at)).collect();
            let on_request = ALL.iter().copied().filter(|channel| channel.is_on_request());
            images.on_request = on_request.map(|channel| ChannelImage::new(channel, points.len())).collect();
            for image in &mut images.on_request {
                let pixels = image.bytes.chunks_exact_mut(image.channel.bytes_on_request());
                pixels.zip(&points).for_each(|(pixel, point)| image.channel.draw(point, pixel));
            }
        }
    }

    /// Frame pack of the flight.
    pub fn pack(&self, encoding: EncodingConfig) -> Vec<u8> {
        let camera = &self.record.camera;
        let header = PackHeader {
            channels: self.channels(),
            ..PackHeader::new(camera.width, camera.height, 9, encoding, self.record.dt_s())
        };
        let mut writer = FramePackWriter::new(vec![], &header).expect("memory takes every byte");
        self.images.iter().for_each(|images| writer.frame(images).expect("sample images are sound"));
        writer.finish().expect("memory takes every byte")
    }
}

/// Draws the ground of a flight's pictures higher than people stand, as if they walked below it.
pub fn raise_drawn_ground(flight: &mut SampleFlight, rise_m: f64) {
    for (images, pose) in flight.images.iter_mut().zip(&flight.record.trajectory.poses_in_world) {
        let height_m = pose.position_in_world.z;
        let is_ground = images.semantic.iter().map(|label| *label == SemanticLabel::Ground.id());
        for (depth_m, _) in images.depth_m.iter_mut().zip(is_ground).filter(|(_, is_ground)| *is_ground) {
            *depth_m *= ((height_m - rise_m) / height_m) as f32;
        }
    }
}

/// Point of the surface at a pixel, assumed level.
fn point(images: &FrameImages, camera: &Camera, pose: &Pose, at: usize) -> SeenPoint {
    let (column, row) = (at as u32 % images.width, at as u32 / images.width);
    let depth_m = images.depth_m[at];
    SeenPoint {
        depth_m,
        label: images.semantic[at],
        instance: images.instance[at],
        normal_in_world: if depth_m.is_finite() { DVec3::Z } else { DVec3::ZERO },
        ray_in_world: camera.ray_in_world(pose, f64::from(column) + 0.5, f64::from(row) + 0.5),
        camera_in_world: pose.position_in_world,
    }
}

/// A plain with one wall, part of which hides the target in some frames.
pub fn town() -> Town {
    let wall = Obstacle {
        shape: OrientedBox {
            center_in_world: DVec3::new(-0.5, 0.75, 0.7),
            half_extents_m: DVec3::new(0.3, 0.6, 0.7),
            yaw_rad: 0.4,
        },
        kind: ObstacleKind::Wall,
        object_id: 4,
        synthetic: true,
    };
    Town {
        name: "plain".into(),
        origin: MapOrigin::default(),
        obstacles: vec![wall],
        planning_boxes: vec![],
        simplification: SimplificationReport::default(),
        walkable: vec![],
        surfaces: vec![],
        lanes: vec![],
        synthetic: Synthetic {
            buildings: true,
            trees: false,
            furniture: false,
            notes: vec!["one wall of a made-up plain".into()],
        },
        min_in_world: DVec3::splat(-100.0),
        max_in_world: DVec3::splat(100.0),
    }
}

/// All flights, experts before their twins.
pub fn flights() -> Vec<SampleFlight> {
    (0..2).flat_map(|pedestrian| [Role::Expert, Role::Perturbed].map(|role| flight(pedestrian, role))).collect()
}

/// A pedestrian without a flight.
pub fn rejections() -> Vec<Rejection> {
    vec![Rejection {
        trajectory_id: "expert-p00002".into(),
        stage: "expert".into(),
        pedestrian_id: "p00002".into(),
        town: "plain".into(),
        reason: "the target cannot be reached".into(),
    }]
}

/// Flight of one role behind one pedestrian.
pub fn flight(pedestrian: usize, role: Role) -> SampleFlight {
    flight_filmed_by(Camera { width: 64, height: 48, horizontal_fov_rad: 1.2 }, pedestrian, role)
}

/// Flight of one role behind one pedestrian, in pictures of another size.
pub fn flight_filmed_by(camera: Camera, pedestrian: usize, role: Role) -> SampleFlight {
    let track = track(pedestrian);
    let expert: Vec<Pose> = track.states.iter().enumerate().map(|(i, state)| behind(state, i, DVec3::ZERO)).collect();
    let offset = DVec3::new(0.4, -0.3, 0.2);
    let poses: Vec<Pose> = match role {
        Role::Expert => expert,
        Role::Perturbed => {
            let disturbed = |(i, state)| behind(state, i, if i == 2 { offset } else { DVec3::ZERO });
            track.states.iter().enumerate().map(disturbed).collect()
        }
    };
    let town = town();
    let (mut images, mut views, mut sightings) = (vec![], vec![], vec![]);
    for (frame, (pose, state)) in poses.iter().zip(&track.states).enumerate() {
        let (picture, view, companion) = look(&camera, pose, state, &town);
        images.push(picture);
        views.push(view);
        let sighting = |view| Sighting { frame: frame as u32, person: 0, state: ahead_of(state), view };
        sightings.extend(companion.map(sighting));
    }
    let trajectory = trajectory(track, poses, role, pedestrian, offset, &views);
    let record = RenderedTrajectory {
        trajectory_id: format!("{}-p{pedestrian:05}", role.name()),
        flight_id: format!("{}-p{pedestrian:05}", role.name()),
        role,
        pedestrian_id: format!("p{pedestrian:05}"),
        town: TownInfo::of(&town, "0".repeat(64)),
        trajectory,
        camera,
        lens: Lens::default(),
        mount: Mount::default(),
        motion_blur: MotionBlur::default(),
        rolling_shutter: RollingShutter::default(),
        noise: Noise::default(),
        weather: weather(),
        season: Season::Summer,
        seed: 0x0123_4567_89ab_cdef,
        visible_by_dense_rays: views.iter().map(|view| view.in_view.then_some(view.visible_by_pixels)).collect(),
        views,
        followed: None,
        around: Around::default(),
        others: vec![OtherPerson {
            instance: COMPANION,
            walk_id: "crowd-p00000".into(),
            kind: BodyKind::Pedestrian,
            height_m: HEIGHT_M,
            radius_m: RADIUS_M,
            outfit: outfit(9),
        }],
        outfit: Some(outfit(pedestrian as u8)),
        sightings,
        pair: (role == Role::Perturbed).then(|| PairInfo { expert_id: format!("expert-p{pedestrian:05}") }),
    };
    let caption = |language: &str, text: &str| CaptionRecord {
        language: language.into(),
        style: "instruction".into(),
        text: text.into(),
        writer: "template".into(),
        ..CaptionRecord::default()
    };
    let captions = vec![caption("en", "Follow the pedestrian for 2 metres."), caption("zh", "跟随行人前进2米。")];
    SampleFlight { record, images, captions }
}

/// Clothes of a person.
fn outfit(number: u8) -> Outfit {
    Clothes::draw(&Seed([number; 32])).outfit
}

fn track(pedestrian: usize) -> TargetTrack {
    let heading_rad = 0.4 + pedestrian as f64;
    let (sin, cos) = real::sin_cos(heading_rad);
    let state =
        |i| TargetState { feet_in_world: DVec3::new(cos, sin, 0.0) * (0.65 * i as f64), heading_rad, speed_mps: 1.3 };
    TargetTrack { dt_s: 0.5, height_m: HEIGHT_M, radius_m: RADIUS_M, states: (0..FRAMES).map(state).collect() }
}

/// State of a bystander 2.5 m ahead and 1.5 m to the right.
fn ahead_of(state: &TargetState) -> TargetState {
    let (sin, cos) = real::sin_cos(state.heading_rad);
    let away = DVec3::new(2.5 * cos - 1.5 * sin, 2.5 * sin + 1.5 * cos, 0.0);
    TargetState { feet_in_world: state.feet_in_world + away, ..*state }
}

/// Pose of a camera 4 m above the feet and at least 6 m behind, falling back, that looks at the middle of the body.
fn behind(state: &TargetState, frame: usize, offset: DVec3) -> Pose {
    let (sin, cos) = real::sin_cos(state.heading_rad);
    let back_m = 6.0 + 0.8 * frame as f64;
    let position = state.feet_in_world + DVec3::new(-back_m * cos, -back_m * sin, 4.0) + offset;
    Pose::looking_at(position, state.feet_in_world + DVec3::Z * (0.5 * HEIGHT_M))
}

fn trajectory(
    track: TargetTrack,
    poses: Vec<Pose>,
    role: Role,
    pedestrian: usize,
    offset: DVec3,
    views: &[TargetView],
) -> Trajectory {
    let frames = poses.len();
    let certificate = certificate(&track, &poses, views);
    let perturbed = |i: usize| FramePerturbation {
        position: i == 2,
        rotation: false,
        drone_offset_in_world: if i == 2 { offset } else { DVec3::ZERO },
        aim_offset_in_world: DVec3::ZERO,
        pitch_offset_rad: 0.0,
        yaw_offset_rad: 0.0,
        expert_frame: i as u32,
    };
    Trajectory {
        track,
        poses_in_world: poses,
        visibility: views.iter().map(|view| view.visible_by_rays).collect(),
        clearance_m: vec![3.0; frames],
        terms: vec![TermCost { name: "distance".into(), weight: 2.0, sum: 0.5, per_frame: vec![0.1; frames] }],
        convergence: vec![3.0, 1.0],
        certificate,
        perturbation: (role == Role::Perturbed).then(|| Perturbation {
            expert_item: format!("p{pedestrian:05}"),
            kind: Kind::Jumps,
            position_probability: 0.3,
            rotation_probability: 0.3,
            frames: (0..frames).map(perturbed).collect(),
        }),
    }
}

fn certificate(track: &TargetTrack, poses: &[Pose], views: &[TargetView]) -> Certificate {
    let count = poses.len() as f64;
    let seen: Vec<f64> = views.iter().map(|view| view.visible_by_rays).collect();
    let positions: Vec<DVec3> = poses.iter().map(|pose| pose.position_in_world).collect();
    let distances = positions.iter().zip(&track.states).map(|(position, state)| position.distance(state.feet_in_world));
    let length_m = positions.windows(2).map(|pair| pair[1].distance(pair[0])).sum::<f64>();
    let [max_yaw_rate_deg_s, max_pitch_rate_deg_s] = view_rates_deg_s(poses, track.dt_s);
    Certificate {
        limits: Limits {
            clearance_m: 1.0,
            speed_mps: 15.0,
            acceleration_mps2: 8.0,
            jerk_mps3: 40.0,
            yaw_rate_deg_s: 90.0,
            pitch_rate_deg_s: 90.0,
        },
        holds: true,
        violations: vec![],
        mean_visibility: seen.iter().sum::<f64>() / count,
        frames_half_visible: seen.iter().filter(|share| **share >= 0.5).count() as f64 / count,
        min_clearance_m: 3.0,
        max_speed_mps: 1.3,
        max_acceleration_mps2: 0.1,
        max_jerk_mps3: 0.1,
        max_yaw_rate_deg_s,
        max_pitch_rate_deg_s,
        mean_distance_m: distances.sum::<f64>() / count,
        mean_rear_angle_deg: 0.0,
        length_m,
        length_ratio: length_m / track.length_m(),
        iterations: 2,
        filtered_boxes: 1,
        ..Certificate::default()
    }
}

fn weather() -> Weather {
    Weather {
        name: "ClearNoon".into(),
        cloudiness: 5.0,
        precipitation: 0.0,
        precipitation_deposits: 0.0,
        wind_intensity: 10.0,
        sun_azimuth_angle: -1.0,
        sun_altitude_angle: 45.0,
        fog_density: 2.0,
        fog_distance: 0.75,
        fog_falloff: 0.1,
        wetness: 0.0,
        scattering_intensity: 1.0,
        mie_scattering_scale: 0.03,
        rayleigh_scattering_scale: 0.0331,
        dust_storm: 0.0,
    }
}

/// Ray-casts ground, wall, target and bystander.
fn look(
    camera: &Camera,
    pose: &Pose,
    state: &TargetState,
    town: &Town,
) -> (FrameImages, TargetView, Option<PersonView>) {
    let (width, height) = (camera.width, camera.height);
    let mut images = FrameImages { width, height, ..FrameImages::default() };
    let (mut full, mut visible, mut companion) = (vec![], vec![], vec![]);
    let wall = &town.obstacles[0];
    for v in 0..height {
        for u in 0..width {
            let ray = camera.ray_in_world(pose, f64::from(u) + 0.5, f64::from(v) + 0.5);
            let from = pose.position_in_world;
            let ground = if ray.z < 0.0 { -from.z / ray.z } else { f64::INFINITY };
            let body = cylinder_hit(from - state.feet_in_world, ray);
            let wall_hit = box_hit(&wall.shape, from, ray);
            let other = cylinder_hit(from - ahead_of(state).feet_in_world, ray);
            let depth = ground.min(body).min(wall_hit).min(other);
            let (label, id) = if depth == f64::INFINITY {
                (SemanticLabel::Sky, 0)
            } else if depth == body {
                (SemanticLabel::Pedestrian, TARGET_INSTANCE)
            } else if depth == other {
                (SemanticLabel::Pedestrian, COMPANION)
            } else if depth == wall_hit {
                (SemanticLabel::Wall, wall.object_id + 2)
            } else {
                (SemanticLabel::Ground, 0)
            };
            if body < f64::INFINITY {
                full.push((u, v));
            }
            match id {
                TARGET_INSTANCE => visible.push((u, v)),
                COMPANION => companion.push((u, v)),
                _ => {}
            }
            images.rgb.extend(label.colour());
            images.depth_m.push(depth as f32);
            images.semantic.push(label.id());
            images.instance.push(id);
        }
    }
    let share = visible.len() as f64 / full.len().max(1) as f64;
    let view = TargetView {
        in_view: !full.is_empty(),
        visible_by_rays: share,
        visible_by_pixels: share,
        pixels: visible.len() as u32,
        visible_box: bounds(&visible),
        full_box: bounds(&full),
        occluder_instance: if visible.len() < full.len() { wall.object_id + 2 } else { 0 },
    };
    let pixels = companion.len() as u32;
    let companion = bounds(&companion).map(|visible_box| PersonView { instance: COMPANION, pixels, visible_box });
    (images, view, companion)
}

fn bounds(pixels: &[(u32, u32)]) -> Option<PixelBox> {
    Some(PixelBox {
        u_min: pixels.iter().map(|pixel| pixel.0).min()?,
        v_min: pixels.iter().map(|pixel| pixel.1).min()?,
        u_max: pixels.iter().map(|pixel| pixel.0).max()?,
        v_max: pixels.iter().map(|pixel| pixel.1).max()?,
    })
}

/// First hit with the body, a vertical cylinder at the origin, as a multiple of `ray`; infinite without a hit.
fn cylinder_hit(from: DVec3, ray: DVec3) -> f64 {
    let (a, b) = (ray.x * ray.x + ray.y * ray.y, from.x * ray.x + from.y * ray.y);
    let c = from.x * from.x + from.y * from.y - RADIUS_M * RADIUS_M;
    let root = (b * b - a * c).max(0.0).sqrt();
    let side = (-b - root) / a;
    let lid = (HEIGHT_M - from.z) / ray.z;
    let lid_point = from + ray * lid;
    if b * b >= a * c && side > 0.0 && (0.0..=HEIGHT_M).contains(&(from.z + ray.z * side)) {
        side
    } else if lid > 0.0 && lid_point.x * lid_point.x + lid_point.y * lid_point.y <= RADIUS_M * RADIUS_M {
        lid
    } else {
        f64::INFINITY
    }
}

/// First hit with a box (slab test in its own axes), as a multiple of `ray`; infinite without a hit.
fn box_hit(shape: &OrientedBox, from: DVec3, ray: DVec3) -> f64 {
    let (sin, cos) = real::sin_cos(shape.yaw_rad);
    let local = |v: DVec3| DVec3::new(cos * v.x + sin * v.y, cos * v.y - sin * v.x, v.z);
    let (origin, direction) = (local(from - shape.center_in_world), local(ray));
    let to_min = (-shape.half_extents_m - origin) / direction;
    let to_max = (shape.half_extents_m - origin) / direction;
    let enter = to_min.min(to_max).max_element();
    let leave = to_min.max(to_max).min_element();
    if enter <= leave && enter > 0.0 { enter } else { f64::INFINITY }
}
