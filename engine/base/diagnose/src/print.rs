//! The one voice towards the user: a diagnostic as text, readable without colour.

use crate::Diagnostic;
use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};

/// The diagnostic as the text that a terminal shows. `colour` only adds colour, never meaning.
pub fn render(diagnostic: &Diagnostic, colour: bool) -> String {
    let paths: Vec<String> = diagnostic.labels.iter().map(|label| label.path.display().to_string()).collect();
    let mut group = Level::ERROR.primary_title(&diagnostic.message).id(diagnostic.code).elements(
        diagnostic.labels.iter().zip(&paths).map(|(label, path)| {
            let end = label.span.end.min(label.text.len());
            let annotation = AnnotationKind::Primary.span(label.span.start.min(end)..end);
            let annotation = if label.note.is_empty() { annotation } else { annotation.label(&label.note) };
            Snippet::source(&*label.text).path(path).annotation(annotation)
        }),
    );
    for cause in &diagnostic.causes {
        group = group.element(Level::NOTE.with_name("because").message(cause));
    }
    for hint in &diagnostic.hints {
        group = group.element(Level::HELP.message(hint));
    }
    let renderer = if colour { Renderer::styled() } else { Renderer::plain() };
    renderer.render(&[group])
}
