//! The kind of toys, by which their stages are built again from documents of a store.

use crate::toy::{Toy, toy_recipe};
use cosfly_blobs::OutputSink;
use cosfly_diagnose::{ParameterError, Result};
use cosfly_stage::{
    Fan, InputPort, Inputs, Produced, Stage, StageKind, StagePart, StageProperties, Takes, TaskContext,
};
use serde_json::{Value, json};
use std::sync::Arc;

/// Builds a toy again from its stored parameters.
pub struct ToyKind {
    /// Version of the stages.
    pub version: u32,
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
        let recipe = toy_recipe("toy", 1, &[toy]);
        let recipe = recipe.map_err(|it| ParameterError { path: vec![], message: it.message, hint: None })?;
        let stage = Arc::clone(&recipe.stages[0].stage);
        let inputs = Toy::ports(Fan::Gather, Takes::One).to_vec();
        let properties = StageProperties { inputs, ..stage.properties().clone() };
        Ok(vec![StagePart { suffix: "", stage: Box::new(WithPorts { stage, properties }) }])
    }
}
