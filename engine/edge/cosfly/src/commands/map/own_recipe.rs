//! Recipes that commands make of their arguments: problems point to the argument that the user wrote.

use cosfly_diagnose::{Diagnostic, Label};
use cosfly_recipe::Recipe;
use std::path::Path;

/// An argument: its option, and the text that was given.
pub type Written<'a> = (&'static str, &'a str);

/// The recipe that `command` made of its arguments.
///
/// # Errors
/// Those of the recipe, at the arguments in `written`; what no argument says has no place.
#[expect(clippy::vec_box, reason = "diagnostics come boxed, in `Result`s")]
pub fn read_own(
    command: &str,
    text: &str,
    changes: &[String],
    written: &[Written<'_>],
) -> Result<Recipe, Vec<Box<Diagnostic>>> {
    cosfly_recipe::read(Path::new(command), text, changes, &cosfly_stages::registry()).map_err(|mut problems| {
        for problem in &mut problems {
            let labels = std::mem::take(&mut problem.labels);
            problem.labels = labels.iter().filter_map(|label| at_argument(label, written)).collect();
        }
        problems
    })
}

/// The place of `label` in the argument that its text was made of.
fn at_argument(label: &Label, written: &[Written<'_>]) -> Option<Label> {
    written.iter().filter(|(_, argument)| !argument.is_empty()).find_map(|(option, argument)| {
        let mut starts = label.text.match_indices(argument).map(|(start, _)| start);
        let start = starts.find(|start| (*start..=start + argument.len()).contains(&label.span.start))?;
        let span = label.span.start - start..label.span.end.saturating_sub(start).min(argument.len());
        Some(Label { path: option.into(), text: (*argument).into(), span, note: label.note.clone() })
    })
}
