//! Files that stages read: resolved against the recipe's folder, and checked before any stage runs.

use crate::document::{Node, Place, Problems, Texts};
use crate::model::SourceFile;
use crate::parameters::{Subject, check_parameters};
use cosfly_diagnose::{Diagnostic, Fault, nearest_name};
use cosfly_stage::Source;
use serde_json::{Value as Json, json};
use std::collections::BTreeMap;
use std::fs::DirEntry;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// Resolves and checks the files of a recipe.
pub(crate) struct SourceFinder<'a> {
    /// Folder of the recipe.
    pub(crate) directory: &'a Path,
    pub(crate) texts: &'a Texts,
    /// Names in the folders that were searched for similar names.
    pub(crate) neighbours: Neighbours,
}

impl SourceFinder<'_> {
    /// Resolves `declared` sources; each one that is not a file is reported at the parameter that names it.
    pub(crate) fn resolve(
        &mut self,
        declared: &[Source],
        (parameters, subject): (&Node, &Subject<'_>),
        problems: &mut Problems,
    ) -> Vec<SourceFile> {
        let mut files = vec![];
        for source in declared {
            let place = place_of(source, parameters).unwrap_or(subject.place);
            if source.path.as_os_str().is_empty() {
                let message = format!("`{}` does not name a file", source.parameter);
                let hint = format!("write `{} = \"...\"`; paths are relative to the recipe's folder", source.parameter);
                problems.push(self.texts.problem("recipe-missing-key", place, message).hint(hint));
                continue;
            }
            let path = self.directory.join(&source.path);
            match self.check_file(&path, &source.path) {
                Ok(()) => problems.extend(self.check_content(source, &path, place, (parameters, subject))),
                Err((message, hints)) => {
                    let label = self.texts.label(place, "");
                    let problem = Diagnostic::new("input-missing", Fault::Input, message).at(label);
                    problems.push(hints.into_iter().fold(problem, |problem, hint| problem.hint(hint)));
                }
            }
            files.push(SourceFile { parameter: source.parameter.clone(), path });
        }
        files
    }

    /// Errors that depend on the content of a file.
    fn check_content(
        &self,
        source: &Source,
        path: &Path,
        place: &Place,
        (parameters, subject): (&Node, &Subject<'_>),
    ) -> Problems {
        let Some(check) = &source.check else { return vec![] };
        let at_source = |problem: Box<Diagnostic>| problem.at(self.texts.label(place, ""));
        let schema = match (check.read)(path) {
            Ok(schema) => schema_at(&check.describes, schema),
            Err(problem) => return vec![at_source(problem)],
        };
        let mut found = check_parameters(&schema, parameters, subject, self.texts);
        if let Some(settle) = check.settle.as_ref().filter(|_| found.is_empty()) {
            found.extend(settle(path).err().map(at_source));
        }
        found
    }

    fn check_file(&mut self, path: &Path, written: &Path) -> Result<(), (String, Vec<String>)> {
        let error = match std::fs::metadata(path) {
            Ok(metadata) if metadata.is_dir() => {
                return Err((format!("`{}` is a folder, not a file", path.display()), vec![]));
            }
            Ok(metadata) if metadata.is_file() => return Ok(()),
            Ok(_) => return Err((format!("`{}` is not a regular file", path.display()), vec![])),
            Err(error) => error,
        };
        if !matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) {
            return Err((format!("`{}` cannot be read: {error}", path.display()), vec![]));
        }
        let mut hints = vec![];
        let parent = path.parent().unwrap_or(Path::new(""));
        if let Some(near) = self.neighbours.similar_file(path) {
            hints.push(format!("did you mean `{}`?", written.with_file_name(near).display()));
        } else if !shown_folder(parent).is_dir() {
            hints.push(format!("there is no folder `{}`", parent.display()));
        }
        if written.is_relative() {
            hints.push(match written.is_file() {
                _ if self.directory.as_os_str().is_empty() => "paths are relative to the current folder".to_owned(),
                true => format!(
                    "`{}` exists in the current folder, but paths in a recipe are relative to the recipe's folder; a full \
                     path works as well",
                    written.display()
                ),
                false => {
                    format!("paths in a recipe are relative to the recipe's folder, here `{}`", self.directory.display())
                }
            });
        }
        Err((format!("there is no file `{}`", path.display()), hints))
    }
}

/// Schema of a stage's table in which only the parameter at `path` is described, by `schema`; an empty path is the table
/// itself.
fn schema_at(path: &str, mut schema: Json) -> Json {
    let definitions = schema.as_object_mut().and_then(|table| table.remove("$defs"));
    for key in path.split('.').rev().filter(|key| !key.is_empty()) {
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

/// Place of the parameter that names the file, where the recipe gives it.
fn place_of<'a>(source: &Source, parameters: &'a Node) -> Option<&'a Place> {
    let value = parameters.deepest(source.parameter.split('.'));
    value.as_table().is_none().then_some(&value.place)
}

/// File names of folders, each folder read once.
#[derive(Default)]
pub(crate) struct Neighbours(BTreeMap<PathBuf, Vec<String>>);

impl Neighbours {
    /// Most entries of a folder that are read.
    const MOST_ENTRIES: usize = 10_000;

    /// Name of the most similar file in the folder of `path`.
    pub(crate) fn similar_file(&mut self, path: &Path) -> Option<String> {
        let name = path.file_name()?.to_str()?;
        let folder = shown_folder(path.parent()?);
        let names = self.0.entry(folder).or_insert_with_key(|folder| Self::files_of(folder));
        nearest_name(name, names.iter().map(String::as_str)).map(str::to_owned)
    }

    fn files_of(folder: &Path) -> Vec<String> {
        let Ok(entries) = std::fs::read_dir(folder) else { return vec![] };
        let is_file = |entry: &DirEntry| match entry.file_type() {
            Ok(kind) if kind.is_symlink() => entry.path().is_file(),
            kind => kind.is_ok_and(|kind| kind.is_file()),
        };
        let files = entries.take(Self::MOST_ENTRIES).flatten().filter(is_file);
        let mut names: Vec<String> = files.filter_map(|entry| entry.file_name().into_string().ok()).collect();
        names.sort_unstable();
        names
    }
}

/// The current folder for an empty path.
fn shown_folder(folder: &Path) -> PathBuf {
    if folder.as_os_str().is_empty() { PathBuf::from(".") } else { folder.to_path_buf() }
}
