//! `sense`: readings of a sensor that is no camera along every rendered flight, as a table of the dataset.

use crate::plugin::EXTRA;
use crate::ports::{self, EXTRAS, FRAMES, WALK};
use crate::rejections::handed_on;
use crate::{nearby, single};
use cosfly_blobs::OutputSink;
use cosfly_diagnose::{Diagnostic, Fault, ParameterError, Result};
use cosfly_domain::{TARGET_INSTANCE, Traffic};
use cosfly_experts::codec;
use cosfly_experts::world::{check_same_town, world};
use cosfly_film::BodyOnTrack;
use cosfly_film::nearby::{Candidates, NearbyCandidate};
use cosfly_flight::World;
use cosfly_frames::Seed;
use cosfly_schema::RenderedTrajectory;
use cosfly_schema::extras::{Extra, ExtraSource, check_names};
use cosfly_schema::flight_table::{ColumnKind, DeclaredColumn, MOST_ROWS, Values};
use cosfly_sensors::{Carrier, GeoOrigin, SenseConfig, SensedFlight, Sensor};
use cosfly_stage::parameters;
use cosfly_stage::{
    InputPort, Inputs, ItemRule, Produced, Stage, StageKind, StagePart, StageProperties, StageRole, Takes, TaskContext,
};
use cosfly_write::unread;
use std::collections::{BTreeMap, BTreeSet};

/// Blob with readings, for logs: that of [`EXTRA`] once more.
pub const READINGS: &str = "readings";

/// Bytes of a stored number of a reading, as measured; for predictions.
const BYTES_PER_VALUE: u64 = 8;

/// Stage kind `sense`.
pub struct Sense;

impl StageKind for Sense {
    fn name(&self) -> &'static str {
        "sense"
    }

    fn doc(&self) -> &'static str {
        "Reads a sensor that is no camera along every rendered flight; the dataset has its readings as a table and in the logs."
    }

    fn schema(&self) -> serde_json::Value {
        parameters::schema_of::<SenseConfig>()
    }

    fn ports(&self) -> Vec<InputPort> {
        flight_ports()
    }

    fn build(&self, given: serde_json::Value) -> Result<Vec<StagePart>, ParameterError> {
        let config: SenseConfig = parameters::read(given)?;
        let unknown = || parameters::refused_at("sensor", format!("there is no sensor `{}`", config.sensor));
        let sensor = config.sensor().ok_or_else(unknown)?;
        if config.levelled && sensor.carrier == Carrier::Airframe {
            let message = format!("`{}` is fixed to the airframe, which tilts: leave the key out", sensor.name);
            return Err(parameters::refused_at("levelled", message));
        }
        let source = source_of(sensor, &config);
        check_names(&source.name, &source.columns).map_err(|rule| parameters::refused_at("table", rule))?;
        let mut canonical = parameters::canonical(&config);
        canonical["version"] = sensor.version.into();
        let reading = BYTES_PER_VALUE * source.columns.len() as u64;
        let properties = StageProperties {
            version: 2,
            parameters: canonical,
            inputs: self.ports(),
            items: ItemRule::PerInput("frames"),
            bytes_per_frame: if config.rate_hz.is_none() { reading } else { 0 },
            bytes_per_s: config.rate_hz.map_or(0, |rate_hz| (reading as f64 * rate_hz) as u64),
            files_per_item: 2,
            gives: Some(source.name.clone()),
            needs: cosfly_experts::pictures::needs_camera(config.camera.as_deref()),
            ..StageProperties::new(self.name(), StageRole::Speaks, EXTRAS)
        };
        Ok(single(SenseStage { config, sensor, source, properties }))
    }
}

/// Ports of stages that follow rendered flights: their town, the flights, and who else is about.
pub fn flight_ports() -> Vec<InputPort> {
    let doc = "The rendered flights, one item each, of one stage or of several.";
    let others = "People and vehicles who are met: the stages that the pictures show; nobody else, when left out.";
    let frames = InputPort { takes: Takes::Distinct, ..ports::each("frames", FRAMES, false, doc) };
    let others = InputPort { optional: true, ..ports::gather("others", WALK, true, others) };
    vec![ports::town(), ports::without_pictures(frames), others]
}

/// The table of a sensor: frame and time, then its numbers and the true ones.
fn source_of(sensor: &Sensor, config: &SenseConfig) -> ExtraSource {
    let column = |name: &str, kind, doc: &str| DeclaredColumn { name: name.to_owned(), kind, doc: doc.to_owned() };
    let mut columns = vec![
        column("frame", ColumnKind::Integer, "frame at the time of the reading, or the last one before it"),
        column("time_s", ColumnKind::Real, "time since the first frame, seconds"),
    ];
    columns.extend(sensor.quantities.iter().chain(sensor.truths).map(|it| column(it.name, ColumnKind::Real, it.doc)));
    ExtraSource::of_sensor(config.table(), (sensor.name, sensor.version), sensor.doc, columns)
}

struct SenseStage {
    config: SenseConfig,
    sensor: &'static Sensor,
    source: ExtraSource,
    properties: StageProperties,
}

impl Stage for SenseStage {
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
        let people = people(inputs, &world, &record)?;
        let flown = SensedFlight {
            town: &world.exact,
            ground: &world.ground,
            bodies: &|time_s, list| list.extend(people.iter().filter_map(|(_, person)| person.box_at(time_s))),
            poses_in_world: &record.trajectory.poses_in_world,
            dt_s: record.trajectory.track.dt_s,
            place: self.config.place(),
            rate_hz: self.config.rate_hz,
            origin: GeoOrigin::of(&world.town.origin),
            seed: Seed(context.seed),
        };
        if flown.readings() > MOST_ROWS {
            let message = format!("a flight would have {} readings; {MOST_ROWS} are allowed", flown.readings());
            return Err(Diagnostic::new("sense-readings", Fault::Recipe, message).hint("set a lower `rate_hz`"));
        }
        let (mut at, mut times_s) = (vec![], vec![]);
        let mut numbers = vec![vec![]; self.sensor.count()];
        flown.read(self.sensor, &mut |reading| {
            at.push(reading.frame as i64);
            times_s.push(record.times().s(0) + reading.time_s);
            numbers.iter_mut().zip(reading.values).for_each(|(column, value)| column.push(*value));
        });
        let mut values = vec![Values::Integers(at), Values::Reals(times_s)];
        values.extend(numbers.into_iter().map(Values::Reals));
        put(outputs, &self.source, values)
    }
}

/// Writes what a sensor read along a film, for tables and for logs.
pub fn put(outputs: &mut dyn OutputSink, source: &ExtraSource, values: Vec<Values>) -> Result<Produced> {
    let notes = BTreeMap::from([("rows".to_owned(), values.first().map_or(0, Values::len).to_string())]);
    let extra = codec::encode(EXTRAS, &Extra { source: source.clone(), values })?;
    [EXTRA, READINGS].into_iter().try_for_each(|name| outputs.put(name, &extra))?;
    Ok(Produced { notes, ..Produced::default() })
}

/// Everybody whom sensors may meet, with instance ids as in pictures: those at port `others` who are in the pictures or nobody's way, the
/// traffic around the target, and the target.
pub fn people(inputs: &Inputs<'_>, world: &World, record: &RenderedTrajectory) -> Result<Vec<(u32, BodyOnTrack)>> {
    let (flight, target) = (&record.trajectory, record.followed.as_ref());
    let mut candidates = Candidates::new(&world.town, (flight, record.times().s(0)), target);
    for (stage, artifacts) in inputs.all("others").chunk_by(|a, b| a.id.stage == b.id.stage).enumerate() {
        // The followed walk is left out like all that cross the target's body.
        nearby::add(inputs, &mut candidates, (stage, artifacts), None)?;
    }
    let seen: BTreeSet<u32> = record.others.iter().map(|other| other.instance).collect();
    let others = candidates.sensed(&seen);
    let around = &record.around;
    let of_traffic = around.bodies().map(|(number, body)| {
        let body_id = Traffic::body_id(&around.traffic.name, number);
        let seen = record.others.iter().find(|other| other.body_id == body_id);
        (seen.map_or(u32::MAX - number, |other| other.instance), BodyOnTrack::of(body, around.traffic.dt_s))
    });
    let target = (flight.track.radius_m > 0.0).then(|| (TARGET_INSTANCE, BodyOnTrack::target(&flight.track, target)));
    let others = others.into_iter().map(|it| (it.instance, NearbyCandidate::into_body(it)));
    Ok(others.chain(of_traffic).chain(target).collect())
}
