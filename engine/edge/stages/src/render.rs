//! `render`: pictures of every trajectory, all channels of a frame from one visibility pass; the people in them come from
//! part `nearby`.

use crate::crowd::Crowd;
use crate::ports::{self, FRAMES, PACK};
use crate::rejections::reject;
use crate::{nearby, traffic};
use cosfly_blobs::OutputSink;
use cosfly_diagnose::{Diagnostic, Fault, ParameterError, Result};
use cosfly_domain::{
    BodyInSpace, Camera, PlanOutcome, TARGET_INSTANCE, TargetView, Trajectory, largest_object_instance,
};
use cosfly_experts::memo::Memo;
use cosfly_experts::render_files::ScanTally;
use cosfly_experts::world::{check_same_town, link_town, world};
use cosfly_experts::{artifacts, pictures, render_files};
use cosfly_figures::{FigureInPicture, outfit_of};
use cosfly_film::Shooting;
use cosfly_film::body_rays::{self, BodyRays};
use cosfly_film::in_space::Taken;
use cosfly_film::rate::{FilmedFlight, filmed_around, filmed_flight};
use cosfly_flight::World;
use cosfly_frames::{Pose, Seed};
use cosfly_geometry::SpatialQuery;
use cosfly_render::{Effects, FrameBeside, Moment, Neighbours, RenderConfig, Renderer, Scene, Shot};
use cosfly_schema::tables::kind_name;
use cosfly_schema::{EncodingConfig, PairInfo, Rejection, RenderedTrajectory, Role, Sighting, TownInfo};
use cosfly_stage::parameters;
use cosfly_stage::{
    InputPort, Inputs, ItemName, ItemRule, Produced, Stage, StageKind, StagePart, StageProperties, StageRole,
    TaskContext,
};
use cosfly_write::frame_pack::{FramePackWriter, PackHeader};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Mutex, PoisonError};

/// Stage kind `render`.
pub struct Render;

impl StageKind for Render {
    fn name(&self) -> &'static str {
        "render"
    }

    fn doc(&self) -> &'static str {
        "Renders every trajectory: RGB, metric depth, semantic and instance ids, and how the target looks in each frame."
    }

    fn schema(&self) -> serde_json::Value {
        parameters::joined_schema::<RenderConfig, EncodingConfig>(pictures::ENCODING)
    }

    fn ports(&self) -> Vec<InputPort> {
        vec![ports::town(), nearby::trajectories(), InputPort { optional: true, ..nearby::others() }]
    }

    fn build(&self, given: serde_json::Value) -> Result<Vec<StagePart>, ParameterError> {
        let (mut config, encoding) = pictures::read(given)?;
        config.validate().map_err(|problem| ParameterError {
            hint: Some(problem.hint),
            ..parameters::refused_at(&problem.path, problem.message)
        })?;
        let films = config.films();
        let items = match films.is_empty() {
            false => ItemRule::PerVariant { port: "trajectories", variants: films },
            true => ItemRule::PerInput("trajectories"),
        };
        let sources = render_files::take_sources(&mut config);
        // Models, leaves and scans change no body around a flight.
        let bare = RenderConfig { models: vec![], season: None, mesh: None, splats: None, ..config.clone() };
        let nearby = nearby::part(&bare, canonical(&bare, parameters::canonical(&bare)), items.clone());
        let properties = StageProperties {
            version: 39,
            parameters: canonical(&config, parameters::joined_canonical(&config, &encoding, pictures::ENCODING)),
            sources,
            inputs: vec![ports::town(), nearby::trajectories(), nearby::port()],
            items,
            bytes_per_frame: pictures::bytes_per_frame(&config),
            files_per_item: 2,
            intermediate: &[PACK],
            needs: pictures::needs_of_offsets(&config),
            ..StageProperties::new(self.name(), StageRole::Films, FRAMES)
        };
        let stage = RenderStage { config, encoding, properties, scene: Memo::default(), idle: Mutex::default() };
        Ok(vec![nearby, StagePart { suffix: "", stage: Box::new(stage) }])
    }
}

/// Parameters for keys. A paired item is named after its own weather and reads no other: one more weather renders no old
/// one again.
fn canonical(config: &RenderConfig, all: serde_json::Value) -> serde_json::Value {
    if config.paired_weathers { parameters::without(all, RenderConfig::NOT_IN_KEY) } else { all }
}

struct RenderStage {
    config: RenderConfig,
    encoding: EncodingConfig,
    properties: StageProperties,
    scene: Memo<Scene>,
    /// Cameras that no task uses now.
    idle: Mutex<Vec<Rig>>,
}

/// Item of the walk that a flight follows: several drones behind one walk are variants of it.
fn walker(flight: &ItemName) -> ItemName {
    flight.without_variant().unwrap_or_else(|| flight.clone())
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
        let outcome = artifacts::FLIGHT.read(inputs, artifact)?;
        let film = context.id.item.variant().filter(|_| !self.config.films().is_empty());
        let config = self.config.of_camera(film);
        let (target, around) = (traffic::followed(inputs, artifact)?, traffic::around(inputs, artifact)?);
        let shooting = |trajectory: &Trajectory| Shooting::of(&config, trajectory, target.as_ref(), film);
        let (trajectory, shooting) = match filmable(&world, outcome, &shooting, (&config, context))? {
            Ok(filmed) => filmed,
            Err(reason) => {
                let rejection = Rejection {
                    trajectory_id: context.id.item.to_string(),
                    stage: artifact.id.stage.to_string(),
                    pedestrian_id: walker(&artifact.id.item).to_string(),
                    town: world.town.name.clone(),
                    reason,
                };
                return reject(outputs, rejection);
            }
        };
        let town_digest = inputs.one("town")?.blobs[artifacts::TOWN.blob].digest;
        // Buildings look the same in every flight through the town.
        let scene = self.scene.get(town_digest, || -> Result<_> {
            let models = render_files::read_models(&self.config, &context.sources)?;
            let scan = render_files::read_scan(&self.config, &context.sources, &world.town)?;
            let scene = Scene::with_models(&world.town, Seed(town_digest.0), &models);
            Ok(scene.in_season(self.config.season).with_scan(scan))
        })?;
        let crowd = Crowd::around(inputs)?.and_drones(inputs, artifact, &world, trajectory.track.dt_s)?;
        let crowd = crowd.dressed_for(&shooting);
        let place = Place { scene: &scene, world: &world, crowd: &crowd };
        let drones = artifacts::DRONES.find(inputs, artifact)?.unwrap_or_default().counted(&trajectory);
        let filmed = filmed_flight(trajectory.clone(), &config, &world.exact, (&around, drones));
        let seen = self.draw(outputs, context, &place, (&trajectory, &filmed), (&config, &shooting))?;
        let mut notes = notes_of(&crowd, &seen.sightings);
        let (on_card, mut warnings) = render_files::scan_notes(&self.config);
        let (found, more) = render_files::compared(&self.config, &scene, &trajectory, &seen.scan);
        notes.extend(found);
        warnings.extend(more);
        let mut town = TownInfo::of(&world.town, town_digest);
        town.synthetic.notes.extend(on_card);
        let pair = pair_info(&trajectory, film);
        let record = RenderedTrajectory {
            trajectory_id: context.id.item.to_string(),
            flight_id: artifact.name.to_string(),
            role: if pair.is_some() { Role::Perturbed } else { Role::Expert },
            // A trajectory has the name of the walk that it follows.
            pedestrian_id: walker(&artifact.id.item).to_string(),
            town,
            trajectory: filmed,
            camera_name: film.filter(|_| !self.config.cameras.is_empty()).map(str::to_owned),
            camera: shooting.camera,
            lens: config.lens,
            mount: shooting.mount,
            stereo: config.stereo,
            motion_blur: config.motion_blur,
            rolling_shutter: config.rolling_shutter,
            noise: shooting.noise,
            optics: shooting.optics,
            weather: shooting.weather,
            season: scene.season(),
            seed: Seed(context.seed).as_u64(),
            views: seen.views,
            visible_by_dense_rays: seen.by_dense_rays,
            outfit: (trajectory.track.radius_m > 0.0).then(|| outfit_of(shooting.body, &shooting.clothes_seed)),
            around: filmed_around(&around, &config),
            followed: target,
            others: crowd.into_bodies(),
            sightings: seen.sightings,
            bodies_3d: seen.bodies_3d,
            pair,
            begins_ns: config.begins_ns,
            every: config.every,
        };
        outputs.put("index", &record.to_bytes())?;
        Ok(Produced { notes, warnings, rejected: None })
    }
}

/// The expert of a perturbed flight, as published: in the same weather, by the same camera.
fn pair_info(trajectory: &Trajectory, film: Option<&str>) -> Option<PairInfo> {
    let expert = ItemName::own(trajectory.perturbation.as_ref()?.expert_item.as_str());
    Some(PairInfo { expert_id: film.map_or(expert.clone(), |film| expert.with_variant(film)).to_string() })
}

/// The flight and how it is filmed, or the reason why it cannot be.
fn filmable(
    world: &World,
    outcome: PlanOutcome,
    shooting: &dyn Fn(&Trajectory) -> Result<Shooting>,
    (config, context): (&RenderConfig, &TaskContext),
) -> Result<Result<(Trajectory, Shooting), String>> {
    let flight = match outcome {
        PlanOutcome::Planned(flight) => *flight,
        PlanOutcome::Rejected { reason, .. } => return Ok(Err(reason)),
    };
    let shooting = shooting(&flight)?;
    let film = FilmedFlight::new(&shooting, &flight, config);
    let (every, offset_s, step_s) = (config.every, config.begins_ns as f64 / 1e9, film.dt_s());
    if offset_s + 1e-9 > step_s {
        let camera = context.id.item.variant().unwrap_or_default();
        let message =
            format!("film `{camera}` begins `{offset_s}` s after its flight, with a picture every {step_s} s");
        let hint = format!("set its `offset_s` in `stages.{}.cameras` to less than {step_s}", context.id.stage);
        return Err(Diagnostic::new("camera-offset", Fault::Recipe, message).hint(hint));
    }
    let too_short = (film.frames().count() < 2 && (every > 1 || offset_s > 0.0))
        .then(|| format!("a film needs two pictures; one of every {every} frames, from {offset_s} s on, is one"));
    let inside = too_short.or_else(|| camera_inside(world, film.poses()));
    Ok(inside.map_or(Ok((flight, shooting)), Err))
}

/// Reason why a flight cannot be filmed: a camera in a wall would look out through it.
fn camera_inside(world: &World, poses: impl Iterator<Item = Pose>) -> Option<String> {
    poses.enumerate().find_map(|(frame, pose)| {
        let nearest = world.exact.nearest(pose.position_in_world, 0.0).filter(|nearest| nearest.distance_m < 0.0)?;
        let obstacle = &world.town.obstacles[nearest.primitive as usize];
        let (kind, id) = (kind_name(obstacle.kind), obstacle.object_id);
        Some(format!("the camera is inside of obstacle {id} ({kind}) at frame {frame}"))
    })
}

/// Views of the target, and people who were seen.
#[derive(Default)]
struct SeenPeople {
    views: Vec<TargetView>,
    by_dense_rays: Vec<Option<f64>>,
    sightings: Vec<Sighting>,
    bodies_3d: Vec<BodyInSpace>,
    scan: ScanTally,
}

/// Notes about the people around.
fn notes_of(crowd: &Crowd, sightings: &[Sighting]) -> BTreeMap<String, String> {
    if crowd.len() == 0 {
        return BTreeMap::new();
    }
    let seen: BTreeSet<u32> = sightings.iter().map(|sighting| sighting.other).collect();
    let words = format!("{} of {} nearby seen", seen.len(), crowd.len());
    BTreeMap::from([("others".to_owned(), words)])
}

/// Scene, town and people of a flight.
struct Place<'a> {
    scene: &'a Scene,
    world: &'a World,
    crowd: &'a Crowd,
}

/// A camera with its effects and renderer.
struct Rig {
    camera: Camera,
    config: RenderConfig,
    effects: Effects,
    renderer: Renderer,
}

impl RenderStage {
    /// Renders frame by frame into the `pack` blob; memory does not grow with the number of frames. Gives the views of the
    /// target in each frame, and the share of it that rays reach.
    fn draw(
        &self,
        outputs: &mut dyn OutputSink,
        context: &TaskContext,
        place: &Place<'_>,
        (trajectory, filmed): (&Trajectory, &Trajectory),
        (config, shooting): (&RenderConfig, &Shooting),
    ) -> Result<SeenPeople> {
        let Place { scene, world, crowd } = *place;
        let mut rig = self.take_rig(config, shooting.camera);
        rig.renderer.set_optics(shooting.optics);
        rig.effects.set_noise(shooting.noise);
        let Camera { width, height, .. } = shooting.camera;
        let largest_instance = largest_object_instance(&world.town).max(crowd.largest_instance());
        let film = &FilmedFlight::new(shooting, trajectory, config);
        let header = PackHeader {
            channels: config.channels.clone(),
            begins_ns: config.begins_ns,
            ..PackHeader::new(width, height, largest_instance, self.encoding, film.dt_s())
        };
        let frame_at = |frame: usize| {
            let time_s = film.time_s(frame);
            let others = move |offset_s: f64, list: &mut Vec<FigureInPicture>| crowd.at(time_s + offset_s, list);
            (move |offset_s: f64| film.moment(frame, offset_s), others)
        };
        let (mut seen, mut rays, mut about) = (SeenPeople::default(), BodyRays::default(), vec![]);
        outputs.stream(PACK, &mut |file| {
            seen = SeenPeople::default();
            let mut pack = FramePackWriter::new(file, &header)?;
            for (number, frame) in film.frames().enumerate() {
                context.check_cancelled()?;
                let noise_seed = Seed(context.seed).child("frame", frame as u64);
                let beside = [film.before(frame), film.after(frame)].map(|beside| beside.map(frame_at));
                let (moment, others) = frame_at(frame);
                let [previous, next] = beside
                    .each_ref()
                    .map(|beside| beside.as_ref().map(|(moment, others)| FrameBeside { moment, others }));
                let neighbours = Neighbours { previous, next };
                let shot =
                    Shot { weather: &shooting.weather, moment: &moment, others: &others, neighbours, noise_seed };
                let rendered = rig.effects.film(&mut rig.renderer, scene, &shot);
                pack.frame(rendered.images)?;
                let sightings = crowd.sightings(number, film.time_s(frame), rendered.others);
                let view = rendered.target_view;
                let Moment { pose, target } = moment(0.0);
                let target = target.filter(|_| view.in_view);
                about.clear();
                crowd.at(film.time_s(frame), &mut about);
                if config.bodies_3d {
                    let (images, camera, lens) = (rendered.images, shooting.camera, config.lens);
                    let all = target.map(|figure| FigureInPicture { figure, instance: TARGET_INSTANCE });
                    let taken = Taken { frame: number, images, camera, lens, pose };
                    seen.bodies_3d.extend(taken.bodies(all.into_iter().chain(about.iter().copied())));
                }
                seen.by_dense_rays.push(target.and_then(|it| {
                    let (camera, pose) = body_rays::aimed(&config.lens, &shooting.camera, &pose, &it);
                    rays.visible_share(&world.exact, &about, &camera, &pose, &it)
                }));
                seen.views.push(TargetView { visible_by_rays: filmed.visibility[number], ..view });
                seen.sightings.extend(sightings);
                seen.scan.add(&rig.renderer);
            }
            pack.finish().map(drop)
        })?;
        self.idle.lock().unwrap_or_else(PoisonError::into_inner).push(rig);
        Ok(seen)
    }

    fn take_rig(&self, config: &RenderConfig, camera: Camera) -> Rig {
        let mut idle = self.idle.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(position) = idle.iter().position(|rig| rig.camera == camera && rig.config == *config) {
            return idle.swap_remove(position);
        }
        // Another camera: its buffers replace those of one that is not in use.
        idle.pop();
        drop(idle);
        let effects = config.effects(camera);
        let mut renderer = Renderer::new(effects.ideal_camera());
        renderer.set_look(config.look);
        renderer.set_channels(&config.channels);
        Rig { camera, config: config.clone(), effects, renderer }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_frames::DVec3;

    #[test]
    fn a_camera_in_a_wall_is_named_with_its_frame() {
        let town = cosfly_sample::town();
        let wall = town.obstacles[0].shape.center_in_world;
        let world = World::new(town);
        let at = |position: DVec3| Pose::looking_at(position, position + DVec3::X);
        let poses = [at(wall + 5.0 * DVec3::Z), at(wall + 0.1 * DVec3::Z), at(wall)];
        let reason = camera_inside(&world, poses.iter().copied()).expect("it is inside");
        assert_eq!(reason, "the camera is inside of obstacle 4 (wall) at frame 1");
        assert_eq!(camera_inside(&world, poses[..1].iter().copied()), None);
    }

    #[test]
    fn predicted_bytes_are_those_of_the_cameras_that_film() {
        let bytes = |given: serde_json::Value| Render.build(given).unwrap()[1].stage.properties().bytes_per_frame;
        let small = bytes(serde_json::json!({"width": 64, "height": 32}));
        assert_eq!(bytes(serde_json::json!({"cameras": {"a": {"width": 64, "height": 32}}})), small);
        assert_eq!(bytes(serde_json::json!({"cameras": {"a": {"width": 64, "height": 32, "every": 4}}})), small / 4);
        assert!(bytes(serde_json::json!({})) > 50 * small);
    }
}
