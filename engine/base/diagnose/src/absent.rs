//! Why a path leads to nothing.

use std::io::ErrorKind;
use std::path::Path;

/// Why `path` leads to no file and no folder, as the end of a sentence about it; none where it leads to one.
///
/// A link in a circle and a folder that nobody may enter are there: "does not exist" would be untrue.
pub fn absent(path: &Path) -> Option<String> {
    let error = std::fs::metadata(path).err()?;
    Some(match error.kind() {
        ErrorKind::NotFound | ErrorKind::NotADirectory => match std::fs::read_link(path) {
            Ok(place) => format!("is a symbolic link to `{}`, which does not exist", place.display()),
            Err(_) => "does not exist".to_owned(),
        },
        kind => format!("cannot be read: {kind}"),
    })
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::os::unix::fs::symlink;

    #[test]
    fn a_circle_of_links_is_told_from_nothing() {
        let folder = std::env::temp_dir().join(format!("cosfly-absent-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let [a, b, lost] = ["a", "b", "lost"].map(|name| folder.join(name));
        symlink(&a, &b).and_then(|()| symlink(&b, &a)).and_then(|()| symlink("nowhere", &lost)).unwrap();
        assert_eq!(absent(&folder), None);
        assert_eq!(absent(&folder.join("x")).as_deref(), Some("does not exist"));
        assert_eq!(absent(&lost).as_deref(), Some("is a symbolic link to `nowhere`, which does not exist"));
        let circle = absent(&a.join("data")).unwrap();
        assert!(circle.starts_with("cannot be read: ") && circle.contains("loop"), "{circle}");
        std::fs::remove_dir_all(folder).unwrap();
    }
}
