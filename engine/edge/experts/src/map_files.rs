//! Towns read from map files with the parameters of a stage `map`, by the stage and by `map inspect`.

use cosfly_diagnose::{Diagnostic, Fault, Label, ParameterError, Result, plausible};
use cosfly_domain::Town;
use cosfly_frames::Seed;
use cosfly_maps::advice::advice;
use cosfly_maps::{MapConfig, PlanRectangle, read_town_of, recognise};
use cosfly_stage::parameters;
use cosfly_town::{Format, MapError};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// A map that was read.
pub struct ReadMap {
    /// Name of the file's format.
    pub format: &'static str,
    /// The town, as the stage makes it of the same parameters.
    pub town: Town,
    /// Warnings of the reader.
    pub warnings: Vec<String>,
    /// Options that bring something which the town lacks, as sentences.
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

/// Reads `files` with a checked configuration.
///
/// # Errors
/// Refusals of a file.
pub fn read_files(files: &[PathBuf], config: &MapConfig, seed: Seed) -> Result<ReadMap> {
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

/// A map error as a diagnostic that points into the file, where it has a place.
pub fn refusal(error: MapError, path: PathBuf, bytes: &[u8]) -> Box<Diagnostic> {
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

/// The parameters of a stage, checked and without folders, and the paths of its files.
///
/// # Errors
/// A name, a range or a shift that no town can have.
pub fn checked(given: Value) -> Result<(MapConfig, Vec<PathBuf>), ParameterError> {
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
    if let Some(Err(rule)) = config.bounds_m.map(PlanRectangle::new) {
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

/// A map file that cannot be read, as a diagnostic.
pub fn unreadable(path: &Path, error: &std::io::Error) -> Box<Diagnostic> {
    Diagnostic::unread(format!("the map `{}`", path.display()), error)
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
fn plain_stem(source: &Path) -> String {
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn towns_are_called_like_their_files_and_files_of_two_names_are_two_towns() {
        let name = |path: &str| plain_stem(Path::new(path));
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
}
