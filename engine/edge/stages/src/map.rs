//! `map`: reads a town from a map file.

use crate::ports::TOWN;
use crate::single;
use cosfly_blobs::OutputSink;
use cosfly_diagnose::{Diagnostic, Fault, Label, ParameterError, Result, plausible};
use cosfly_domain::Town;
use cosfly_experts::artifacts;
use cosfly_frames::Seed;
use cosfly_maps::advice::advice;
use cosfly_maps::{Bounds, FORMATS, MapConfig, read_town_of, recognise};
use cosfly_stage::parameters;
use cosfly_stage::{
    InputPort, Inputs, ItemRule, Produced, Resources, Source, SourceCheck, Stage, StageKind, StagePart,
    StageProperties, StageRole, TaskContext,
};
use cosfly_town::{Format, FormatOptions, MapError};
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
        let common = parameters::schema_of::<MapConfig>();
        FORMATS.iter().fold(common, |all, format| parameters::merged_into(all, named_schema(format)))
    }

    fn ports(&self) -> Vec<InputPort> {
        vec![]
    }

    fn build(&self, given: Value) -> Result<Vec<StagePart>, ParameterError> {
        let (config, files) = checked(given)?;
        let properties = StageProperties {
            kind: self.name().into(),
            version: 14,
            parameters: canonical(&config)?,
            sources: sources(files),
            inputs: self.ports(),
            artifact: TOWN,
            items: ItemRule::One,
            bytes_per_item: 4_000_000,
            files_per_item: 1,
            intermediate: &[],
            asks: None,
            role: StageRole::World,
            resources: Resources::default(),
        };
        Ok(single(MapStage { config, properties }))
    }
}

/// The parameters of a stage, checked and without folders, and the paths of its files.
fn checked(mut given: Value) -> Result<(MapConfig, Vec<PathBuf>), ParameterError> {
    let mut config: MapConfig = parameters::take(&mut given)?;
    config.options = given.as_object().cloned().unwrap_or_default().into();
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
    if let Some(Err(rule)) = config.bounds_m.map(Bounds::new) {
        return Err(parameters::refused_at("bounds_m", rule));
    }
    for (index, further) in config.more.iter().enumerate() {
        if let Some(fault) = further.shift_m.iter().flatten().find_map(|number| plausible(*number).err()) {
            let path = format!("more.{index}.shift_m");
            return Err(parameters::refused_at(&path, format!("a number of `shift_m` {fault}")));
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
    let mut files = vec![source];
    for further in &mut config.more {
        let path = PathBuf::from(&further.source);
        let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        further.source = name;
        files.push(path);
    }
    Ok((config, files))
}

/// Files that a stage reads; options of the stage belong to the first.
fn sources(files: Vec<PathBuf>) -> Vec<Source> {
    let source = |(index, path): (usize, PathBuf)| match index {
        0 => Source { check: Some(own_options_only()), ..Source::new("source", path) },
        more => Source::new(format!("more.{}.source", more - 1), path),
    };
    files.into_iter().enumerate().map(source).collect()
}

/// Schema of the options of a format; their descriptions begin with the names of the formats that have them.
fn named_schema(format: &Format) -> Value {
    let mut schema = format.schema();
    for (name, option) in schema["properties"].as_object_mut().into_iter().flatten() {
        let owners: Vec<&str> =
            FORMATS.iter().filter(|one| one.option_names().contains(name)).map(Format::name).collect();
        let description = option["description"].as_str().unwrap_or_default();
        option["description"] = format!("{}: {description}", owners.join(", ")).into();
    }
    schema
}

/// Options of OpenDRIVE that are in all keys: there was no other format once.
const IN_ALL_KEYS: [&str; 6] =
    ["shoulders_as_sidewalks", "signals", "road_marks", "unmarked_crossings", "roofs", "sample_step_m"];

/// Parameters for keys. Any other option at its default is left out, so that a new one moves no key.
fn canonical(config: &MapConfig) -> Result<Value, ParameterError> {
    let filled = |format: &Format, options: &FormatOptions| {
        format.filled(options).map_err(|error| parameters::refused_at("", error.message))
    };
    let mut all = parameters::canonical(config);
    for format in FORMATS {
        let (own, defaults) = (filled(format, &config.options)?, filled(format, &FormatOptions::default())?);
        for ((name, value), (_, default)) in own.iter().zip(defaults.iter()) {
            if IN_ALL_KEYS.contains(&name.as_str()) || value != default {
                all[name] = value.clone();
            }
        }
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
        Ok(without_foreign_options(format, path))
    };
    SourceCheck { describes: String::new(), read: Arc::new(read), settle: None }
}

/// Schema that allows all options but those of other formats than `own`.
fn without_foreign_options(own: &Format, path: &Path) -> Value {
    let (mut properties, own_names) = (serde_json::Map::new(), own.option_names());
    for foreign in FORMATS.iter().filter(|format| format.name() != own.name()) {
        let reason = format!(
            "is an option of maps in the format {}, but `{}` is in the format {}",
            foreign.name(),
            path.display(),
            own.name()
        );
        let names = foreign.option_names().into_iter().filter(|name| !own_names.contains(name));
        properties.extend(names.map(|name| (name, json!({ "not": {}, "description": reason }))));
    }
    json!({ "properties": properties })
}

fn unreadable(path: &Path, error: &std::io::Error) -> Box<Diagnostic> {
    Diagnostic::io(format!("read the map `{}`", path.display()), error)
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

/// The file's name without extensions, other characters replaced. A name with letters beyond ASCII, and one that is too long, ends
/// in a digest, so that files of two names stay two towns.
fn plain_stem(source: &std::path::Path) -> String {
    let stem = source.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    // `krems.osm.gz`, `delft.city.json`
    let stem = [".osm", ".city"].iter().find_map(|kind| stem.strip_suffix(kind)).unwrap_or(&stem).to_owned();
    let plain = |letter: char| if is_plain(&format!("a{letter}")) { letter } else { '_' };
    let is_whole = stem.is_ascii() && stem.len() <= 80;
    let kept: String = stem.chars().map(plain).take(if is_whole { 80 } else { 70 }).collect();
    let kept = kept.trim_start_matches(['.', '-']);
    let kept = if is_whole { kept } else { kept.trim_matches('_') };
    let kept = if kept.is_empty() { "town" } else { kept };
    if is_whole {
        return kept.into();
    }
    format!("{kept}-{}", &cosfly_fingerprint::Digest::of(stem.as_bytes()).to_string()[..8])
}

/// A map that was read.
pub struct ReadMap {
    /// Name of the file's format.
    pub format: &'static str,
    /// The town, as the stage makes it of the same parameters.
    pub town: Town,
    /// Warnings of the reader.
    pub warnings: Vec<String>,
    /// What the town lacks, and the options that help.
    pub advice: Vec<String>,
}

/// Reads `files` with checked `parameters` of a stage `map`, for a look at the town without a run.
///
/// # Errors
/// Refusals of a file.
pub fn read_map(parameters: Value, files: &[PathBuf]) -> Result<ReadMap> {
    let (config, _) =
        checked(parameters).map_err(|error| Diagnostic::new("map-refused", Fault::Recipe, error.message))?;
    read_files(files, &config, Seed::of_item(0, "map", "all"))
}

fn read_files(files: &[PathBuf], config: &MapConfig, seed: Seed) -> Result<ReadMap> {
    let read = |path: &PathBuf| std::fs::read(path).map_err(|error| unreadable(path, &error));
    let contents: Vec<Vec<u8>> = files.iter().map(read).collect::<Result<_>>()?;
    let slices: Vec<&[u8]> = contents.iter().map(Vec::as_slice).collect();
    let refused = |(at, error): (usize, MapError)| {
        let refusal = refusal(error, files[at].clone(), &contents[at]);
        if at > 0 { refusal.because(format!("beside the first file, `{}`", files[0].display())) } else { refusal }
    };
    let (town, warnings) = read_town_of(&slices, config, seed).map_err(refused)?;
    let head = &contents[0][..contents[0].len().min(Format::HEAD_BYTES)];
    let format = recognise(head).map_err(|error| refused((0, error)))?.name();
    let advice = advice(&town, config);
    Ok(ReadMap { format, town, warnings, advice })
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
        if !advice.is_empty() {
            notes.insert("advice".to_owned(), advice.join("; "));
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    fn keys_of(parameters: Value) -> Value {
        let parts = Map.build(parameters).unwrap_or_else(|error| panic!("{error:?}"));
        parts[0].stage.properties().parameters.clone()
    }

    #[test]
    fn towns_are_called_like_their_files_and_files_of_two_names_are_two_towns() {
        let name = |path: &str| plain_stem(std::path::Path::new(path));
        assert_eq!(
            ["a/Town01.xodr", "krems.osm.gz", "my town.osm", "---"].map(name),
            ["Town01", "krems", "my_town", "town"]
        );
        let long = "x".repeat(90);
        let names =
            ["東京.osm", "大阪.osm", "Київ.osm", "münchen.osm", "mänchen.osm", &long, &format!("{long}y")].map(name);
        let distinct: BTreeSet<&String> = names.iter().collect();
        assert_eq!(distinct.len(), names.len(), "{names:?}");
        assert!(names.iter().all(|name| is_plain(name)), "{names:?}");
        assert!(names[0].starts_with("town-") && names[3].starts_with("m_nchen-"), "{names:?}");
        assert_eq!(name("here/東京.osm"), name("there/東京.osm.gz"));
    }

    #[test]
    fn options_at_their_defaults_move_no_key() {
        let plain = keys_of(json!({ "source": "town.xodr" }));
        for option in [json!({ "signals": true }), json!({ "sample_step_m": 50 }), json!({ "terrain_margin_m": 60 })] {
            let mut given = json!({ "source": "town.xodr" });
            given.as_object_mut().expect("a table").append(&mut option.as_object().expect("a table").clone());
            assert_eq!(keys_of(given), plain, "{option}");
        }
        assert_eq!(plain["unmarked_crossings"], true);
        assert_eq!(plain.get("assume_ground"), None);
        assert_eq!(plain.get("terrain_margin_m"), None);
        let changed = keys_of(json!({ "source": "town.xodr", "terrain_margin_m": 20, "signals": false }));
        assert_eq!((&changed["terrain_margin_m"], &changed["signals"]), (&json!(20.0), &json!(false)));
    }

    #[test]
    fn the_schema_names_the_formats_that_have_an_option_and_no_option_twice() {
        let common = parameters::schema_of::<MapConfig>()["properties"].as_object().expect("a table").len();
        let options: BTreeSet<String> = FORMATS.iter().flat_map(Format::option_names).collect();
        let schema = Map.schema();
        assert_eq!(schema["properties"].as_object().expect("a table").len(), common + options.len());
        assert!(schema["properties"]["signals"]["description"].as_str().expect("text").starts_with("OpenDRIVE: "));
    }
}
