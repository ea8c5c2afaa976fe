//! [`open`]: the source in a folder, by its layout.

use crate::FlightSource;
use crate::layouts::LAYOUTS;
use cosfly_diagnose::Result;
use std::path::Path;

/// The dataset in `folder`, in any of the layouts.
///
/// # Errors
/// `dataset-none` where there is none, otherwise damage of its files.
pub fn open(folder: &Path) -> Result<Box<dyn FlightSource>> {
    if let Some(layout) = LAYOUTS.iter().find(|layout| (layout.recognises)(folder)) {
        return (layout.open)(folder);
    }
    // The first layout is cosfly's own: its reader says what is missing in the folder.
    let others = LAYOUTS[1..].iter().map(|layout| layout.doc).collect::<Vec<_>>().join(" and ");
    (LAYOUTS[0].open)(folder).map_err(|refusal| refusal.hint(format!("datasets of other layouts load, too: {others}")))
}
