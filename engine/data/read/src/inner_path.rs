//! [`inner_path`]: the one rule for files that a file names.

use std::path::{Component, Path, PathBuf};

/// The file that a file of `folder` names; none for names that lead out of the folder: absolute ones, those with `..` or `.`, addresses
/// with a scheme, empty ones. Data are of anybody: every reader that opens what a file names asks here. Links in the folder are the
/// user's own and are followed; caches of downloads consist of them.
pub fn inner_path(folder: &Path, name: &str) -> Option<PathBuf> {
    let is_plain = |part: Component<'_>| matches!(part, Component::Normal(_));
    // Components leave single dots out.
    let has_dots = name.split(['/', '\\']).any(|part| part == "." || part == ".." || part.is_empty());
    let is_inside = !has_dots && !name.contains('\0') && Path::new(name).components().all(is_plain);
    is_inside.then(|| folder.join(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_lead_down_into_the_folder_and_nowhere_else() {
        let folder = Path::new("data");
        assert_eq!(inner_path(folder, "mcap/town/000/a b.mcap"), Some(PathBuf::from("data/mcap/town/000/a b.mcap")));
        for name in [
            "",
            "/etc/passwd",
            "../secret",
            "mcap/../../secret",
            "./a",
            "a//b",
            "..\\secret",
            "file:///etc/passwd",
            "https://example.org/a",
            "a\0b",
        ] {
            assert_eq!(inner_path(folder, name), None, "{name}");
        }
    }
}
