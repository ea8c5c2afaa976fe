//! Models of a `render` stage: files of the recipe, checked before any stage runs.

use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_models::Model;
use cosfly_render::{RenderConfig, SceneModel};
use cosfly_stage::{Source, SourceCheck};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Files of the models, whose paths leave the parameters: what a file holds counts, not where it lies.
pub fn take_sources(config: &mut RenderConfig) -> Vec<Source> {
    let take = |(index, source): (usize, &mut String)| {
        let path = std::mem::replace(source, "(content)".into());
        let check = SourceCheck {
            describes: String::new(),
            read: Arc::new(|_| Ok(Value::Bool(true))),
            settle: Some(Arc::new(|path| read_model(path).map(drop))),
        };
        Source { check: Some(check), ..Source::new(format!("models.{index}.source"), path) }
    };
    config.models.iter_mut().map(|model| &mut model.source).enumerate().map(take).collect()
}

/// Reads the models of a stage from its files.
///
/// # Errors
/// Files that cannot be read, or are no models.
pub fn read_models(config: &RenderConfig, files: &[PathBuf]) -> Result<Vec<SceneModel>> {
    let read = |(model, file): (&cosfly_models::ModelConfig, &PathBuf)| {
        let turn_rad = model.turn_deg.to_radians();
        Ok(SceneModel { kind: model.kind, fit: model.fit, turn_rad, model: read_model(file)? })
    };
    config.models.iter().zip(files).map(read).collect()
}

fn read_model(path: &Path) -> Result<Model> {
    let shown = path.display();
    let bytes = std::fs::read(path).map_err(|error| Diagnostic::io(format!("read the model `{shown}`"), &error))?;
    Model::read(&bytes).map_err(|error| {
        let refused = Diagnostic::new("model-refused", Fault::Input, error.message).because(format!("in `{shown}`"));
        error.hints.into_iter().fold(refused, |refused, hint| refused.hint(hint))
    })
}
