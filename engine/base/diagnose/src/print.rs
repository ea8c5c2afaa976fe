//! Diagnostics as terminal text, readable without colour.

use crate::Diagnostic;
use crate::excerpt::Excerpt;
use crate::visible::visible;
use annotate_snippets::{Annotation, AnnotationKind, Element, Level, Renderer, Snippet};

/// Line width in columns; the same on every terminal, so that logs and snapshots agree.
const COLUMNS: usize = 100;
/// Diagnostics printed at once; the rest is only counted.
const MOST_AT_ONCE: usize = 20;

/// Text of a diagnostic for a terminal, without a newline at the end. `colour` adds colour, never meaning.
pub fn render(diagnostic: &Diagnostic, colour: bool) -> String {
    let title = wrap(&diagnostic.message, "error[]: ".len() + diagnostic.code.len());
    let excerpts = Excerpt::of_labels(&diagnostic.labels);
    let mut group = Level::ERROR.primary_title(&title).id(diagnostic.code).elements(Vec::<Element<'_>>::new());
    for excerpt in &excerpts {
        let snippet = Snippet::source(excerpt.text).line_start(excerpt.first_line).annotations(annotations(excerpt));
        group = group.element(snippet.path(&excerpt.path));
    }
    for cause in &diagnostic.causes {
        group = group.element(Level::NOTE.with_name("because").message(wrap(cause, "  = because: ".len())));
    }
    for hint in &diagnostic.hints {
        group = group.element(Level::HELP.message(wrap(hint, "  = help: ".len())));
    }
    let renderer = if colour { Renderer::styled() } else { Renderer::plain() };
    let mut text = renderer.term_width(COLUMNS).render(&[group]);
    for excerpt in &excerpts {
        if let Some((in_excerpt, in_file)) = excerpt.shifted_column {
            let place = format!("{}:{}:", excerpt.path, excerpt.first_line);
            text = text.replacen(&format!("{place}{in_excerpt}"), &format!("{place}{in_file}"), 1);
        }
    }
    if excerpts.is_empty() { without_gutter(&text, title.lines().count()) } else { text }
}

/// A number of things, such as `1 frame`, `2 frames` and `2 boxes`; `noun` is the word for one of them.
pub fn counted(number: impl std::fmt::Display, noun: &str) -> String {
    let text = format!("{number} {noun}{}", if noun.ends_with('x') { "es" } else { "s" });
    if text.starts_with("1 ") { format!("1 {noun}") } else { text }
}

/// Text of several diagnostics, separated by blank lines, with their number at the end.
pub fn render_all<'a>(diagnostics: impl IntoIterator<Item = &'a Diagnostic>, colour: bool) -> String {
    let all: Vec<&Diagnostic> = diagnostics.into_iter().collect();
    let mut pieces: Vec<String> = all.iter().take(MOST_AT_ONCE).map(|diagnostic| render(diagnostic, colour)).collect();
    let hidden = (all.len() > MOST_AT_ONCE).then(|| format!("; the first {MOST_AT_ONCE} are shown"));
    pieces.extend((all.len() > 1).then(|| format!("{} errors{}", all.len(), hidden.unwrap_or_default())));
    pieces.join("\n\n")
}

/// Underlines of an excerpt: the first label is the place of the failure, the others are related places.
fn annotations<'a>(excerpt: &'a Excerpt<'_>) -> impl Iterator<Item = Annotation<'a>> {
    excerpt.marks.iter().map(|mark| {
        let kind = if mark.is_first { AnnotationKind::Primary } else { AnnotationKind::Context };
        let annotation = kind.span(mark.span.clone());
        if mark.note.is_empty() { annotation } else { annotation.label(&mark.note) }
    })
}

/// Breaks `text` at spaces so that it fits behind `indent` columns; control characters become visible.
fn wrap(text: &str, indent: usize) -> String {
    let room = COLUMNS.saturating_sub(indent).max(40);
    let mut wrapped = String::with_capacity(text.len() + 8);
    for (number, line) in text.trim_end().lines().enumerate() {
        if number > 0 {
            wrapped.push('\n');
        }
        let mut column = 0;
        for word in line.split(' ') {
            let width = word.chars().count();
            if column > 0 && column + 1 + width > room {
                wrapped.push('\n');
                column = 0;
            } else if column > 0 {
                wrapped.push(' ');
                column += 1;
            }
            wrapped.extend(word.chars().map(visible));
            column += width;
        }
    }
    wrapped
}

/// `text` without the bar of the gutter where no excerpt follows.
fn without_gutter(text: &str, title_lines: usize) -> String {
    let kept: Vec<&str> = text
        .lines()
        .enumerate()
        .filter(|(number, line)| *number != title_lines || line.contains('='))
        .map(|(_, line)| line)
        .collect();
    kept.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_thing_is_one_and_all_other_numbers_are_several() {
        let shown = [(1, "frame"), (0, "frame"), (11, "box"), (1, "box")].map(|(number, noun)| counted(number, noun));
        assert_eq!(shown, ["1 frame", "0 frames", "11 boxes", "1 box"]);
    }

    #[test]
    fn long_text_breaks_at_spaces_and_keeps_its_words() {
        let text = "word ".repeat(60);
        let wrapped = wrap(&text, 20);
        assert!(wrapped.lines().all(|line| line.chars().count() <= 80), "{wrapped}");
        assert_eq!(wrapped.split_whitespace().count(), 60);
    }
}
