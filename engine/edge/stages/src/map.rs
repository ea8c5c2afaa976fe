//! `map`: reads a town from a map file.

use crate::ports::TOWN;
use crate::world::TOWN_BLOB;
use crate::{codec, parameters, single};
use cosfly_blobs::OutputSink;
use cosfly_diagnose::{Diagnostic, Fault, Label, ParameterError, Result};
use cosfly_frames::Seed;
use cosfly_maps::{MapConfig, MapError, read_town};
use cosfly_stage::{
    InputPort, Inputs, ItemRule, Produced, Source, Stage, StageKind, StagePart, StageProperties, TaskContext,
};
use std::path::PathBuf;

/// Stage kind `map`.
pub struct Map;

impl StageKind for Map {
    fn name(&self) -> &'static str {
        "map"
    }

    fn doc(&self) -> &'static str {
        "Reads a town from a map file (OpenDRIVE `.xodr`): obstacles, walkable ground, surfaces; fills and simplifies it on request."
    }

    fn schema(&self) -> serde_json::Value {
        parameters::schema_of::<MapConfig>()
    }

    fn ports(&self) -> Vec<InputPort> {
        vec![]
    }

    fn build(&self, given: serde_json::Value) -> Result<Vec<StagePart>, ParameterError> {
        let mut config: MapConfig = parameters::read(given)?;
        let fill = &config.fill;
        for (path, low, high) in [
            ("fill.max_height_m", fill.min_height_m, fill.max_height_m),
            ("fill.max_setback_m", fill.min_setback_m, fill.max_setback_m),
        ] {
            if high < low {
                let message = format!("`{path}` is `{high}`; it must be at least the smallest one, `{low}`");
                return Err(parameters::refused_at(path, message));
            }
        }
        let source = PathBuf::from(&config.source);
        // The name is part of the stage's output; the path of the file is not.
        config.name = Some(match config.name.take() {
            Some(name) if is_plain(&name) => name,
            Some(name) => return Err(refused_name(&name)),
            None => plain_stem(&source),
        });
        config.source = "(content)".into();
        let properties = StageProperties {
            kind: self.name().into(),
            version: 1,
            parameters: parameters::canonical(&config),
            sources: vec![Source::new("source", source)],
            inputs: self.ports(),
            artifact: TOWN,
            items: ItemRule::One,
            bytes_per_item: 4_000_000,
        };
        Ok(single(MapStage { config, properties }))
    }
}

/// True for names that can be folders of the dataset and values in its tables.
fn is_plain(name: &str) -> bool {
    (1..=80).contains(&name.len())
        && !name.starts_with(['.', '-'])
        && name.bytes().all(|byte| byte.is_ascii_alphanumeric() || b"._-".contains(&byte))
}

fn refused_name(name: &str) -> ParameterError {
    let mut refusal = parameters::refused_at(
        "name",
        format!(
            "`name` is `{name}`; it must have 1 to 80 of `A-Z`, `a-z`, `0-9`, `.`, `_`, `-` and begin with none of `.`, `-`"
        ),
    );
    refusal.hint = Some("it names a folder of the dataset".into());
    refusal
}

/// The file's name without extension, other characters replaced.
fn plain_stem(source: &std::path::Path) -> String {
    let stem = source.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    let plain: String =
        stem.chars().map(|letter| if is_plain(&format!("a{letter}")) { letter } else { '_' }).take(80).collect();
    let plain = plain.trim_start_matches(['.', '-']);
    if plain.is_empty() { "town".into() } else { plain.into() }
}

struct MapStage {
    config: MapConfig,
    properties: StageProperties,
}

impl Stage for MapStage {
    fn properties(&self) -> &StageProperties {
        &self.properties
    }

    fn run(&self, _inputs: &Inputs<'_>, outputs: &mut dyn OutputSink, context: &TaskContext) -> Result<Produced> {
        let path = &context.sources[0];
        let bytes = std::fs::read(path)
            .map_err(|error| Diagnostic::io(format!("read the map `{}`", path.display()), &error))?;
        let (town, warnings) = read_town(&bytes, &self.config, Seed(context.seed))
            .map_err(|error| refusal(error, path.clone(), &bytes))?;
        outputs.put(TOWN_BLOB, &codec::encode(TOWN, &town)?)?;
        let report = &town.simplification;
        let mut notes = std::collections::BTreeMap::from([
            ("obstacles".to_owned(), format!("{} boxes", town.obstacles.len())),
            (
                "planning boxes".to_owned(),
                format!(
                    "{} -> {} (merged {}, cropped {}, pruned {}; within {} m)",
                    report.input_boxes,
                    report.output_boxes,
                    report.merged,
                    report.cropped,
                    report.pruned,
                    report.tolerance_m
                ),
            ),
            ("walkable".to_owned(), format!("{} polygons", town.walkable.len())),
        ]);
        if !town.synthetic.notes.is_empty() {
            notes.insert("synthetic".to_owned(), town.synthetic.notes.join("; "));
        }
        Ok(Produced { notes, warnings, rejected: None })
    }
}

/// A map error as a diagnostic that points into the file, where it has a place.
fn refusal(error: MapError, path: PathBuf, bytes: &[u8]) -> Box<Diagnostic> {
    let mut diagnostic = Diagnostic::new("map-refused", Fault::Input, error.message);
    diagnostic = match error.place {
        Some(place) => {
            let text = String::from_utf8_lossy(bytes);
            let span = place.byte_span.start.min(text.len())..place.byte_span.end.min(text.len());
            diagnostic.at(Label { path, text: text.as_ref().into(), span, note: place.element })
        }
        None => diagnostic.because(format!("in `{}`", path.display())),
    };
    error.hints.into_iter().fold(diagnostic, |diagnostic, hint| diagnostic.hint(hint))
}
