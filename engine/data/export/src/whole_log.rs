//! [`whole_log`]: a log whose bytes are those that were written.

use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_read::read_records;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

/// Compares a log with all its checksums: readers that go by its index do not, and a changed byte would become another picture.
///
/// # Errors
/// `dataset-damaged`.
pub fn whole_log(path: &Path) -> Result<()> {
    let file = File::open(path).map_err(|error| Diagnostic::io(format!("read `{}`", path.display()), &error))?;
    read_records(&mut BufReader::with_capacity(1 << 20, file), &mut |_| {}).map_err(|damage| {
        let message = format!("`{}` is damaged", path.display());
        Diagnostic::new("dataset-damaged", Fault::Input, message)
            .because(damage.to_string())
            .hint("`cosfly verify` lists everything that is wrong with a dataset")
    })
}
