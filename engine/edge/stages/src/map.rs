//! `map`: reads a town from a map file.

use crate::ports::TOWN;
use crate::single;
use cosfly_blobs::OutputSink;
use cosfly_diagnose::{ParameterError, Result, counted};
use cosfly_experts::artifacts;
use cosfly_experts::map_files::{ReadMap, checked, read_files, refusal, unreadable};
use cosfly_frames::Seed;
use cosfly_maps::{MapConfig, options, recognise};
use cosfly_stage::parameters;
use cosfly_stage::{
    InputPort, Inputs, Produced, Source, SourceCheck, Stage, StageKind, StagePart, StageProperties, StageRole,
    TaskContext,
};
use cosfly_town::{Format, FormatOptions};
use serde_json::{Value, json};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Stage kind `map`.
pub struct Map;

impl StageKind for Map {
    fn name(&self) -> &'static str {
        "map"
    }

    fn doc(&self) -> &'static str {
        "Reads a town from a map file: obstacles, walkable ground, surfaces; fills and simplifies it on request."
    }

    fn schema(&self) -> Value {
        let mut options = options::schema();
        // References are to definitions of the whole schema.
        let definitions = options.as_object_mut().and_then(|table| table.remove("$defs")).unwrap_or_default();
        let own = parameters::schema_of::<MapConfig>();
        let mut schema = parameters::merged_into(own, json!({ "$defs": definitions }));
        let gone = |(name, _): (&String, &Value)| (name.clone(), json!(format!("write `options.{name}`")));
        let gone: serde_json::Map<String, Value> =
            options["properties"].as_object().into_iter().flatten().map(gone).collect();
        schema["x-gone"] = gone.into();
        for owner in ["/properties", "/$defs/FurtherSource/properties"] {
            if let Some(properties) = schema.pointer_mut(owner) {
                properties["options"] = options.clone();
            }
        }
        schema
    }

    fn ports(&self) -> Vec<InputPort> {
        vec![]
    }

    fn build(&self, given: Value) -> Result<Vec<StagePart>, ParameterError> {
        let (config, files) = checked(given)?;
        let properties = StageProperties {
            version: 26,
            parameters: canonical(&config)?,
            sources: sources(files),
            inputs: self.ports(),
            bytes_per_item: 4_000_000,
            ..StageProperties::new(self.name(), StageRole::World, TOWN)
        };
        Ok(single(MapStage { config, properties }))
    }
}

/// Files that a stage reads; options of the stage belong to the first.
fn sources(files: Vec<PathBuf>) -> Vec<Source> {
    let source = |(index, path): (usize, PathBuf)| match index {
        0 => Source { check: Some(own_options_only()), ..Source::new("source", path) },
        more => Source::new(format!("more.{}.source", more - 1), path),
    };
    files.into_iter().enumerate().map(source).collect()
}

/// Parameters for keys, options of formats among the others.
fn canonical(config: &MapConfig) -> Result<Value, ParameterError> {
    let mut all = parameters::canonical(&MapConfig { options: FormatOptions::default(), ..config.clone() });
    let more = options::in_keys(&config.options).map_err(|error| parameters::refused_at("", error.message))?;
    for (name, value) in more {
        all[name] = value;
    }
    Ok(all)
}

/// Refuses files of no known format and, at their places in the recipe, options of other formats than the file's.
fn own_options_only() -> SourceCheck {
    let read = |path: &Path| -> Result<Value> {
        let mut head = Vec::new();
        std::fs::File::open(path)
            .and_then(|file| file.take(Format::HEAD_BYTES as u64).read_to_end(&mut head))
            .map_err(|error| unreadable(path, &error))?;
        let format = recognise(&head).map_err(|error| refusal(error, path.to_owned(), &head))?;
        Ok(options::without_foreign(format, &path.display().to_string()))
    };
    SourceCheck { describes: String::new(), read: Arc::new(read), settle: None }
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
        let ReadMap { town, warnings, advice, .. } = read_files(&context.sources, &self.config, Seed(context.seed))?;
        artifacts::TOWN.put(outputs, &town)?;
        let report = &town.simplification;
        let mut notes = std::collections::BTreeMap::from([
            ("obstacles".to_owned(), counted(town.obstacles.len(), "box")),
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
            ("walkable".to_owned(), counted(town.walkable.len(), "polygon")),
        ]);
        if !town.synthetic.notes.is_empty() {
            notes.insert("synthetic".to_owned(), town.synthetic.notes.join("; "));
        }
        if !advice.is_empty() {
            notes.insert("advice".to_owned(), advice.join("; "));
        }
        Ok(Produced { notes, warnings, rejected: None })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_maps::FORMATS;
    use std::collections::BTreeSet;

    fn keys_of(parameters: Value) -> Value {
        let parts = Map.build(parameters).unwrap_or_else(|error| panic!("{error:?}"));
        parts[0].stage.properties().parameters.clone()
    }

    #[test]
    fn options_at_their_defaults_move_no_key() {
        let plain = keys_of(json!({ "source": "town.xodr" }));
        for option in [json!({ "signals": true }), json!({ "sample_step_m": 50 }), json!({ "terrain_margin_m": 60 })] {
            assert_eq!(keys_of(json!({ "source": "town.xodr", "options": option })), plain, "{option}");
        }
        assert_eq!(plain["unmarked_crossings"], true);
        assert_eq!(plain.get("assume_ground"), None);
        assert_eq!(plain.get("terrain_margin_m"), None);
        let options = json!({ "terrain_margin_m": 20, "signals": false });
        let changed = keys_of(json!({ "source": "town.xodr", "options": options }));
        assert_eq!((&changed["terrain_margin_m"], &changed["signals"]), (&json!(20.0), &json!(false)));
    }

    #[test]
    fn the_schema_names_the_formats_that_have_an_option_and_no_option_twice() {
        let options: BTreeSet<String> = FORMATS.iter().flat_map(Format::option_names).collect();
        let schema = Map.schema();
        let further = &schema["$defs"]["FurtherSource"]["properties"]["options"];
        for table in [&schema["properties"]["options"], further] {
            assert!(table["properties"].as_object().expect("a table").keys().eq(&options));
            assert!(table["properties"]["signals"]["description"].as_str().expect("text").starts_with("OpenDRIVE: "));
        }
        assert_eq!(schema["x-gone"]["signals"], "write `options.signals`");
        let roofs = schema["properties"]["options"]["properties"]["roofs"]["$ref"].as_str().expect("a reference");
        assert!(schema.pointer(roofs.trim_start_matches('#')).is_some(), "{roofs}");
    }
}
