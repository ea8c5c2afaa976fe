//! Files that are written whole or not at all.

use std::io::{Result, Write};
use std::path::Path;

/// Writes a file whole or not at all, readable as other new files are.
///
/// # Errors
/// Failures of the disk.
pub fn write(path: &Path, bytes: &[u8]) -> Result<()> {
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666)); // less what the umask takes
    let mut file = builder.tempfile_in(path.parent().unwrap_or(Path::new(".")))?;
    file.write_all(bytes)?;
    file.as_file().sync_data()?;
    file.persist(path).map(|_| ()).map_err(|error| error.error)
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::os::unix::fs::PermissionsExt;

    #[test]
    fn files_are_as_readable_as_others() {
        let folder = tempfile::tempdir().expect("scratch");
        let mode = |name: &str| std::fs::metadata(folder.path().join(name)).expect("a file").permissions().mode();
        std::fs::write(folder.path().join("other"), "text").expect("written");
        write(&folder.path().join("whole"), b"text").expect("written");
        assert_eq!(mode("whole"), mode("other"));
    }
}
