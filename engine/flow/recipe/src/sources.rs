//! The files that stages read: resolved against the recipe's folder and looked for before anything runs.

use crate::document::{Node, Place, Problems, Texts};
use crate::model::SourceFile;
use crate::parameters::{Subject, check_parameters};
use cosfly_diagnose::{Diagnostic, Fault, nearest_name};
use cosfly_stage::Source;
use serde_json::{Value as Json, json};
use std::path::{Path, PathBuf};

/// Folders with more entries than this are not searched for a similar name.
const MOST_ENTRIES: usize = 10_000;

/// Resolves `declared` sources; each one that is not a file is reported at the parameter that names it.
pub(crate) fn resolve(
    declared: &[Source],
    directory: &Path,
    (parameters, subject): (&Node, &Subject<'_>),
    texts: &Texts,
    problems: &mut Problems,
) -> Vec<SourceFile> {
    let stage_place = subject.place;
    let mut files = vec![];
    for source in declared {
        if source.path.as_os_str().is_empty() {
            let message = format!("`{}` names no file", source.parameter);
            let place = place_of(source, parameters).unwrap_or(stage_place);
            problems.push(
                texts
                    .problem("recipe-missing-key", place, message)
                    .hint(format!("write `{} = \"...\"`; paths begin at the recipe's folder", source.parameter)),
            );
            continue;
        }
        let path = directory.join(&source.path);
        if let Err((message, hints)) = check_file(&path, &source.path, directory) {
            let place = place_of(source, parameters).unwrap_or(stage_place);
            let label = texts.label(place, "");
            let problem = Diagnostic::new("input-missing", Fault::Input, message).at(label);
            problems.push(hints.into_iter().fold(problem, |problem, hint| problem.hint(hint)));
        } else if let Some(check) = &source.check {
            let at_source = |problem: Box<Diagnostic>| {
                problem.at(texts.label(place_of(source, parameters).unwrap_or(stage_place), ""))
            };
            match (check.read)(&path) {
                Ok(schema) => {
                    let whole = schema_at(&check.describes, schema);
                    let mut found = check_parameters(&whole, parameters, subject, texts);
                    if let Some(settle) = check.settle.as_ref().filter(|_| found.is_empty()) {
                        problems.extend(settle(&path).err().map(at_source));
                    }
                    problems.append(&mut found);
                }
                Err(problem) => problems.push(at_source(problem)),
            }
        }
        files.push(SourceFile { parameter: source.parameter.clone(), declared: source.path.clone(), path });
    }
    files
}

/// The schema of a stage's table of which only the parameter at `path` is described, by `schema`.
fn schema_at(path: &str, mut schema: Json) -> Json {
    let definitions = schema.as_object_mut().and_then(|table| table.remove("$defs"));
    for key in path.split('.').rev() {
        let needs_it = schema.get("required").and_then(Json::as_array).is_some_and(|keys| !keys.is_empty());
        schema = match key.parse::<usize>() {
            Ok(index) => {
                let mut items = vec![Json::Bool(true); index];
                items.push(schema);
                json!({ "prefixItems": items })
            }
            Err(_) => json!({ "properties": { key: schema }, "required": if needs_it { vec![key] } else { vec![] } }),
        };
    }
    if let Some(definitions) = definitions {
        schema["$defs"] = definitions;
    }
    schema
}

/// Where the recipe gives the parameter that names the file.
fn place_of<'a>(source: &Source, parameters: &'a Node) -> Option<&'a Place> {
    let value = parameters.deepest(source.parameter.split('.'));
    value.as_table().is_none().then_some(&value.place)
}

fn check_file(path: &Path, written: &Path, directory: &Path) -> Result<(), (String, Vec<String>)> {
    let error = match std::fs::metadata(path) {
        Ok(metadata) if metadata.is_dir() => {
            return Err((format!("`{}` is a folder; a file is wanted", path.display()), vec![]));
        }
        Ok(metadata) if metadata.is_file() => return Ok(()),
        Ok(_) => return Err((format!("`{}` is not a regular file", path.display()), vec![])),
        Err(error) => error,
    };
    if error.kind() == std::io::ErrorKind::PermissionDenied {
        return Err((format!("`{}` may not be read: {error}", path.display()), vec![]));
    }
    let mut hints = vec![];
    let parent = path.parent().unwrap_or(Path::new(""));
    if let Some(near) = similar_file(path) {
        hints.push(format!("did you mean `{}`?", written.with_file_name(near).display()));
    } else if !shown_folder(parent).is_dir() {
        hints.push(format!("there is no folder `{}`", parent.display()));
    }
    if written.is_relative() {
        if written.is_file() {
            hints.push(format!(
                "`{}` exists where you stand, but paths in a recipe begin at the recipe's folder; a full path works, too",
                written.display()
            ));
        } else {
            hints.push(format!(
                "paths in a recipe begin at the recipe's folder, here `{}`",
                shown_folder(directory).display()
            ));
        }
    }
    Err((format!("there is no file `{}`", path.display()), hints))
}

/// The name of a file beside `path` that is most like it.
pub(crate) fn similar_file(path: &Path) -> Option<String> {
    let name = path.file_name()?.to_str()?;
    let folder = shown_folder(path.parent()?);
    let mut names: Vec<String> = std::fs::read_dir(folder)
        .ok()?
        .take(MOST_ENTRIES)
        .filter_map(|entry| entry.ok().filter(|entry| entry.path().is_file())?.file_name().into_string().ok())
        .collect();
    names.sort_unstable();
    nearest_name(name, names.iter().map(String::as_str)).map(str::to_owned)
}

/// The empty path is the folder we stand in.
fn shown_folder(folder: &Path) -> PathBuf {
    if folder.as_os_str().is_empty() { PathBuf::from(".") } else { folder.to_path_buf() }
}
