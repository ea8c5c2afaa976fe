//! Cheap stages, for tests and measurements of the engine.

use cosfly_blobs::OutputSink;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_fingerprint::Digest;
use cosfly_recipe::{Arrival, Connection, ItemNames, Recipe, RecipeStage, SourceFile};
use cosfly_stage::{
    Fan, InputPort, Inputs, ItemName, PortSource, Produced, Resources, Sees, Source, Stage, StageName, StageProperties,
    StageRole, Takes, TaskContext,
};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Called at the start of an item, to count, wait or fail.
pub type Hook = Arc<dyn Fn(&TaskContext) -> Result<()> + Send + Sync>;

/// Name of the intermediate blob of toys.
pub const PACK: &str = "pack";

/// Stage that writes bytes that depend on all of its inputs.
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
        for (port, artifacts) in &inputs.ports {
            for artifact in artifacts.iter() {
                for blob in artifact.blobs.keys() {
                    let bytes = inputs.read(artifact, blob)?;
                    let name = &artifact.name;
                    text.push_str(&format!("{port} {name} of {:?} {:?} ", name.stage(), Digest::of(&bytes)));
                }
            }
        }
        text.push_str(&format!("variant {:?} ", context.id.item.variant()));
        for source in &context.sources {
            let bytes = std::fs::read(source).map_err(|error| Diagnostic::io("read a toy's source", &error))?;
            text.push_str(&format!("{:?} ", Digest::of(&bytes)));
        }
        if let Some(path) = parameters["undeclared"].as_str() {
            // Forbidden to stages: the test of equal bytes detects it.
            text.push_str(&std::fs::read_to_string(path).map_err(|error| Diagnostic::io("read a toy's file", &error))?);
        }
        let wanted = usize::try_from(parameters["bytes"].as_u64().unwrap_or(0)).unwrap_or(0);
        let mut bytes = text.into_bytes();
        bytes.resize(bytes.len().max(wanted), b'.');
        outputs.put("out", &bytes)?;
        if self.properties.intermediate.contains(&PACK) {
            outputs.put(PACK, &[b"pack of ", &bytes[..]].concat())?;
        }
        let warnings = parameters["warning"].as_str().map(str::to_owned).into_iter().collect();
        let rejected = parameters["rejected"].as_str().map(str::to_owned);
        Ok(Produced { warnings, rejected, ..Produced::default() })
    }
}

/// One stage of a toy recipe.
pub struct Toy {
    /// Name of the stage.
    pub name: &'static str,
    /// Version of the kind.
    pub version: u32,
    /// Parameters. Known ones: `constant` (bytes depend on the inputs alone), `bytes` (size of the output),
    /// `undeclared` (a file read without declaration), `warning`, `rejected`.
    pub parameters: Value,
    /// Inputs: index of the stage, and the fan of its items.
    pub inputs: Vec<(usize, Fan)>,
    /// Number of items, unless an input of [`Fan::Each`] defines them.
    pub items: usize,
    /// Names of items at the inputs.
    pub takes: Takes,
    /// Variants of each item; without variants, the item itself.
    pub variants: Vec<&'static str>,
    /// Whether the stage writes an intermediate blob `pack` beside `out`.
    pub packs: bool,
    /// Blobs that the stage sees at its ports.
    pub sees: Sees,
    /// Files that the stage reads.
    pub sources: Vec<PathBuf>,
    /// Called at the start of every item.
    pub hook: Hook,
}

impl Toy {
    /// Creates a stage that writes a description of its inputs.
    pub fn new(name: &'static str, items: usize, inputs: &[(usize, Fan)]) -> Self {
        Self {
            name,
            version: 1,
            parameters: Value::Object(serde_json::Map::new()),
            inputs: inputs.to_vec(),
            items,
            takes: Takes::One,
            variants: Vec::new(),
            packs: false,
            sees: Sees::All,
            sources: Vec::new(),
            hook: Arc::new(|_| Ok(())),
        }
    }

    /// All ports of toys.
    pub fn ports(fan: Fan, takes: Takes) -> [InputPort; 4] {
        PORTS.map(|name| toy_port(name, fan, takes))
    }
}

/// Names of the ports of toys: one per input.
const PORTS: [&str; 4] = ["a", "b", "c", "d"];

/// Builds a recipe of toys, given in dependency order.
pub fn toy_recipe(name: &str, seed: u64, toys: &[Toy]) -> Result<Recipe> {
    let mut stages: Vec<RecipeStage> = Vec::new();
    for toy in toys {
        let stage = toy_stage(toy, &stages)?;
        stages.push(stage);
    }
    Ok(Recipe {
        name: name.to_owned(),
        seed,
        remove_intermediates: false,
        tool: serde_json::Map::new(),
        path: Path::new(name).with_extension("toml"),
        text: Arc::from(""),
        stages,
    })
}

fn toy_stage(toy: &Toy, earlier: &[RecipeStage]) -> Result<RecipeStage> {
    let mut items: ItemNames = (0..toy.items as u64).map(|number| ItemName::numbered("i", number)).collect();
    let mut connections = Vec::new();
    for (port, (upstream, fan)) in PORTS.into_iter().zip(&toy.inputs) {
        let above = earlier.get(*upstream).ok_or_else(|| {
            Diagnostic::new("toy-order", Fault::Bug, format!("toy `{}` reads a stage that comes later", toy.name))
        })?;
        let name_of = |own: &ItemName| match toy.takes {
            Takes::Named => own.of_stage(&above.name),
            Takes::One | Takes::Distinct => own.clone(),
        };
        let mut arrivals: Vec<Arrival> = above
            .items
            .iter()
            .enumerate()
            .map(|(item, own)| Arrival { name: name_of(own), stage: *upstream, item })
            .collect();
        if *fan == Fan::Each {
            let variants = |arrival: &Arrival| -> Vec<ItemName> {
                match &toy.variants[..] {
                    [] => vec![arrival.name.clone()],
                    variants => variants.iter().map(|variant| arrival.name.with_variant(*variant)).collect(),
                }
            };
            items = arrivals.iter().flat_map(variants).collect();
            let copies = toy.variants.len().max(1);
            arrivals = arrivals.into_iter().flat_map(|arrival| std::iter::repeat_n(arrival, copies)).collect();
        }
        let port = InputPort { sees: toy.sees, ..toy_port(port, *fan, toy.takes) };
        let upstreams = vec![*upstream];
        connections.push(Connection { port, upstreams, arrivals: arrivals.into(), bounds: Arc::default() });
    }
    let sources = toy.sources.iter().enumerate().map(|(n, path)| (format!("source{n}"), path.clone()));
    let properties = StageProperties {
        version: toy.version,
        parameters: toy.parameters.clone(),
        sources: sources.clone().map(|(parameter, path)| Source::new(parameter, path)).collect(),
        inputs: connections.iter().map(|connection| connection.port.clone()).collect(),
        bytes_per_item: 1000,
        intermediate: if toy.packs { &[PACK] } else { &[] },
        resources: Resources { memory_mib: 0, batch: 1 },
        ..StageProperties::new("toy", StageRole::Changes, "toy/1")
    };
    let files = sources.map(|(parameter, path)| SourceFile { parameter, path });
    Ok(RecipeStage {
        name: StageName::new(toy.name, ""),
        kind: "toy".to_owned(),
        stage: Arc::new(ToyStage { properties, hook: Arc::clone(&toy.hook) }),
        connections,
        sources: files.collect(),
        items,
        parameters: toy.parameters.clone(),
    })
}

fn toy_port(name: &'static str, fan: Fan, takes: Takes) -> InputPort {
    InputPort {
        name,
        artifact: "toy/1",
        fan,
        takes,
        optional: false,
        source: PortSource::Recipe,
        sees: Sees::All,
        doc: "what it reads",
    }
}
