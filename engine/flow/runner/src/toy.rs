//! Cheap stages for measuring the engine and for its laws.

use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_fingerprint::Digest;
use cosfly_recipe::{Arrival, Connection, ItemIds, Recipe, RecipeStage, SourceFile};
use cosfly_stage::{
    Fan, InputPort, Inputs, ItemRule, OutputSink, PortSource, Produced, Source, Stage, StageProperties, Takes,
    TaskContext,
};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Called at the start of a run of an item, to count, wait or fail.
pub(crate) type Hook = Arc<dyn Fn(&TaskContext) -> Result<()> + Send + Sync>;

/// Writes bytes that depend on everything it is given.
struct ToyStage {
    properties: StageProperties,
    hook: Hook,
}

impl Stage for ToyStage {
    fn properties(&self) -> &StageProperties {
        &self.properties
    }

    fn run(&self, inputs: &Inputs<'_>, outputs: &mut dyn OutputSink, context: &TaskContext) -> Result<Produced> {
        (self.hook)(context)?;
        let parameters = &self.properties.parameters;
        let mut text = String::new();
        if parameters["constant"] == Value::Null {
            text = format!("{parameters} {:?} ", Digest(context.seed));
        }
        for (port, group) in &inputs.ports {
            for artifact in &group.artifacts {
                for name in artifact.blobs.keys() {
                    let bytes = inputs.read(artifact, name)?;
                    text.push_str(&format!("{port} {} {:?} ", artifact.item, Digest::of(&bytes)));
                }
            }
        }
        for source in &context.sources {
            let bytes = std::fs::read(source).map_err(|error| Diagnostic::io("read a toy's source", &error))?;
            text.push_str(&format!("{:?} ", Digest::of(&bytes)));
        }
        if let Some(path) = parameters["undeclared"].as_str() {
            // What a stage must not do: the law of equal bytes catches it.
            text.push_str(&std::fs::read_to_string(path).map_err(|error| Diagnostic::io("read a toy's file", &error))?);
        }
        let wanted = usize::try_from(parameters["bytes"].as_u64().unwrap_or(0)).unwrap_or(0);
        let mut bytes = text.into_bytes();
        bytes.resize(bytes.len().max(wanted), b'.');
        outputs.put("out", &bytes)?;
        let warnings = parameters["warning"].as_str().map(str::to_owned).into_iter().collect();
        let rejected = parameters["rejected"].as_str().map(str::to_owned);
        Ok(Produced { warnings, rejected, ..Produced::default() })
    }
}

/// One stage of a toy recipe.
pub(crate) struct Toy {
    pub(crate) name: &'static str,
    pub(crate) version: u32,
    pub(crate) parameters: Value,
    /// (stage index, how its items meet ours).
    pub(crate) inputs: Vec<(usize, Fan)>,
    /// Items, unless an input of [`Fan::Each`] gives them.
    pub(crate) items: usize,
    pub(crate) sources: Vec<PathBuf>,
    pub(crate) hook: Hook,
}

impl Toy {
    /// A stage that does nothing special.
    pub(crate) fn new(name: &'static str, items: usize, inputs: &[(usize, Fan)]) -> Self {
        Self {
            name,
            version: 1,
            parameters: Value::Object(serde_json::Map::new()),
            inputs: inputs.to_vec(),
            items,
            sources: Vec::new(),
            hook: Arc::new(|_| Ok(())),
        }
    }
}

/// Port names of toys: one per input.
const PORTS: [&str; 4] = ["a", "b", "c", "d"];

/// A recipe of toys, in dependency order.
pub(crate) fn toy_recipe(name: &str, seed: u64, toys: &[Toy]) -> Result<Recipe> {
    let mut stages: Vec<RecipeStage> = Vec::new();
    for toy in toys {
        let stage = toy_stage(toy, &stages)?;
        stages.push(stage);
    }
    Ok(Recipe {
        name: name.to_owned(),
        seed,
        path: Path::new(name).with_extension("toml"),
        directory: PathBuf::new(),
        text: Arc::from(""),
        stages,
    })
}

fn toy_stage(toy: &Toy, earlier: &[RecipeStage]) -> Result<RecipeStage> {
    let mut items: ItemIds = (0..toy.items).map(|item| Arc::from(format!("i{item:05}"))).collect();
    let mut connections = Vec::new();
    for (port, (upstream, fan)) in PORTS.into_iter().zip(&toy.inputs) {
        let above = earlier.get(*upstream).ok_or_else(|| {
            Diagnostic::new("toy-order", Fault::Bug, format!("toy `{}` reads a stage that comes later", toy.name))
        })?;
        if *fan == Fan::Each {
            items = Arc::clone(&above.items);
        }
        let arrival = |(item, id): (usize, &Arc<str>)| Arrival { id: Arc::clone(id), stage: *upstream, item };
        let arrivals = above.items.iter().enumerate().map(arrival).collect();
        connections.push(Connection { port: toy_port(port, *fan), upstreams: vec![*upstream], arrivals });
    }
    let sources = toy.sources.iter().enumerate().map(|(n, path)| (format!("source{n}"), path.clone()));
    let properties = StageProperties {
        kind: "toy".to_owned(),
        version: toy.version,
        parameters: toy.parameters.clone(),
        sources: sources.clone().map(|(parameter, path)| Source::new(parameter, path)).collect(),
        inputs: connections.iter().map(|connection| connection.port.clone()).collect(),
        artifact: "toy/1",
        items: ItemRule::One,
        bytes_per_item: 1000,
    };
    let files = sources.map(|(parameter, path)| SourceFile { parameter, declared: path.clone(), path });
    Ok(RecipeStage {
        name: toy.name.to_owned(),
        recipe_name: toy.name.to_owned(),
        kind: "toy".to_owned(),
        stage: Arc::new(ToyStage { properties, hook: Arc::clone(&toy.hook) }),
        connections,
        sources: files.collect(),
        items,
        variants: vec![],
        parameters: toy.parameters.clone(),
        span: 0..0,
    })
}

fn toy_port(name: &'static str, fan: Fan) -> InputPort {
    InputPort {
        name,
        artifact: "toy/1",
        fan,
        takes: Takes::One,
        optional: false,
        source: PortSource::Recipe,
        doc: "what it reads",
    }
}
