//! One task by its plan digest, as another process would run it.

use super::*;
use cosfly_blobs::OutputSink;
use cosfly_diagnose::{ParameterError, Result};
use cosfly_runner::{plan, run_task};
use cosfly_stage::{
    InputPort, Inputs, Produced, Registry, Stage, StageKind, StagePart, StageProperties, Takes, TaskContext, Work,
};
use serde_json::Value;

/// Builds a toy again from its stored parameters; `version` is that of the binary.
struct ToyKind {
    version: u32,
}

/// A toy that declares every port: parameters do not say which of them are connected.
struct WithPorts {
    stage: Arc<dyn Stage>,
    properties: StageProperties,
}

impl Stage for WithPorts {
    fn properties(&self) -> &StageProperties {
        &self.properties
    }

    fn run(&self, inputs: &Inputs<'_>, outputs: &mut dyn OutputSink, context: &TaskContext) -> Result<Produced> {
        self.stage.run(inputs, outputs, context)
    }
}

impl StageKind for ToyKind {
    fn name(&self) -> &'static str {
        "toy"
    }

    fn doc(&self) -> &'static str {
        "A toy."
    }

    fn schema(&self) -> Value {
        json!({})
    }

    fn ports(&self) -> Vec<InputPort> {
        Vec::new()
    }

    fn build(&self, parameters: Value) -> std::result::Result<Vec<StagePart>, ParameterError> {
        let mut toy = Toy::new("toy", 1, &[]);
        toy.parameters = parameters;
        toy.version = self.version;
        let stage = Arc::clone(&recipe(&[toy]).stages[0].stage);
        let inputs = Toy::ports(Fan::Gather, Takes::One).to_vec();
        let properties = StageProperties { inputs, ..stage.properties().clone() };
        Ok(vec![StagePart { suffix: "", stage: Box::new(WithPorts { stage, properties }) }])
    }
}

fn run_one(store: &Store, version: u32, digest: &cosfly_fingerprint::Digest) -> Result<Work> {
    let registry = Registry::new(vec![Box::new(ToyKind { version })]);
    run_task(store, &registry, digest, Arc::new(AtomicBool::new(false)))
}

/// A town with films of every expert in two weathers, and what is made of the films: items of all forms of names.
fn filmed_toys(log: &Log) -> Vec<Toy> {
    let mut toys = town_toys(3, log);
    let mut films = Toy::new("films", 0, &[(2, Fan::Each), (0, Fan::Broadcast)]);
    (films.takes, films.variants) = (Takes::Named, vec!["Noon", "Night"]);
    let extras = Toy::new("extras", 0, &[(5, Fan::Each)]);
    let mut album = Toy::new("album", 1, &[(5, Fan::Gather), (6, Fan::Gather)]);
    album.takes = Takes::Named;
    toys.extend([films, extras, album]);
    toys.iter_mut().for_each(|toy| toy.hook = log.hook());
    toys
}

#[test]
fn tasks_run_one_by_one_give_what_a_run_gives() {
    let reference = {
        let (_folder, store) = fresh_store();
        records(&run_quietly(&recipe(&filmed_toys(&Log::default())), &store))
    };
    let (_folder, store) = fresh_store();
    let log = Log::default();
    let recipe = recipe(&filmed_toys(&log));
    let plan = plan(&recipe, &store).unwrap();
    plan.publish_documents(&store).unwrap();
    let last = plan.stages[4].plans[0];
    assert_eq!(run_one(&store, 1, &last).unwrap_err().code, "task-input-missing");
    assert_eq!(run_one(&store, 2, &last).unwrap_err().code, "task-other-version");
    let unknown = cosfly_fingerprint::Digest::of(b"unknown");
    assert_eq!(run_one(&store, 1, &unknown).unwrap_err().code, "task-unknown");
    for stage in &plan.stages {
        for digest in &stage.plans {
            assert_eq!(run_one(&store, 1, digest).unwrap(), Work::Ran);
            assert_eq!(run_one(&store, 1, digest).unwrap(), Work::Cached);
        }
    }
    let summary = run_quietly(&recipe, &store);
    assert_eq!(counts(&summary), [0, 0, 24, 0, 0, 0]);
    assert_eq!(records(&summary), reference, "names have the same form when they are read from documents");
    assert!(log.take().is_empty(), "the recipe's own stages had nothing left to do");
}
