//! The diagnostic: a stable code, the kind of failure, a message, places, causes and hints.

use std::fmt;
use std::io::{Error, ErrorKind};
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;

/// Kind of failure, by who can correct it. Decides the exit code, and whether a run continues.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Invalid request in the recipe or on the command line.
    Recipe,
    /// Missing, unreadable, broken or unsuitable input file (map, track, store).
    Input,
    /// Error of the operating system: no permission, no thread, a file that disappeared.
    Machine,
    /// The disk is full; the next write would fail as well.
    DiskFull,
    /// A stored result is missing or damaged; computing it again repairs it.
    Lost,
    /// The user stopped the program.
    Stopped,
    /// Internal error of cosfly, to be reported.
    Bug,
}

/// A range of a text file that a diagnostic points at.
#[derive(Clone, Debug, PartialEq)]
pub struct Label {
    /// File that the text came from.
    pub path: PathBuf,
    /// Whole text of the file.
    pub text: Arc<str>,
    /// Bytes of `text` to underline.
    pub span: Range<usize>,
    /// Text beside the underline; may be empty.
    pub note: String,
}

/// One failure, ready to be shown.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    /// Stable kebab-case name, such as `recipe-unknown-key`. Programs branch on [`Self::fault`], not on the code.
    pub code: &'static str,
    /// Kind of failure.
    pub fault: Fault,
    /// Statement of the failure: a lower-case fragment, literals in back-ticks.
    pub message: String,
    /// Places in text files; the first is the place of the failure.
    pub labels: Vec<Label>,
    /// Causes, from the nearest to the deepest.
    pub causes: Vec<String>,
    /// Advice: allowed values and next steps.
    pub hints: Vec<String>,
}

/// Result of fallible work of the engine.
pub type Result<T, E = Box<Diagnostic>> = std::result::Result<T, E>;

/// The way out of a place that the user may not read or write.
const NO_ACCESS: &str = "change its permissions, or name another place (`--out`, `--store`)";

impl Diagnostic {
    /// Creates a diagnostic. The code is written as a literal, so that all codes can be found in the source.
    pub fn new(code: &'static str, fault: Fault, message: impl Into<String>) -> Box<Self> {
        Box::new(Self { code, fault, message: message.into(), labels: vec![], causes: vec![], hints: vec![] })
    }

    /// Error of the operating system during `action`, such as "read `a.toml`"; a full disk has a kind of its own.
    pub fn io(action: impl fmt::Display, error: &Error) -> Box<Self> {
        let message = format!("could not {action}");
        match error.kind() {
            ErrorKind::StorageFull | ErrorKind::QuotaExceeded => Diagnostic::new("disk-full", Fault::DiskFull, message).hint(
                "free some space, or choose another disk for what is written, then run the same command again (finished items of a run are kept)",
            ),
            ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => Diagnostic::new("machine-io", Fault::Machine, message).hint(NO_ACCESS),
            _ => Diagnostic::new("machine-io", Fault::Machine, message),
        }
        .because(error)
    }

    /// A file or folder that somebody named, as in "the map `a.osm`", and that cannot be read, for whatever reason.
    pub fn unread(subject: impl fmt::Display, error: &Error) -> Box<Self> {
        Diagnostic::new("input-unreadable", Fault::Input, format!("could not read {subject}")).because(error)
    }

    /// Work on `subject` (shown in back-ticks) that ended because the user stopped the program.
    pub fn stopped(subject: impl fmt::Display) -> Box<Self> {
        Diagnostic::new("cancelled", Fault::Stopped, format!("`{subject}` was stopped"))
    }

    /// Adds a place in a text file.
    pub fn at(mut self: Box<Self>, label: Label) -> Box<Self> {
        self.labels.push(label);
        self
    }

    /// Adds a cause.
    pub fn because(mut self: Box<Self>, cause: impl fmt::Display) -> Box<Self> {
        self.causes.push(cause.to_string());
        self
    }

    /// Adds advice: allowed values or next steps.
    pub fn hint(mut self: Box<Self>, hint: impl Into<String>) -> Box<Self> {
        self.hints.push(hint.into());
        self
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)?;
        self.causes.iter().try_for_each(|cause| write!(f, ": {cause}"))
    }
}

impl std::error::Error for Diagnostic {}

/// Why `path` leads to no file and no folder, as the end of a sentence about it; none where it leads to one.
///
/// A link in a circle and a folder that nobody may enter are there: "does not exist" would be untrue.
pub fn absent(path: &std::path::Path) -> Option<String> {
    let kind = std::fs::metadata(path).err()?.kind();
    let is_none = matches!(kind, ErrorKind::NotFound | ErrorKind::NotADirectory);
    Some(if is_none { "does not exist".to_owned() } else { format!("cannot be read: {kind}") })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(unix)]
    fn a_circle_of_links_is_told_from_nothing() {
        use std::os::unix::fs::symlink;
        let folder = std::env::temp_dir().join(format!("cosfly-absent-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let [a, b] = ["a", "b"].map(|name| folder.join(name));
        symlink(&a, &b).and_then(|()| symlink(&b, &a)).unwrap();
        assert_eq!(absent(&folder), None);
        assert_eq!(absent(&folder.join("x")).as_deref(), Some("does not exist"));
        let circle = absent(&a.join("data")).unwrap();
        assert!(circle.starts_with("cannot be read: ") && circle.contains("loop"), "{circle}");
        std::fs::remove_dir_all(folder).unwrap();
    }
}
