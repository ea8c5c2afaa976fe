//! `render`: pictures of every trajectory, all channels of a frame from one visibility pass.

use crate::body_rays::BodyRays;
use crate::memo::Memo;
use crate::ports::{self, FRAMES, TRAJECTORY};
use crate::world::{TOWN_BLOB, World, check_same_town, link_town, world};
use crate::{backends, codec, parameters, single};
use cosfly_dataset::frame_pack::{FramePackWriter, PackHeader};
use cosfly_dataset::{EncodingConfig, PairInfo, Rejection, RenderedTrajectory, Role, TownInfo};
use cosfly_diagnose::Result;
use cosfly_fingerprint::Digest;
use cosfly_frames::{Pose, Seed, TargetState};
use cosfly_planner::{PlanOutcome, Trajectory};
use cosfly_render::effects::{pose_at, target_state_at};
use cosfly_render::{
    Backend, Camera, Effects, Moment, Mount, RenderConfig, Scene, Shot, TargetSetup, TargetView, Weather,
    gait_phase_rad,
};
use cosfly_stage::{
    Artifact, InputPort, Inputs, ItemRule, OutputSink, ParameterError, Produced, Stage, StageKind, StagePart,
    StageProperties, TaskContext,
};
use std::sync::{Mutex, PoisonError};

/// The kind.
pub struct Render;

impl StageKind for Render {
    fn name(&self) -> &'static str {
        "render"
    }

    fn doc(&self) -> &'static str {
        "Renders every trajectory: RGB, metric depth, semantic and instance ids, and how the target looks in each frame."
    }

    fn schema(&self) -> serde_json::Value {
        parameters::joined_schema::<RenderConfig, EncodingConfig>("encoding")
    }

    fn ports(&self) -> Vec<InputPort> {
        vec![ports::town(), ports::each("trajectories", TRAJECTORY, true, "The trajectories to fly the camera along.")]
    }

    fn build(&self, given: serde_json::Value) -> Result<Vec<StagePart>, ParameterError> {
        let (config, encoding) = parameters::read_joined::<RenderConfig, EncodingConfig>(given, "encoding")?;
        config.validate().map_err(|problem| ParameterError {
            hint: Some(problem.hint),
            ..parameters::refused_at(&problem.path, problem.message)
        })?;
        backends::check(config.backend).map_err(|error| ParameterError {
            hint: Some(error.hint),
            ..parameters::refused_at("backend", error.message)
        })?;
        let pixels = u64::from(config.width) * u64::from(config.height);
        let properties = StageProperties {
            kind: self.name().into(),
            version: 3,
            parameters: canonical(&config, &encoding),
            sources: vec![],
            inputs: self.ports(),
            artifact: FRAMES,
            items: match config.paired_weathers {
                true => ItemRule::PerVariant { port: "trajectories", variants: config.weathers.clone() },
                false => ItemRule::PerInput("trajectories"),
            },
            bytes_per_item: 200 * pixels * 3 / 4,
        };
        Ok(single(RenderStage { config, encoding, properties, scene: Memo::default(), idle: Mutex::default() }))
    }
}

/// The parameters that go into keys. A paired item is named after its own weather and reads no other: one more weather
/// renders no old one anew.
fn canonical(config: &RenderConfig, encoding: &EncodingConfig) -> serde_json::Value {
    let mut all = parameters::joined_canonical(config, encoding, "encoding");
    if let Some(table) = all.as_object_mut().filter(|_| config.paired_weathers) {
        table.remove("weathers");
    }
    all
}

/// Blob of a flight that there is nothing to render of; `index` and `pack` are absent then.
pub const REJECTION: &str = "rejection";

struct RenderStage {
    config: RenderConfig,
    encoding: EncodingConfig,
    properties: StageProperties,
    scene: Memo<Scene>,
    /// Cameras that no task uses now.
    idle: Mutex<Vec<Rig>>,
}

impl Stage for RenderStage {
    fn properties(&self) -> &StageProperties {
        &self.properties
    }

    fn run(&self, inputs: &Inputs<'_>, outputs: &mut dyn OutputSink, context: &TaskContext) -> Result<Produced> {
        check_same_town(inputs, "trajectories")?;
        link_town(inputs, outputs)?;
        let artifact = inputs.one("trajectories")?;
        let world = world(inputs)?;
        let outcome: PlanOutcome = codec::decode(TRAJECTORY, &inputs.read(artifact, "trajectory")?)?;
        let trajectory = match outcome {
            PlanOutcome::Planned(trajectory) => *trajectory,
            PlanOutcome::Rejected { reason, .. } => {
                let rejection = Rejection {
                    trajectory_id: context.item.clone(),
                    stage: artifact.stage.clone(),
                    pedestrian_id: pedestrian_of(artifact).to_owned(),
                    town: world.town.name.clone(),
                    reason: reason.clone(),
                };
                outputs.put(REJECTION, &codec::encode(FRAMES, &rejection)?)?;
                return Ok(Produced { rejected: Some(reason), ..Produced::default() });
            }
        };
        let town_digest = inputs.one("town")?.blobs[TOWN_BLOB].digest;
        // Buildings look the same in every flight through the town.
        let scene = self.scene.get(town_digest, || {
            Ok::<_, Box<cosfly_diagnose::Diagnostic>>(Scene::new(&world.town, Seed(town_digest.0)))
        })?;
        // Twins follow the same walk: same clothes, same weather, same camera.
        let walk_seed = Seed(Digest::of(&codec::encode("walk-seed/1", &trajectory.track)?).0);
        let preset = variant_of(artifact, context);
        let shooting = Shooting {
            camera: self.config.draw_camera(&walk_seed),
            mount: self.config.draw_mount(&walk_seed),
            weather: match preset {
                Some(preset) => self.config.weather_called(preset, &walk_seed),
                None => self.config.draw_weather(&walk_seed),
            },
            walk_seed,
        };
        let (views, visible_by_dense_rays) = self.draw(outputs, context, &scene, &world, &trajectory, &shooting)?;
        let pedestrian_id = pedestrian_of(artifact).to_owned();
        // The expert is published in the same weather.
        let expert_id = |expert: &str| preset.map_or(expert.to_owned(), |preset| format!("{expert}-{preset}"));
        let pair = trajectory.perturbation.as_ref().map(|twin| PairInfo { expert_id: expert_id(&twin.expert_item) });
        let record = RenderedTrajectory {
            trajectory_id: context.item.clone(),
            flight_id: artifact.item.clone(),
            role: if pair.is_some() { Role::Perturbed } else { Role::Expert },
            pedestrian_id,
            town: TownInfo::of(&world.town, town_digest),
            trajectory,
            camera: shooting.camera,
            lens: self.config.lens,
            mount: shooting.mount,
            motion_blur: self.config.motion_blur,
            noise: self.config.noise,
            weather: shooting.weather,
            seed: Seed(context.seed).as_u64(),
            views,
            visible_by_dense_rays,
            pair,
        };
        outputs.put("index", &record.to_bytes())?;
        Ok(Produced::default())
    }
}

/// What all frames of a flight have in common.
struct Shooting {
    camera: Camera,
    mount: Mount,
    weather: Weather,
    walk_seed: Seed,
}

/// The camera that films, with what it films through.
struct Rig {
    camera: Camera,
    effects: Effects,
    backend: Box<dyn Backend>,
}

impl RenderStage {
    /// Renders frame by frame into the `pack` blob; memory does not grow with the number of frames. Gives how the target
    /// looks in each frame, and how much of it rays reach.
    fn draw(
        &self,
        outputs: &mut dyn OutputSink,
        context: &TaskContext,
        scene: &Scene,
        world: &World,
        trajectory: &Trajectory,
        shooting: &Shooting,
    ) -> Result<(Vec<TargetView>, Vec<Option<f64>>)> {
        let mut rig = self.take_rig(shooting.camera)?;
        let largest =
            world.town.obstacles.iter().map(|obstacle| obstacle.object_id).max().unwrap_or(0).saturating_add(2);
        let Camera { width, height, .. } = shooting.camera;
        let header = PackHeader::new(width, height, largest, self.encoding, trajectory.track.dt_s);
        let track = &trajectory.track;
        let poses: Vec<Pose> =
            trajectory.poses_in_world.iter().map(|drone| shooting.mount.camera_pose(drone)).collect();
        let walked_m = walked_m(&track.states);
        let mut views = Vec::with_capacity(track.len());
        let (mut body_rays, mut by_dense_rays) = (BodyRays::default(), Vec::with_capacity(track.len()));
        outputs.stream("pack", &mut |file| {
            views.clear();
            by_dense_rays.clear();
            let mut pack = FramePackWriter::new(file, &header)?;
            for (frame, visible_by_rays) in trajectory.visibility.iter().copied().enumerate() {
                context.check_cancelled()?;
                let moment = |offset_s: f64| {
                    let at = frame as f64 + offset_s / track.dt_s;
                    let state = target_state_at(&track.states, at);
                    let target = TargetSetup {
                        state,
                        height_m: track.height_m,
                        radius_m: track.radius_m,
                        clothes_seed: shooting.walk_seed,
                        gait_phase_rad: gait_phase_rad(walked_m[frame] + offset_s * state.speed_mps, track.height_m),
                        visible_by_rays,
                    };
                    // A point without extent is nobody: it is watched, not drawn.
                    Moment { pose: pose_at(&poses, at), target: Some(target).filter(|target| target.radius_m > 0.0) }
                };
                let noise_seed = Seed(context.seed).child("frame", frame as u64);
                let shot = Shot { weather: &shooting.weather, moment: &moment, noise_seed };
                let rendered = rig
                    .effects
                    .film(&mut *rig.backend, scene, &shot)
                    .map_err(|error| backends::failure(self.config.backend, &error))?;
                pack.frame(rendered.images)?;
                views.push(TargetView { visible_by_rays, ..rendered.target_view });
                let Moment { pose, target } = moment(0.0);
                let target = target.filter(|_| rendered.target_view.in_view);
                by_dense_rays
                    .push(target.and_then(|it| body_rays.visible_share(&world.exact, &shooting.camera, &pose, &it)));
            }
            pack.finish().map(drop)
        })?;
        self.idle.lock().unwrap_or_else(PoisonError::into_inner).push(rig);
        Ok((views, by_dense_rays))
    }

    fn take_rig(&self, camera: Camera) -> Result<Rig> {
        let mut idle = self.idle.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(position) = idle.iter().position(|rig| rig.camera == camera) {
            return Ok(idle.swap_remove(position));
        }
        // Another camera: its buffers replace those of one that nobody uses.
        idle.pop();
        drop(idle);
        let effects = self.config.effects(camera);
        let backend = backends::open(self.config.backend, effects.ideal_camera())
            .map_err(|error| backends::failure(self.config.backend, &error))?;
        Ok(Rig { camera, effects, backend })
    }
}

/// How far the target has walked at each frame.
fn walked_m(states: &[TargetState]) -> Vec<f64> {
    let mut sum_m = 0.0;
    let step_m = |frame: usize| match frame {
        0 => 0.0,
        _ => (states[frame].feet_in_world - states[frame - 1].feet_in_world).length(),
    };
    (0..states.len())
        .map(|frame| {
            sum_m += step_m(frame);
            sum_m
        })
        .collect()
}

/// The weather that the item of a paired rendering is named after.
fn variant_of<'a>(artifact: &Artifact, context: &'a TaskContext) -> Option<&'a str> {
    context.item.strip_prefix(&artifact.item)?.strip_prefix('-')
}

/// The pedestrian that a trajectory at a `many` port follows: its id without the stage's name.
pub fn pedestrian_of(artifact: &Artifact) -> &str {
    artifact.item.strip_prefix(&artifact.stage).and_then(|rest| rest.strip_prefix('-')).unwrap_or(&artifact.item)
}
