//! `scan`: sweeps of a lidar along every rendered flight, as a table of the dataset.

use crate::ports::EXTRAS;
use crate::rejections::handed_on;
use crate::sense::{flight_ports, people, put};
use crate::single;
use cosfly_blobs::OutputSink;
use cosfly_diagnose::{Diagnostic, Fault, ParameterError, Result};
use cosfly_domain::TARGET_INSTANCE;
use cosfly_experts::artifacts;
use cosfly_experts::memo::Memo;
use cosfly_experts::world::{check_same_town, world};
use cosfly_figures::{FigureInPicture, clothes_seed_of_target};
use cosfly_film::looks::walk_seed;
use cosfly_frames::Seed;
use cosfly_render::{Scene, SceneTriangle};
use cosfly_schema::RenderedTrajectory;
use cosfly_schema::extras::{ExtraSource, check_names};
use cosfly_schema::flight_table::MOST_ROWS;
use cosfly_schema::log::cloud::{self, CloudPoint, SweepRows};
use cosfly_sensors::lidar::{
    LidarPattern, LidarPoint, LidarScene, LidarTriangle, MOST_BEAMS, ScanConfig, ScannedFlight,
};
use cosfly_stage::{InputPort, Inputs, ItemRule, Produced, Stage, StageKind, StagePart};
use cosfly_stage::{StageProperties, StageRole, TaskContext, parameters};
use cosfly_write::unread;

/// Bytes of a stored point, and echoes of a hundred beams, as measured behind people in towns; for predictions.
const BYTES_PER_POINT: u64 = 18;
const ECHOES_OF_100: u64 = 75;
/// Meaning of a lidar that is no device of the list.
const OWN_DOC: &str = "Lidar with a pattern of the recipe.";

/// Stage kind `scan`.
pub struct Scan;

impl StageKind for Scan {
    fn name(&self) -> &'static str {
        "scan"
    }

    fn doc(&self) -> &'static str {
        "Scans with a lidar along every rendered flight; the dataset has its sweeps as a table and in the logs."
    }

    fn schema(&self) -> serde_json::Value {
        parameters::schema_of::<ScanConfig>()
    }

    fn ports(&self) -> Vec<InputPort> {
        flight_ports()
    }

    fn build(&self, given: serde_json::Value) -> Result<Vec<StagePart>, ParameterError> {
        let config: ScanConfig = parameters::read(given)?;
        let pattern = config.read_pattern().map_err(|it| parameters::refused_at(it.key, it.reason))?;
        let (device, doc) = config.device().map_or((("lidar", 1), OWN_DOC), |it| ((it.name, it.version), it.doc));
        let source = ExtraSource::of_sensor(config.table(), device, doc, cloud::columns());
        check_names(&source.name, &source.columns).map_err(|rule| parameters::refused_at("table", rule))?;
        let mut canonical = parameters::canonical(&config);
        canonical["version"] = source.version.clone().into();
        let properties = StageProperties {
            version: 6,
            parameters: canonical,
            inputs: self.ports(),
            items: ItemRule::PerInput("frames"),
            bytes_per_s: ECHOES_OF_100 * BYTES_PER_POINT * pattern.beams() as u64 * u64::from(pattern.shots_hz) / 100,
            files_per_item: 2,
            gives: Some(source.name.clone()),
            needs: cosfly_experts::pictures::needs_camera(config.camera.as_deref()),
            ..StageProperties::new(self.name(), StageRole::Speaks, EXTRAS)
        };
        Ok(single(ScanStage { config, pattern, source, properties, scene: Memo::default() }))
    }
}

struct ScanStage {
    config: ScanConfig,
    pattern: LidarPattern,
    source: ExtraSource,
    properties: StageProperties,
    scene: Memo<LidarScene>,
}

impl Stage for ScanStage {
    fn properties(&self) -> &StageProperties {
        &self.properties
    }

    fn run(&self, inputs: &Inputs<'_>, outputs: &mut dyn OutputSink, context: &TaskContext) -> Result<Produced> {
        check_same_town(inputs, "frames")?;
        check_same_town(inputs, "others")?;
        let frames = inputs.one("frames")?;
        if let Some(rejected) = handed_on(inputs, outputs, frames)? {
            return Ok(rejected);
        }
        let record = RenderedTrajectory::from_bytes(&inputs.read(frames, "index")?)?;
        if let Some(values) = unread(&record, self.config.camera.as_deref(), &self.source) {
            return put(outputs, &self.source, values);
        }
        let world = world(inputs)?;
        let town = inputs.one("town")?.blobs[artifacts::TOWN.blob].digest;
        let scene = self.scene.get(town, || -> Result<_> {
            let triangles = Scene::new(&world.town, Seed(town.0)).triangles();
            Ok(LidarScene::new(&triangles.into_iter().map(met).collect::<Vec<_>>()))
        })?;
        let (people, rain) = (people(inputs, &world, &record)?, record.weather.precipitation);
        let looks =
            record.followed.as_ref().map_or_else(|| walk_seed(&record.trajectory.track), |it| Ok(it.plan.looks))?;
        let clothes_seed = clothes_seed_of_target(&looks, 0.0);
        let body = |time_s: f64, (instance, person): &(u32, cosfly_film::BodyOnTrack)| {
            let mut figure = person.figure(time_s)?;
            if *instance == TARGET_INSTANCE {
                figure.clothes_seed = clothes_seed;
            }
            figure.body = figure.body.in_rain(rain, &figure.clothes_seed);
            Some(FigureInPicture { figure, instance: *instance })
        };
        let flight = ScannedFlight {
            scene: &scene,
            bodies: &|time_s, list| list.extend(people.iter().filter_map(|person| body(time_s, person))),
            poses_in_world: &record.trajectory.poses_in_world,
            dt_s: record.trajectory.track.dt_s,
            place: self.config.place(),
            rate_hz: self.config.rate_hz(),
            weather: &record.weather,
            seed: Seed(context.seed),
        };
        let (sweeps, beams) = (flight.sweeps(), flight.beams(&self.pattern));
        if beams > MOST_BEAMS || sweeps > MOST_ROWS {
            let message =
                format!("a flight would have {sweeps} sweeps, {beams} beams; {MOST_ROWS}, {MOST_BEAMS} are allowed");
            let hint = "choose a device with fewer shots or sweeps a second, or shorter walks";
            return Err(Diagnostic::new("sense-readings", Fault::Recipe, message).hint(hint));
        }
        let mut rows = SweepRows::default();
        flight.scan(&self.pattern, &mut |sweep| {
            rows.add(sweep.frame, record.times().s(0) + sweep.time_s, &sweep.pose(), sweep.points.iter().map(written));
        });
        put(outputs, &self.source, rows.into_values())
    }
}

fn met(SceneTriangle { corners_in_world, label, instance }: SceneTriangle) -> LidarTriangle {
    LidarTriangle { corners_in_world, label, instance }
}

fn written(point: &LidarPoint) -> CloudPoint {
    let LidarPoint { place_m, intensity, time_s, ring, label, instance } = *point;
    CloudPoint { place_m, intensity, time_s, ring, label: label.into(), instance }
}
