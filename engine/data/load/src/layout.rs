//! [`Layout`]: how a layout is recognised and opened.

use crate::FlightSource;
use cosfly_diagnose::Result;
use std::path::Path;

/// A layout of datasets that training loads.
pub struct Layout {
    /// Name, and a file by which people know the layout.
    pub doc: &'static str,
    /// Whether a folder has the layout.
    pub recognises: fn(&Path) -> bool,
    /// The dataset in a folder of the layout.
    ///
    /// # Errors
    /// Damage of its files.
    pub open: fn(&Path) -> Result<Box<dyn FlightSource>>,
}
