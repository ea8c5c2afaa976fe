//! `sense`: readings of a sensor that is no camera along every rendered flight, as a table of the dataset.

use crate::plugin::EXTRA;
use crate::ports::{self, EXTRAS, FRAMES};
use crate::rejections::handed_on;
use crate::single;
use crate::world::{check_same_town, world};
use cosfly_blobs::OutputSink;
use cosfly_diagnose::{Diagnostic, Fault, ParameterError, Result};
use cosfly_experts::codec;
use cosfly_frames::Seed;
use cosfly_schema::RenderedTrajectory;
use cosfly_schema::extras::{Extra, ExtraShape, ExtraSource, check_names};
use cosfly_schema::flight_table::{ColumnKind, DeclaredColumn, MOST_ROWS, Values};
use cosfly_sensors::{Flown, SenseConfig, Sensor};
use cosfly_stage::parameters;
use cosfly_stage::{
    InputPort, Inputs, ItemRule, Produced, Resources, Stage, StageKind, StagePart, StageProperties, StageRole,
    TaskContext,
};
use std::collections::BTreeMap;

/// Stage kind `sense`.
pub struct Sense;

impl StageKind for Sense {
    fn name(&self) -> &'static str {
        "sense"
    }

    fn doc(&self) -> &'static str {
        "Reads a sensor that is no camera along every rendered flight; the dataset has its readings as a table."
    }

    fn schema(&self) -> serde_json::Value {
        parameters::schema_of::<SenseConfig>()
    }

    fn ports(&self) -> Vec<InputPort> {
        let doc = "The rendered flights, one item each.";
        vec![ports::town(), ports::without_pictures(ports::each("frames", FRAMES, false, doc))]
    }

    fn build(&self, given: serde_json::Value) -> Result<Vec<StagePart>, ParameterError> {
        let config: SenseConfig = parameters::read(given)?;
        let unknown = || parameters::refused_at("sensor", format!("there is no sensor `{}`", config.sensor));
        let sensor = config.sensor().ok_or_else(unknown)?;
        let source = source_of(sensor, &config);
        check_names(&source.name, &source.columns).map_err(|rule| parameters::refused_at("table", rule))?;
        let mut canonical = parameters::canonical(&config);
        canonical["version"] = sensor.version.into();
        let properties = StageProperties {
            kind: self.name().into(),
            version: 1,
            parameters: canonical,
            sources: vec![],
            inputs: self.ports(),
            artifact: EXTRAS,
            items: ItemRule::PerInput("frames"),
            bytes_per_item: 20_000,
            files_per_item: 1,
            intermediate: &[],
            asks: None,
            role: StageRole::Speaks,
            resources: Resources::default(),
        };
        Ok(single(SenseStage { config, sensor, source, properties }))
    }
}

/// The table of a sensor: frame and time, then its numbers.
fn source_of(sensor: &Sensor, config: &SenseConfig) -> ExtraSource {
    let column = |name: &str, kind, doc: &str| DeclaredColumn { name: name.to_owned(), kind, doc: doc.to_owned() };
    let mut columns = vec![
        column("frame", ColumnKind::Integer, "frame at the time of the reading, or the last one before it"),
        column("time_s", ColumnKind::Real, "time since the first frame, seconds"),
    ];
    columns.extend(sensor.quantities.iter().map(|it| column(it.name, ColumnKind::Real, it.doc)));
    ExtraSource {
        name: config.table().to_owned(),
        shape: ExtraShape::Readings,
        columns,
        plugin: sensor.name.to_owned(),
        version: sensor.version.to_string(),
        summary: sensor.doc.to_owned(),
    }
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
        let frames = inputs.one("frames")?;
        if let Some(rejected) = handed_on(inputs, outputs, frames)? {
            return Ok(rejected);
        }
        let record = RenderedTrajectory::from_bytes(&inputs.read(frames, "index")?)?;
        let flown = Flown {
            world: &*world(inputs)?,
            poses_in_world: &record.trajectory.poses_in_world,
            dt_s: record.trajectory.track.dt_s,
            place: self.config.place(),
            rate_hz: self.config.rate_hz,
            seed: Seed(context.seed),
        };
        if flown.readings() > MOST_ROWS {
            let message = format!("a flight would have {} readings; {MOST_ROWS} are allowed", flown.readings());
            return Err(Diagnostic::new("sense-readings", Fault::Recipe, message).hint("set a lower `rate_hz`"));
        }
        let (mut at, mut times_s) = (vec![], vec![]);
        let mut numbers = vec![vec![]; self.sensor.quantities.len()];
        flown.read(self.sensor, &mut |reading| {
            at.push(reading.frame as i64);
            times_s.push(reading.time_s);
            numbers.iter_mut().zip(reading.values).for_each(|(column, value)| column.push(*value));
        });
        let notes = BTreeMap::from([("rows".to_owned(), at.len().to_string())]);
        let mut values = vec![Values::Integers(at), Values::Reals(times_s)];
        values.extend(numbers.into_iter().map(Values::Reals));
        outputs.put(EXTRA, &codec::encode(EXTRAS, &Extra { source: self.source.clone(), values })?)?;
        Ok(Produced { notes, ..Produced::default() })
    }
}
