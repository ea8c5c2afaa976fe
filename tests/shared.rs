//! Real-world inputs beside the repository, for the tests of all crates (`#[path]` brings this file in).

use std::path::{Path, PathBuf};

/// The file or folder `name` of the shared inputs, whose folder is `COSFLY_SHARED` or lies beside the checkout; `None`,
/// with a line that says so, where it is absent.
///
/// # Panics
/// Where it is absent although `COSFLY_SHARED_REQUIRED` is set: a test must not pass by skipping then.
pub fn shared_input(name: &str) -> Option<PathBuf> {
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../../shared");
    let path = std::env::var_os("COSFLY_SHARED").map_or_else(beside, PathBuf::from).join("data").join(name);
    if path.exists() {
        return Some(path);
    }
    let is_required = std::env::var_os("COSFLY_SHARED_REQUIRED").is_some();
    assert!(!is_required, "{} is absent, but COSFLY_SHARED_REQUIRED is set", path.display());
    println!("skipped: {} is absent (set COSFLY_SHARED to the folder of the shared inputs)", path.display());
    None
}
