//! [`table`]: a table in TOML that is no recipe, such as the notes beside a result.

use crate::document::{Problems, Texts, table_json};
use crate::toml_text;
use cosfly_diagnose::Diagnostic;
use serde_json::{Map, Value};
use std::path::Path;

/// Reads the root table of the text of the file at `path`.
///
/// # Errors
/// All errors of the syntax.
pub fn table(path: &Path, text: &str) -> Result<Map<String, Value>, Vec<Box<Diagnostic>>> {
    let mut problems = Problems::new();
    let texts = Texts::new(path.to_path_buf(), text.into());
    match toml_text::parse_document(text, &texts, &mut problems) {
        Some(root) if problems.is_empty() => Ok(table_json(&root)),
        _ => Err(problems),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_read_and_errors_have_places() {
        let read = table(Path::new("notes.toml"), "link = \"https://example.org\"\n").expect("a table");
        assert_eq!(read["link"], "https://example.org");
        let problems = table(Path::new("notes.toml"), "link = \n").expect_err("no value");
        assert_eq!(problems[0].labels[0].path, Path::new("notes.toml"));
    }
}
