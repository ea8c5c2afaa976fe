//! The lines of a file that labels point at, cut to a readable length.

use crate::Label;
use crate::visible::visible;
use std::ops::Range;

/// Longest line that is shown whole, bytes; longer ones are cut around the label (data files may be one line of many
/// megabytes).
const LONG_LINE_BYTES: usize = 1_000;
/// Bytes of a long line that are kept on each side of the label.
const KEPT_BYTES: usize = 200;
/// Most lines that a label may span; a longer one only marks its first line.
const MOST_LINES: usize = 5;

/// Consecutive lines of one file, with the marks of one or several labels.
pub(crate) struct Excerpt<'a> {
    /// Path of the file, for display.
    pub(crate) path: String,
    /// Lines of the file, or the middle of one long line.
    pub(crate) text: &'a str,
    /// Number of the first line of `text`, from 1.
    pub(crate) first_line: usize,
    /// Where the line was cut: column of the label (in characters, from 1) in `text` and in the file.
    pub(crate) shifted_column: Option<(usize, usize)>,
    /// Places to underline.
    pub(crate) marks: Vec<Mark>,
}

/// A label within an excerpt.
pub(crate) struct Mark {
    /// Bytes of the excerpt's text, at character boundaries.
    pub(crate) span: Range<usize>,
    /// Text beside the underline; may be empty.
    pub(crate) note: String,
    /// Whether it is the diagnostic's first label.
    pub(crate) is_first: bool,
}

impl<'a> Excerpt<'a> {
    /// Excerpts in the order of the labels, one per file; a long line has an excerpt of its own.
    pub(crate) fn of_labels(labels: &'a [Label]) -> Vec<Self> {
        let mut excerpts = vec![];
        let mut first = 0;
        while first < labels.len() {
            let here = &labels[first];
            let cut = Self::cut_line(here, first == 0);
            if let Some(cut) = cut {
                excerpts.push(cut);
                first += 1;
                continue;
            }
            let same = labels[first..]
                .iter()
                .take_while(|label| label.path == here.path && label.text == here.text && !Self::is_in_long_line(label))
                .count();
            excerpts.push(Self::of_file(&labels[first..first + same], first == 0));
            first += same;
        }
        excerpts
    }

    fn of_file(labels: &'a [Label], holds_first: bool) -> Self {
        let text = &labels[0].text;
        let spans: Vec<Range<usize>> = labels.iter().map(readable_span).collect();
        let start = spans.iter().map(|span| line_start(text, span.start)).min().unwrap_or(0);
        let end = spans.iter().map(|span| line_end(text, span.end)).max().unwrap_or(0);
        let marks = labels
            .iter()
            .zip(spans)
            .enumerate()
            .map(|(number, (label, span))| Mark {
                span: span.start - start..span.end - start,
                note: visible_line(&label.note),
                is_first: holds_first && number == 0,
            })
            .collect();
        Self {
            path: visible_line(&labels[0].path.display().to_string()),
            text: &text[start..end],
            first_line: line_number(text, start),
            shifted_column: None,
            marks,
        }
    }

    fn is_in_long_line(label: &Label) -> bool {
        let span = readable_span(label);
        line_end(&label.text, span.end) - line_start(&label.text, span.start) > LONG_LINE_BYTES * MOST_LINES
            || line_end(&label.text, span.start) - line_start(&label.text, span.start) > LONG_LINE_BYTES
    }

    /// Middle part of a long line.
    fn cut_line(label: &'a Label, is_first: bool) -> Option<Self> {
        if !Self::is_in_long_line(label) {
            return None;
        }
        let text = &*label.text;
        let span = readable_span(label);
        let (start, end) = (line_start(text, span.start), line_end(text, span.start));
        let from = floor_boundary(text, span.start.saturating_sub(KEPT_BYTES).max(start));
        let to = floor_boundary(text, (span.start + KEPT_BYTES).min(end));
        let column_in = |from: usize| text[from..span.start].chars().count() + 1;
        Some(Self {
            path: visible_line(&label.path.display().to_string()),
            text: &text[from..to],
            first_line: line_number(text, start),
            shifted_column: Some((column_in(from), column_in(start))),
            marks: vec![Mark {
                span: span.start - from..span.end.min(to) - from,
                note: visible_line(&label.note),
                is_first,
            }],
        })
    }
}

/// Span of the label within its text: at character boundaries, over a few lines at most.
fn readable_span(label: &Label) -> Range<usize> {
    let text = &*label.text;
    let mut start = floor_boundary(text, label.span.start);
    if start > 0 && start == text.len() && text.ends_with('\n') {
        start -= 1; // the end of a file is shown at its last line
    }
    let mut end = floor_boundary(text, label.span.end).max(start);
    if text[start..end].matches('\n').count() >= MOST_LINES {
        end = line_end(text, start);
    }
    start..end
}

fn floor_boundary(text: &str, index: usize) -> usize {
    let mut index = index.min(text.len());
    while !text.is_char_boundary(index) {
        index -= 1;
    }
    index
}

fn line_start(text: &str, index: usize) -> usize {
    text[..index].rfind('\n').map_or(0, |newline| newline + 1)
}

fn line_end(text: &str, index: usize) -> usize {
    text[index..].find('\n').map_or(text.len(), |newline| index + newline)
}

fn line_number(text: &str, index: usize) -> usize {
    text.as_bytes()[..index].iter().filter(|byte| **byte == b'\n').count() + 1
}

fn visible_line(text: &str) -> String {
    text.chars().map(visible).collect()
}
