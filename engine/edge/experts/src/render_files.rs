//! Models and splats of a `render` stage: files of the recipe, checked before any stage runs.

use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_frames::DVec3;
use cosfly_models::Model;
use cosfly_render::{RenderConfig, SceneModel, SceneSplats};
use cosfly_splats::SplatCloud;
use cosfly_stage::{Source, SourceCheck};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Longest file of splats: the most splats that are read, with every number that they may have, fit well.
const MOST_SPLAT_BYTES: u64 = 4 << 30;

/// Files of the models and of the splats, whose paths leave the parameters: what a file holds counts, not where it lies.
pub fn take_sources(config: &mut RenderConfig) -> Vec<Source> {
    let take = |key: String, source: &mut String, settle: fn(&Path) -> Result<()>| {
        let path = std::mem::replace(source, "(content)".into());
        let check = SourceCheck {
            describes: String::new(),
            read: Arc::new(|_| Ok(Value::Bool(true))),
            settle: Some(Arc::new(settle)),
        };
        Source { check: Some(check), ..Source::new(key, path) }
    };
    let models = config.models.iter_mut().enumerate();
    let models = models.map(|(index, model)| {
        take(format!("models.{index}.source"), &mut model.source, |path| read_model(path).map(drop))
    });
    let mut sources: Vec<Source> = models.collect();
    let splats = config.splats.as_mut();
    sources.extend(
        splats.map(|splats| take("splats.source".to_owned(), &mut splats.source, |path| read_splats(path).map(drop))),
    );
    sources
}

/// Reads the splats of a stage from its last file, for a town whose reader took `world_origin_m` off its map's points.
///
/// # Errors
/// Files that cannot be read, or hold no splats.
pub fn read_scene_splats(
    config: &RenderConfig,
    files: &[PathBuf],
    world_origin_m: DVec3,
) -> Result<Option<SceneSplats>> {
    let (Some(splats), Some(file)) = (&config.splats, files.last()) else { return Ok(None) };
    let placed = SceneSplats::new(read_splats(file)?, splats, world_origin_m);
    placed
        .map(Some)
        .map_err(|problem| Diagnostic::new("splats-placed", Fault::Recipe, problem.message).hint(problem.hint))
}

fn read_splats(path: &Path) -> Result<SplatCloud> {
    let shown = path.display();
    let unreadable = |error: std::io::Error| Diagnostic::io(format!("read the splats `{shown}`"), &error);
    let length = std::fs::metadata(path).map_err(unreadable)?.len();
    if length > MOST_SPLAT_BYTES {
        let message = format!("the file has {length} bytes; at most {MOST_SPLAT_BYTES} are read");
        let refused = Diagnostic::new("splats-refused", Fault::Input, message).because(format!("in `{shown}`"));
        return Err(refused.hint("cut the scene into pieces, or prune it in an editor of splats such as SuperSplat"));
    }
    let bytes = std::fs::read(path).map_err(unreadable)?;
    cosfly_splats::read(&bytes).map(|file| file.cloud).map_err(|error| {
        let refused = Diagnostic::new("splats-refused", Fault::Input, error.message).because(format!("in `{shown}`"));
        error.hints.into_iter().fold(refused, |refused, hint| refused.hint(hint))
    })
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
