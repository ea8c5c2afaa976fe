//! [`write_file`].

use std::fs;
use std::io::{ErrorKind, Result, Write};
use std::path::{Path, PathBuf};

/// Times that a file is written again because somebody took its draft for a leftover.
const ATTEMPTS: u32 = 5;

/// Writes a file whole or not at all, readable as other new files are; what was there before is replaced. Several processes may
/// write the same file at once: the last one counts. A link to a file is followed. What is no file, such as a pipe, is written in
/// place.
///
/// # Errors
/// Failures of the disk.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<()> {
    let place = match fs::metadata(path) {
        Ok(there) if !there.is_file() => return fs::write(path, bytes),
        Ok(_) => fs::canonicalize(path)?,
        Err(_) => path.to_owned(),
    };
    let mut attempt = 1;
    loop {
        match write_once(&place, bytes) {
            Err(error) if error.kind() == ErrorKind::NotFound && attempt < ATTEMPTS && folder_of(&place).is_dir() => {
                attempt += 1;
            }
            outcome => return outcome,
        }
    }
}

fn folder_of(path: &Path) -> PathBuf {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new(".")).to_owned()
}

/// A file beside `path`, under a name of its own, which `persist` gives the name `path` once it is whole: for what is too large to be
/// kept in memory.
///
/// # Errors
/// Failures of the disk.
pub fn draft(path: &Path) -> Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666)); // less what the umask takes
    builder.tempfile_in(folder_of(path))
}

fn write_once(path: &Path, bytes: &[u8]) -> Result<()> {
    written_draft(path, bytes)?.persist(path).map(|_| ()).map_err(|error| error.error)
}

/// A [`draft`] with its bytes on the disk.
pub(crate) fn written_draft(path: &Path, bytes: &[u8]) -> Result<tempfile::NamedTempFile> {
    let mut file = draft(path)?;
    file.write_all(bytes)?;
    file.as_file().sync_data()?;
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn files_are_as_readable_as_others_and_links_are_followed() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().expect("scratch");
        let place = |name: &str| folder.path().join(name);
        let mode = |name: &str| fs::metadata(place(name)).expect("a file").permissions().mode();
        fs::write(place("other"), "text").expect("written");
        write_file(&place("whole"), b"text").expect("written");
        assert_eq!(mode("whole"), mode("other"));
        std::os::unix::fs::symlink("whole", place("link")).expect("a link");
        write_file(&place("link"), b"new").expect("written");
        assert!(place("link").is_symlink());
        assert_eq!(fs::read(place("whole")).expect("a file"), b"new");
        write_file(Path::new("/dev/null"), b"text").expect("a device is written in place");
    }

    #[test]
    fn many_writers_at_once_leave_one_whole_file_and_no_draft() {
        let folder = tempfile::tempdir().expect("scratch");
        let path = folder.path().join("file");
        std::thread::scope(|scope| {
            for writer in 0..8_u8 {
                let path = &path;
                scope.spawn(move || (0..20).for_each(|_| write_file(path, &[writer; 5000]).expect("written")));
            }
        });
        let bytes = fs::read(&path).expect("a file");
        assert!(bytes.len() == 5000 && bytes.iter().all(|byte| *byte == bytes[0]));
        assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 1);
    }
}
