//! Reading a recipe: text to tree, overrides, graph, parameters, files, items.

use crate::document::{Problems, Texts, table_json};
use crate::items::{Arranged, ItemReader, Wire};
use crate::kinds::{Builder, BuiltPart, BuiltStage, KnownStage, parameter_problem};
use crate::model::{Recipe, RecipeStage, SourceFile};
use crate::order::dependency_order;
use crate::outline::Outline;
use crate::parameters::{Subject, check_parameters};
use crate::sources::{Neighbours, SourceFinder};
use crate::wiring::{Wires, Wiring};
use crate::{for_each, needs, overrides, toml_text};
use cosfly_diagnose::{Diagnostic, Fault, Label};
use cosfly_stage::{PortSource, Registry, StageName};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

/// Reads and checks the recipe at `path`, with `overrides` (the arguments of `--set`) applied.
///
/// # Errors
/// All independent errors, in the order of the text.
pub fn load(path: &Path, overrides: &[String], registry: &Registry) -> Result<Recipe, Vec<Box<Diagnostic>>> {
    let bytes = std::fs::read(path).map_err(|error| vec![unreadable(path, &error)])?;
    let text = String::from_utf8(bytes).map_err(|error| vec![not_text(path, &error)])?;
    read(path, &text, overrides, registry)
}

/// Like [`load`], for a `text` instead of the file at `path`; the files that it names are resolved relative to that
/// path.
///
/// # Errors
/// Those of [`load`].
pub fn read(
    path: &Path,
    text: &str,
    overrides: &[String],
    registry: &Registry,
) -> Result<Recipe, Vec<Box<Diagnostic>>> {
    let mut problems = Problems::new();
    let mut texts = Texts::new(path.to_path_buf(), text.into());
    let recipe = check(path, text, overrides, registry, &mut texts, &mut problems);
    match recipe {
        Some(recipe) if problems.is_empty() => Ok(recipe),
        _ => {
            problems.sort_by_key(|problem| problem.labels.first().map(|label| (label.path != path, label.span.start)));
            // Stages of a list have their errors at the same place.
            problems.dedup_by(|next, first| next.code == first.code && at(next).is_some() && at(next) == at(first));
            Err(problems)
        }
    }
}

/// Place of an error.
fn at(problem: &Diagnostic) -> Option<(&Path, &std::ops::Range<usize>)> {
    problem.labels.first().map(|label| (label.path.as_path(), &label.span))
}

fn check(
    path: &Path,
    text: &str,
    overrides: &[String],
    registry: &Registry,
    texts: &mut Texts,
    problems: &mut Problems,
) -> Option<Recipe> {
    let mut root = toml_text::parse_document(text, texts, problems)?;
    overrides::apply(&mut root, overrides, texts, problems);
    let texts = &*texts;
    let directory = path.parent().unwrap_or(Path::new(""));
    for_each::expand(&mut root, directory, texts, problems)?;
    let outline = Outline::read(root, texts, problems)?;
    check_tools(&outline, registry, texts, problems);
    let mut builder = Builder::new(registry, texts);
    let known: Vec<Option<KnownStage>> = outline.stages.iter().map(|stage| builder.build(stage, problems)).collect();
    let mut connected = Wiring::new(&outline, &known, registry, texts).connect(problems);
    let order = dependency_order(&outline, &connected.reads, texts).unwrap_or_else(|cycles| {
        // A connection in a cycle is an error anyway, whatever the artifact.
        let in_cycle = |place: &Label| cycles.iter().flat_map(|cycle| &cycle.labels).any(|it| it.span == place.span);
        connected.mismatches.retain(|problem| !problem.labels.first().is_some_and(in_cycle));
        problems.extend(cycles);
        vec![]
    });
    problems.append(&mut connected.mismatches);
    let graph_is_sound = problems.is_empty();
    let mut finder = SourceFinder { directory, texts, neighbours: Neighbours::default() };
    let mut files = find_files(&outline, &known, &mut finder, problems);
    let wires = &connected.wires;
    let mut assembly = Assembly { outline: &outline, wires, texts, stages: vec![], place_of: BTreeMap::new() };
    for stage in order.into_iter().filter(|_| graph_is_sound) {
        let Some(built) = known[stage].as_ref().and_then(|known| known.built.as_ref()) else { continue };
        if let Err(problem) = assembly.add(stage, built, std::mem::take(&mut files[stage])) {
            problems.push(problem);
            break;
        }
    }
    let stages = assembly.stages;
    Some(Recipe {
        name: outline.name,
        seed: outline.seed,
        remove_intermediates: outline.remove_intermediates,
        tool: table_json(&outline.tool),
        path: path.to_path_buf(),
        text: text.into(),
        stages,
    })
}

/// Checks the tables of commands that the registry knows; others are somebody else's.
fn check_tools(outline: &Outline, registry: &Registry, texts: &Texts, problems: &mut Problems) {
    for tool in registry.tools() {
        if let Some(entry) = outline.tool.get(tool.name) {
            let table = format!("tool.{}", tool.name);
            let subject = Subject { table: &table, stage: "", kind: &table, place: &entry.key, ports: &[] };
            problems.append(&mut check_parameters(&tool.schema, &entry.node, &subject, texts));
        }
    }
}

/// Resolved source files by stage of the outline and part.
fn find_files(
    outline: &Outline,
    known: &[Option<KnownStage>],
    finder: &mut SourceFinder<'_>,
    problems: &mut Problems,
) -> Vec<Vec<Vec<SourceFile>>> {
    let mut files = vec![];
    for (stage, known) in outline.stages.iter().zip(known) {
        let Some(built) = known.as_ref().and_then(|known| known.built.as_ref()) else {
            files.push(vec![]);
            continue;
        };
        let mut of_part = |part: &BuiltPart| {
            let declared = &part.stage.properties().sources;
            let kind = stage.kind.as_ref().map_or("", |(kind, _)| kind);
            let table = format!("stages.{}", stage.name);
            let subject = Subject { table: &table, stage: &stage.name, kind, place: &stage.place, ports: &[] };
            finder.resolve(declared, (&built.parameters, &subject), problems)
        };
        files.push(built.parts.iter().map(&mut of_part).collect());
    }
    files
}

/// Finished stages, in dependency order.
struct Assembly<'a> {
    outline: &'a Outline,
    wires: &'a Wires,
    texts: &'a Texts,
    stages: Vec<RecipeStage>,
    /// Index in `stages` of the last part of each stage of the outline.
    place_of: BTreeMap<usize, usize>,
}

impl Assembly<'_> {
    /// Adds all parts of one stage of the outline.
    fn add(&mut self, index: usize, built: &BuiltStage, files: Vec<Vec<SourceFile>>) -> Result<(), Box<Diagnostic>> {
        let outline = &self.outline.stages[index];
        let parameters = serde_json::Value::Object(crate::document::table_json(&outline.parameters));
        let mut siblings = BTreeMap::new();
        for (part, sources) in built.parts.iter().zip(files) {
            if self.is_left_out(index, part) {
                continue;
            }
            let name = StageName::new(&outline.name, part.suffix);
            let properties = part.stage.properties();
            let wires = self.part_wires(index, part, &siblings)?;
            let reader =
                ItemReader { done: &self.stages, texts: self.texts, stage: name.as_str(), place: &outline.place };
            let Arranged { items, connections } = reader.read(properties, wires)?;
            needs::check(&properties.needs, &connections, &self.stages)
                .map_err(|error| parameter_problem(&error, (&built.parameters, &outline.place), self.texts))?;
            siblings.insert(part.suffix, self.stages.len());
            self.stages.push(RecipeStage {
                name,
                kind: outline.kind.as_ref().map_or_else(String::new, |(kind, _)| kind.clone()),
                stage: Arc::clone(&part.stage),
                connections,
                sources,
                items,
                parameters: parameters.clone(),
            });
        }
        self.place_of.insert(index, self.stages.len() - 1);
        Ok(())
    }

    /// Whether a part lacks a required input; in a valid graph, the stage works without such a part.
    fn is_left_out(&self, index: usize, part: &BuiltPart) -> bool {
        let is_connected = |port: &str| self.wires[index].get(port).is_some_and(|wired| !wired.is_empty());
        let ports = &part.stage.properties().inputs;
        ports.iter().any(|port| !port.optional && port.source == PortSource::Recipe && !is_connected(port.name))
    }

    /// Connected ports of a part.
    fn part_wires(
        &self,
        index: usize,
        part: &BuiltPart,
        siblings: &BTreeMap<&'static str, usize>,
    ) -> Result<Vec<Wire>, Box<Diagnostic>> {
        let outline = &self.outline.stages[index];
        let mut wires = vec![];
        for port in &part.stage.properties().inputs {
            let (upstreams, place) = match &port.source {
                PortSource::Sibling(suffix) if port.optional && !siblings.contains_key(suffix) => continue,
                PortSource::Sibling(suffix) => {
                    let sibling = siblings.get(suffix).ok_or_else(|| {
                        let message = format!(
                            "part `{}` of `{}` reads part `{suffix}`, which is not built before it",
                            part.suffix, outline.name
                        );
                        Diagnostic::new("stage-parts", Fault::Bug, message)
                    })?;
                    (vec![*sibling], outline.place.clone())
                }
                PortSource::Recipe => {
                    let wired = self.wires[index].get(port.name).map_or(&[][..], Vec::as_slice);
                    let place = wired.first().map_or(&outline.place, |(_, place)| place);
                    let upstreams = wired.iter().filter_map(|(upstream, _)| self.place_of.get(upstream).copied());
                    (upstreams.collect(), place.clone())
                }
            };
            if !upstreams.is_empty() {
                wires.push(Wire { port: port.clone(), upstreams, place });
            }
        }
        Ok(wires)
    }
}

fn unreadable(path: &Path, error: &std::io::Error) -> Box<Diagnostic> {
    if error.kind() != std::io::ErrorKind::NotFound {
        return Diagnostic::new("recipe-unreadable", Fault::Recipe, format!("could not read `{}`", path.display()))
            .because(error);
    }
    let problem = Diagnostic::new("recipe-missing", Fault::Recipe, format!("there is no recipe `{}`", path.display()));
    match Neighbours::default().similar_file(path) {
        Some(near) => problem.hint(format!("did you mean `{}`?", path.with_file_name(near).display())),
        None => problem,
    }
}

fn not_text(path: &Path, error: &std::string::FromUtf8Error) -> Box<Diagnostic> {
    let valid = error.utf8_error().valid_up_to();
    let line = error.as_bytes()[..valid].iter().filter(|byte| **byte == b'\n').count() + 1;
    Diagnostic::new("recipe-syntax", Fault::Recipe, format!("`{}` is not UTF-8 text", path.display()))
        .because(format!("line {line} has an invalid byte"))
}
