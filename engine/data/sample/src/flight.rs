//! Sample flights: the track of a pedestrian, the poses of a drone, pictures by rays.

use crate::drawn::{COMPANION, HEIGHT_M, RADIUS_M, ahead_of, flow_px, is_shown, look, point};
use crate::town::town;
use cosfly_domain::channels::{ALL, ChannelSource, FlowTo, SeenPoint, disparity};
use cosfly_domain::{
    Around, BodyKind, BodyPlan, Camera, Certificate, ChannelImage, ChannelSet, FrameImages, FramePerturbation, Lens,
    Limits, MotionBlur, Mount, Noise, Optics, Outfit, Perturbation, PerturbationKind, RollingShutter, Season,
    SemanticLabel, StereoEye, TargetView, TermCost, Trajectory, Weather,
};
use cosfly_figures::Clothes;
use cosfly_frames::{DVec3, Pose, Seed, TargetState, TargetTrack, real};
use cosfly_planner::certificate::view_rates_deg_s;
use cosfly_schema::{
    CaptionRecord, EncodingConfig, OtherBody, PairInfo, Rejection, RenderedTrajectory, Role, Sighting, TownInfo,
};
use cosfly_write::frame_pack::{FramePackWriter, PackHeader};

/// Base line of the pair that the optional channels are of, metres.
const BASE_LINE_M: f64 = 0.3;

/// Number of frames of every flight.
pub const FRAMES: usize = 5;

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

    /// Draws all optional channels, as if every surface were level, nobody moved, the target were a box and the camera the left one
    /// of a pair.
    pub fn draw_on_request(&mut self) {
        self.record.stereo = Some(StereoEye { base_line_m: BASE_LINE_M, is_right: false });
        let camera = &self.record.camera;
        let poses = &self.record.trajectory.poses_in_world;
        let views = &self.record.views;
        let depths: Vec<Vec<f32>> = self.images.iter().map(|images| images.depth_m.clone()).collect();
        for (frame, (images, pose)) in self.images.iter_mut().zip(poses).enumerate() {
            let points: Vec<SeenPoint> = (0..images.depth_m.len()).map(|at| point(images, camera, pose, at)).collect();
            let on_request = ALL.iter().copied().filter(|channel| channel.is_on_request());
            images.on_request = on_request.map(|channel| ChannelImage::new(channel, points.len())).collect();
            for image in &mut images.on_request {
                if let (ChannelSource::TargetAlone, Some(full)) = (image.channel.source, views[frame].full_box) {
                    for row in full.v_min..=full.v_max {
                        let at = |column: u32| (row * images.width + column) as usize;
                        image.bytes[at(full.u_min)..=at(full.u_max)].fill(1);
                    }
                    continue;
                }
                let pixels = image.bytes.chunks_exact_mut(image.channel.bytes_on_request());
                let beside = match image.channel.source {
                    ChannelSource::Flow(FlowTo::Previous) | ChannelSource::FlowValid(FlowTo::Previous) => {
                        frame.checked_sub(1)
                    }
                    _ => Some(frame + 1),
                };
                let beside = beside.filter(|beside| *beside < FRAMES).map(|at| (&poses[at], &depths[at]));
                for (pixel, point) in pixels.zip(&points) {
                    image.channel.draw(point, pixel);
                    if *image.channel == disparity::CHANNEL {
                        let disparity_px = camera.focal_px() * BASE_LINE_M / f64::from(point.depth_m);
                        pixel.copy_from_slice(&(disparity_px as f32).to_le_bytes());
                    }
                    match (image.channel.source, beside) {
                        (ChannelSource::Flow(_), Some((beside, _))) => {
                            pixel.copy_from_slice(&flow_px(point, camera, pose, beside).map(f32::to_le_bytes).concat());
                        }
                        (ChannelSource::FlowValid(_), Some((beside, depths))) => {
                            pixel[0] = is_shown(point, camera, beside, depths).into();
                        }
                        _ => {}
                    }
                }
            }
        }
    }

    /// Frame pack of the flight.
    pub fn pack(&self, encoding: EncodingConfig) -> Vec<u8> {
        let camera = &self.record.camera;
        let header = PackHeader {
            begins_ns: self.record.begins_ns,
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
        let sighting = |view| Sighting { frame: frame as u32, other: 0, state: ahead_of(state), view };
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
        camera_name: None,
        camera,
        lens: Lens::default(),
        mount: Mount::default(),
        stereo: None,
        motion_blur: MotionBlur::default(),
        rolling_shutter: RollingShutter::default(),
        noise: Noise::default(),
        optics: Optics::IDEAL,
        weather: weather(),
        season: Season::Summer,
        seed: 0x0123_4567_89ab_cdef,
        visible_by_dense_rays: views.iter().map(|view| view.in_view.then_some(view.visible_by_pixels)).collect(),
        views,
        followed: None,
        around: Around::default(),
        others: vec![OtherBody {
            instance: COMPANION,
            body_id: "crowd-p00000".into(),
            plan: BodyPlan {
                source: String::new(),
                kind: BodyKind::Pedestrian,
                size_m: DVec3::new(2.0 * RADIUS_M, 2.0 * RADIUS_M, HEIGHT_M),
                looks: Seed([9; 32]),
                group: None,
            },
            outfit: outfit(9),
        }],
        outfit: Some(outfit(pedestrian as u8)),
        sightings,
        bodies_3d: vec![],
        pair: (role == Role::Perturbed).then(|| PairInfo { expert_id: format!("expert-p{pedestrian:05}") }),
        begins_ns: 0,
        every: 1,
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
        coverage: vec![],
        labels: vec![],
        convergence: vec![3.0, 1.0],
        certificate,
        perturbation: (role == Role::Perturbed).then(|| Perturbation {
            expert_item: format!("p{pedestrian:05}"),
            kind: PerturbationKind::JUMPS,
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
