//! Towns of one dataset have different names: two of one name are refused before any work, not after all pictures.

use cosfly_diagnose::{Diagnostic, Fault, Label};
use cosfly_recipe::{Recipe, RecipeStage, SourceFile};
use cosfly_stage::StageRole;
use std::collections::BTreeMap;

/// The first two towns of a dataset that would have one name, as an error.
///
/// # Errors
/// `towns-same-name`.
pub fn check(recipe: &Recipe) -> cosfly_diagnose::Result<()> {
    let datasets = recipe.stages.iter().filter(|stage| stage.has_role(StageRole::Publishes));
    for port in datasets.filter_map(|dataset| dataset.connection("town")) {
        let mut known: BTreeMap<&str, &RecipeStage> = BTreeMap::new();
        for town in port.upstreams.iter().map(|upstream| &recipe.stages[*upstream]) {
            let Some(name) = town.stage.properties().parameters["name"].as_str() else { continue };
            let first = *known.entry(name).or_insert(town);
            if !is_same(first, town) {
                return Err(refusal(recipe, name, first, town));
            }
        }
    }
    Ok(())
}

/// Whether two stages read the same town, if from copies of its files.
fn is_same(a: &RecipeStage, b: &RecipeStage) -> bool {
    let is_copy = |(one, other): (&SourceFile, &SourceFile)| {
        one.path == other.path
            || std::fs::read(&one.path).is_ok_and(|bytes| std::fs::read(&other.path).is_ok_and(|it| it == bytes))
    };
    let has_same_files = || a.sources.len() == b.sources.len() && a.sources.iter().zip(&b.sources).all(is_copy);
    a.stage.properties().parameters == b.stage.properties().parameters && has_same_files()
}

fn refusal(recipe: &Recipe, name: &str, a: &RecipeStage, b: &RecipeStage) -> Box<Diagnostic> {
    let message =
        format!("`{}` and `{}` are two towns of one dataset, and both would be called `{name}`", a.name, b.name);
    let refusal = Diagnostic::new("towns-same-name", Fault::Recipe, message)
        .because("names of towns are folders of the dataset; a town without `name` is called like its file")
        .hint(format!("give one of them a name of its own: `name = \"{name}_2\"` in `[stages.{}]`", b.name));
    let heading = format!("[stages.{}]", b.name);
    match recipe.text.find(&heading) {
        Some(start) => refusal.at(Label {
            path: recipe.path.clone(),
            text: recipe.text.clone(),
            span: start..start + heading.len(),
            note: String::new(),
        }),
        None => refusal,
    }
}
