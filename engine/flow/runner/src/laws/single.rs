//! One task by its plan digest, as another process would run it.

use super::*;
use crate::plan::plan;
use crate::single::run_task;
use cosfly_diagnose::Result;
use cosfly_stage::{
    InputPort, Inputs, OutputSink, ParameterError, Produced, Registry, Stage, StageKind, StagePart, StageProperties,
    TaskContext, TaskOutcome,
};
use serde_json::Value;

/// Builds a toy again from what was stored; `version` is that of the binary.
struct ToyKind {
    version: u32,
}

struct Boxed(Arc<dyn Stage>);

impl Stage for Boxed {
    fn properties(&self) -> &StageProperties {
        self.0.properties()
    }

    fn run(&self, inputs: &Inputs<'_>, outputs: &mut dyn OutputSink, context: &TaskContext) -> Result<Produced> {
        self.0.run(inputs, outputs, context)
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
        Ok(vec![StagePart { suffix: "", stage: Box::new(Boxed(stage)) }])
    }
}

fn run_one(store: &Store, version: u32, digest: &cosfly_fingerprint::Digest) -> Result<TaskOutcome> {
    let registry = Registry::new(vec![Box::new(ToyKind { version })]);
    run_task(store, &registry, digest, Arc::new(AtomicBool::new(false)))
}

#[test]
fn tasks_run_one_by_one_give_what_a_run_gives() {
    let reference = {
        let (_folder, store) = fresh_store();
        records(&run_quietly(&recipe(&town_toys(3, &Log::default())), &store))
    };
    let (_folder, store) = fresh_store();
    let log = Log::default();
    let recipe = recipe(&town_toys(3, &log));
    let plan = plan(&recipe, &store).unwrap();
    plan.publish_documents(&store).unwrap();
    let last = plan.stages[4].plans[0];
    assert_eq!(run_one(&store, 1, &last).unwrap_err().code, "task-input-missing");
    assert_eq!(run_one(&store, 2, &last).unwrap_err().code, "task-other-version");
    let unknown = cosfly_fingerprint::Digest::of(b"unknown");
    assert_eq!(run_one(&store, 1, &unknown).unwrap_err().code, "task-unknown");
    for stage in &plan.stages {
        for digest in &stage.plans {
            assert_eq!(run_one(&store, 1, digest).unwrap(), TaskOutcome::Ran);
            assert_eq!(run_one(&store, 1, digest).unwrap(), TaskOutcome::Reused);
        }
    }
    let summary = run_quietly(&recipe, &store);
    assert_eq!(counts(&summary), [0, 0, 11, 0, 0, 0]);
    assert_eq!(records(&summary), reference);
    assert!(log.take().is_empty(), "the recipe's own stages had nothing left to do");
}
