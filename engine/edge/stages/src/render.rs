//! `render`: pictures of every trajectory, all channels of a frame from one visibility pass.

use crate::memo::Memo;
use crate::ports::{self, FRAMES, TRAJECTORY};
use crate::world::{TOWN_BLOB, World, check_same_town, link_town, world};
use crate::{backends, codec, parameters, single};
use cosfly_dataset::frame_pack::{FramePackWriter, PackHeader};
use cosfly_dataset::{EncodingConfig, PairInfo, Rejection, RenderedTrajectory, Role, TownInfo};
use cosfly_diagnose::Result;
use cosfly_fingerprint::Digest;
use cosfly_frames::Seed;
use cosfly_planner::{PlanOutcome, Trajectory};
use cosfly_render::{
    Backend, Camera, FrameSetup, RenderConfig, Scene, TargetSetup, TargetView, Weather, gait_phase_rad,
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
            parameters: parameters::joined_canonical(&config, &encoding, "encoding"),
            sources: vec![],
            inputs: self.ports(),
            artifact: FRAMES,
            items: ItemRule::PerInput("trajectories"),
            bytes_per_item: 200 * pixels * 3 / 4,
        };
        Ok(single(RenderStage { config, encoding, properties, scene: Memo::default(), idle: Mutex::default() }))
    }
}

/// Blob of a flight that there is nothing to render of; `index` and `pack` are absent then.
pub const REJECTION: &str = "rejection";

struct RenderStage {
    config: RenderConfig,
    encoding: EncodingConfig,
    properties: StageProperties,
    scene: Memo<Scene>,
    /// Renderers that no task uses now, with the camera they were made for.
    idle: Mutex<Vec<Box<dyn Backend>>>,
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
                    trajectory_id: artifact.item.clone(),
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
        // Twins follow the same walk: same clothes, same weather.
        let walk_seed = Seed(Digest::of(&codec::encode("walk-seed/1", &trajectory.track)?).0);
        let camera = self.config.camera();
        let weather = self.config.draw_weather(&walk_seed);
        let views = self.draw(outputs, context, &scene, &world, &trajectory, camera, &weather, walk_seed)?;
        let record = record_of(artifact, &world, town_digest, trajectory, camera, weather, context, views);
        outputs.put("index", &record.to_bytes())?;
        Ok(Produced::default())
    }
}

impl RenderStage {
    /// Renders frame by frame into the `pack` blob; memory does not grow with the number of frames.
    #[expect(clippy::too_many_arguments, reason = "everything that a flight's pictures depend on")]
    fn draw(
        &self,
        outputs: &mut dyn OutputSink,
        context: &TaskContext,
        scene: &Scene,
        world: &World,
        trajectory: &Trajectory,
        camera: Camera,
        weather: &Weather,
        walk_seed: Seed,
    ) -> Result<Vec<TargetView>> {
        let mut renderer = self.take_renderer(camera)?;
        let largest =
            world.town.obstacles.iter().map(|obstacle| obstacle.object_id).max().unwrap_or(0).saturating_add(2);
        let header = PackHeader::new(camera.width, camera.height, largest, self.encoding, trajectory.track.dt_s);
        let track = &trajectory.track;
        let mut views = Vec::with_capacity(track.len());
        outputs.stream("pack", &mut |file| {
            views.clear();
            let mut pack = FramePackWriter::new(file, &header)?;
            let mut walked_m = 0.0;
            for (frame, (state, pose)) in track.states.iter().zip(&trajectory.poses_in_world).enumerate() {
                context.check_cancelled()?;
                if frame > 0 {
                    walked_m += (state.feet_in_world - track.states[frame - 1].feet_in_world).length();
                }
                let target = TargetSetup {
                    state: *state,
                    height_m: track.height_m,
                    radius_m: track.radius_m,
                    clothes_seed: walk_seed,
                    gait_phase_rad: gait_phase_rad(walked_m, track.height_m),
                    visible_by_rays: trajectory.visibility[frame],
                };
                // A point without extent is nobody: it is watched, not drawn.
                let target = Some(target).filter(|target| target.radius_m > 0.0);
                let rendered = renderer
                    .render(scene, &FrameSetup { pose: *pose, weather, target })
                    .map_err(|error| backends::failure(self.config.backend, &error))?;
                pack.frame(rendered.images)?;
                views.push(TargetView { visible_by_rays: trajectory.visibility[frame], ..rendered.target_view });
            }
            pack.finish().map(drop)
        })?;
        self.idle.lock().unwrap_or_else(PoisonError::into_inner).push(renderer);
        Ok(views)
    }

    fn take_renderer(&self, camera: Camera) -> Result<Box<dyn Backend>> {
        let mut idle = self.idle.lock().unwrap_or_else(PoisonError::into_inner);
        match idle.iter().position(|renderer| renderer.camera() == camera) {
            Some(position) => Ok(idle.swap_remove(position)),
            None => {
                // Another lens: its buffers replace those of a renderer that nobody uses.
                idle.pop();
                backends::open(self.config.backend, camera)
                    .map_err(|error| backends::failure(self.config.backend, &error))
            }
        }
    }
}

/// Everything about the flight but its pixels.
#[expect(clippy::too_many_arguments, reason = "the record joins them all")]
fn record_of(
    artifact: &Artifact,
    world: &World,
    town_digest: Digest,
    trajectory: Trajectory,
    camera: Camera,
    weather: Weather,
    context: &TaskContext,
    views: Vec<TargetView>,
) -> RenderedTrajectory {
    let pedestrian = pedestrian_of(artifact);
    let pair = trajectory.perturbation.as_ref().map(|twin| PairInfo { expert_id: twin.expert_item.clone() });
    RenderedTrajectory {
        trajectory_id: artifact.item.clone(),
        role: if pair.is_some() { Role::Perturbed } else { Role::Expert },
        pedestrian_id: pedestrian.to_owned(),
        town: TownInfo::of(&world.town, town_digest),
        trajectory,
        camera,
        weather,
        seed: Seed(context.seed).as_u64(),
        views,
        pair,
    }
}

/// The pedestrian that a trajectory at a `many` port follows: its id without the stage's name.
pub fn pedestrian_of(artifact: &Artifact) -> &str {
    artifact.item.strip_prefix(&artifact.stage).and_then(|rest| rest.strip_prefix('-')).unwrap_or(&artifact.item)
}
