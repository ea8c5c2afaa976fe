//! Small stage kinds with declarations and without work, and recipes of them.

use crate::toy_configs::{MapConfig, NoConfig, Speed, TracksConfig, WalkersConfig};
use cosfly_blobs::OutputSink;
use cosfly_diagnose::ParameterError;
use cosfly_recipe::Recipe;
use cosfly_stage::{
    Fan, InputPort, Inputs, ItemRule, PortSource, Produced, Registry, Sees, Source, Stage, StageKind, StagePart,
    StageProperties, StageRole, Takes, TaskContext,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::Path;

pub struct ToyStage(pub StageProperties);

impl Stage for ToyStage {
    fn properties(&self) -> &StageProperties {
        &self.0
    }
    fn run(&self, _: &Inputs<'_>, _: &mut dyn OutputSink, _: &TaskContext) -> cosfly_diagnose::Result<Produced> {
        Ok(Produced::default())
    }
}

type Build = fn(&Toy, serde_json::Value) -> Result<Vec<StagePart>, ParameterError>;

/// A stage kind defined by data.
pub struct Toy {
    pub name: &'static str,
    pub doc: &'static str,
    pub artifact: &'static str,
    pub ports: Vec<InputPort>,
    pub items: ItemRule,
    pub schema: fn() -> serde_json::Value,
    pub build: Build,
}

impl StageKind for Toy {
    fn name(&self) -> &'static str {
        self.name
    }
    fn doc(&self) -> &'static str {
        self.doc
    }
    fn schema(&self) -> serde_json::Value {
        (self.schema)()
    }
    fn ports(&self) -> Vec<InputPort> {
        self.ports.clone()
    }
    fn build(&self, parameters: serde_json::Value) -> Result<Vec<StagePart>, ParameterError> {
        (self.build)(self, parameters)
    }
}

impl Toy {
    fn properties(&self, parameters: impl Serialize) -> StageProperties {
        StageProperties {
            parameters: serde_json::to_value(parameters).unwrap(),
            inputs: self.ports.clone(),
            items: self.items.clone(),
            bytes_per_item: 1,
            ..StageProperties::new(self.name, StageRole::Changes, self.artifact)
        }
    }

    fn parse<T: for<'de> Deserialize<'de>>(&self, parameters: serde_json::Value) -> Result<T, ParameterError> {
        serde_json::from_value(parameters).map_err(|error| ParameterError {
            path: vec![],
            message: format!("the schema let it pass: {error}"),
            hint: None,
        })
    }
}

fn one_part(properties: StageProperties) -> Vec<StagePart> {
    vec![StagePart { suffix: "", stage: Box::new(ToyStage(properties)) }]
}

fn plain(toy: &Toy, parameters: serde_json::Value) -> Result<Vec<StagePart>, ParameterError> {
    let config: NoConfig = toy.parse(parameters)?;
    Ok(one_part(toy.properties(config)))
}

fn map(toy: &Toy, parameters: serde_json::Value) -> Result<Vec<StagePart>, ParameterError> {
    let config: MapConfig = toy.parse(parameters)?;
    let source = Source::new("source", config.source.clone());
    Ok(one_part(StageProperties { sources: vec![source], ..toy.properties(config) }))
}

fn tracks(toy: &Toy, parameters: serde_json::Value) -> Result<Vec<StagePart>, ParameterError> {
    let config: TracksConfig = toy.parse(parameters)?;
    let source = Source::new("file", config.file.clone());
    Ok(one_part(StageProperties { sources: vec![source], ..toy.properties(config) }))
}

fn walkers(toy: &Toy, parameters: serde_json::Value) -> Result<Vec<StagePart>, ParameterError> {
    let config: WalkersConfig = toy.parse(parameters)?;
    let Speed { min_mps, max_mps } = config.speed;
    if min_mps > max_mps {
        return Err(ParameterError {
            path: vec!["speed".into(), "min_mps".into()],
            message: format!("`speed.min_mps` is `{min_mps}`, above `speed.max_mps`, which is `{max_mps}`"),
            hint: Some("lower it or raise `speed.max_mps`".into()),
        });
    }
    let items = ItemRule::Count { prefix: "path", count: config.count };
    Ok(one_part(StageProperties { items, ..toy.properties(config) }))
}

fn dataset(toy: &Toy, parameters: serde_json::Value) -> Result<Vec<StagePart>, ParameterError> {
    let config: NoConfig = toy.parse(parameters)?;
    let frames = port("frames", "frames/1", Fan::Each).distinct();
    let logs = StageProperties {
        inputs: vec![frames.clone()],
        artifact: "log/1",
        items: ItemRule::PerInput("frames"),
        ..toy.properties(&config)
    };
    let own = InputPort { source: PortSource::Sibling("logs"), ..port("logs", "log/1", Fan::Gather) };
    let tables = StageProperties { inputs: vec![gather(frames), own], ..toy.properties(&config) };
    Ok(vec![
        StagePart { suffix: "logs", stage: Box::new(ToyStage(logs)) },
        StagePart { suffix: "", stage: Box::new(ToyStage(tables)) },
    ])
}

pub fn port(name: &'static str, artifact: &'static str, fan: Fan) -> InputPort {
    let doc = match name {
        "town" => "The town.",
        "target" => "Who is followed.",
        _ => "What is shown.",
    };
    InputPort {
        name,
        artifact,
        fan,
        takes: Takes::One,
        optional: false,
        source: PortSource::Recipe,
        sees: Sees::All,
        doc,
    }
}

fn gather(port: InputPort) -> InputPort {
    InputPort { fan: Fan::Gather, ..port }
}

/// Changes to a port, for short lists.
pub trait PortWords {
    fn many(self) -> Self;
    fn distinct(self) -> Self;
    fn optional(self) -> Self;
}

impl PortWords for InputPort {
    fn many(self) -> Self {
        Self { takes: Takes::Named, ..self }
    }
    fn distinct(self) -> Self {
        Self { takes: Takes::Distinct, ..self }
    }
    fn optional(self) -> Self {
        Self { optional: true, ..self }
    }
}

fn schema_of<T: JsonSchema>() -> serde_json::Value {
    schemars::schema_for!(T).into()
}

fn plain_toy(
    name: &'static str,
    doc: &'static str,
    artifact: &'static str,
    ports: Vec<InputPort>,
    items: ItemRule,
) -> Toy {
    Toy { name, doc, artifact, ports, items, schema: schema_of::<NoConfig>, build: plain }
}

fn renderers() -> Vec<Toy> {
    let town = port("town", "town/1", Fan::Broadcast);
    vec![
        plain_toy(
            "weathers",
            "Draws each trajectory in several weathers.",
            "frames/1",
            vec![
                port("trajectories", "trajectory/1", Fan::Each).many(),
                port("also", "trajectory/1", Fan::Each).many().optional(),
            ],
            ItemRule::PerVariant { port: "trajectories", variants: vec!["Noon".to_owned(), "Night".to_owned()] },
        ),
        plain_toy(
            "render",
            "Draws what is seen.",
            "frames/1",
            vec![
                town.optional(),
                port("trajectories", "trajectory/1", Fan::Each).many(),
                port("also", "trajectory/1", Fan::Each).many().optional(),
            ],
            ItemRule::PerInput("trajectories"),
        ),
    ]
}

/// All toys.
pub fn registry() -> Registry {
    let town = || port("town", "town/1", Fan::Broadcast);
    let mut toys = vec![
        Toy {
            schema: schema_of::<MapConfig>,
            build: map,
            ..plain_toy("map", "Reads a town.", "town/1", vec![], ItemRule::One)
        },
        Toy {
            schema: schema_of::<WalkersConfig>,
            build: walkers,
            ..plain_toy("walkers", "People who walk.", "track/1", vec![town()], ItemRule::One)
        },
        Toy {
            schema: schema_of::<TracksConfig>,
            build: tracks,
            ..plain_toy("tracks", "Reads tracks.", "track/1", vec![], ItemRule::One)
        },
        plain_toy("blocks", "Makes towns.", "town/1", vec![], ItemRule::Count { prefix: "block", count: 2 }),
        plain_toy(
            "expert",
            "Follows a track.",
            "trajectory/1",
            vec![town(), port("target", "track/1", Fan::Each)],
            ItemRule::PerInput("target"),
        ),
        Toy {
            build: dataset,
            ..plain_toy(
                "dataset",
                "Writes tables.",
                "dataset/1",
                vec![port("frames", "frames/1", Fan::Gather).distinct()],
                ItemRule::One,
            )
        },
    ];
    toys.extend(renderers());
    Registry::new(toys.into_iter().map(|toy| Box::new(toy) as Box<dyn StageKind>).collect())
}

/// A recipe with all toys.
pub const WHOLE: &str = r#"name = "whole"
seed = 7

[stages.town]
use = "map"
source = "town.xodr"

[stages.people]
use = "walkers"
inputs.town = "town"
count = 3

[stages.expert]
use = "expert"
inputs = { town = "town", target = "people" }

[stages.second]
use = "expert"
inputs = { town = "town", target = "people" }

[stages.frames]
use = "render"
inputs.town = "town"
inputs.trajectories = ["expert", "second"]

[stages.tables]
use = "dataset"
inputs.frames = "frames"
"#;

/// Errors that [`cosfly_recipe::read`] reports.
type Complaints = Vec<Box<cosfly_diagnose::Diagnostic>>;

/// Reads `text` as if it were in a folder with the file `town.xodr`.
pub fn check(text: &str, overrides: &[&str]) -> Result<Recipe, Complaints> {
    let overrides: Vec<String> = overrides.iter().map(|text| (*text).to_owned()).collect();
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("town.xodr"), "<OpenDRIVE/>").unwrap();
    std::fs::create_dir(folder.path().join("folder")).unwrap();
    cosfly_recipe::read(&folder.path().join("a.toml"), text, &overrides, &registry()).map_err(|mut problems| {
        // Redaction: the temporary folder.
        let gone = format!("{}/", folder.path().display());
        let bare = gone.trim_end_matches('/').to_owned();
        for problem in &mut problems {
            problem.message = problem.message.replace(&gone, "").replace(&bare, "FOLDER");
            problem.hints.iter_mut().for_each(|hint| *hint = hint.replace(&gone, "").replace(&bare, "FOLDER"));
            for label in &mut problem.labels {
                label.path = label.path.strip_prefix(&gone).map(Path::to_path_buf).unwrap_or(label.path.clone());
            }
        }
        problems
    })
}

/// Errors of `text` as printed for users.
pub fn complaint(text: &str, overrides: &[&str]) -> String {
    match check(text, overrides) {
        Ok(recipe) => format!("no complaint about {recipe:?}"),
        Err(problems) => cosfly_diagnose::render_all(problems.iter().map(|problem| &**problem), false),
    }
}

/// A recipe that ends in the parameters of walkers.
pub const PEOPLE: &str = r#"name = "t"
[stages.town]
use = "map"
source = "town.xodr"
[stages.people]
use = "walkers"
inputs.town = "town"
"#;

/// Errors of [`PEOPLE`] with the parameters `more`, as printed for users.
pub fn complaint_about_people(more: &str) -> String {
    complaint(&format!("{PEOPLE}{more}"), &[])
}
