//! File names that stay inside their folder.

/// Whether `name` is a relative path of plain names with `/` between them, which cannot leave its folder on any system.
pub(crate) fn is_relative_path(name: &str) -> bool {
    name.len() <= 1024
        && !name.contains(['\\', ':'])
        && !name.chars().any(char::is_control)
        && name.split('/').all(|part| !part.is_empty() && part.len() <= 255 && part != "." && part != "..")
}
