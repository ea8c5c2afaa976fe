//! The seam: what a format is, and how a dataset is written in it.

use crate::folder::{OutFolder, Written};
use crate::option::{ExportOption, options_of};
use crate::source::{Choice, Source};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_read::PublishedDataset;
use schemars::JsonSchema;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};
use std::path::Path;

/// A format that published datasets can be written in.
///
/// Laws, tested over all of them: the same dataset gives the same bytes; no folder has more than 1,000 entries unless the
/// format prescribes it; a refused export leaves nothing; all chosen frames are there.
pub trait Format {
    /// Name on the command line.
    const NAME: &'static str;
    /// One line for the help.
    const DOC: &'static str;
    /// Options of the format: docs, ranges and defaults of the fields are those of the command line. `()` for none.
    type Options: DeserializeOwned + JsonSchema + 'static;

    /// Writes the chosen flights into `out`; returns remarks for the user.
    ///
    /// # Errors
    /// Data that the format cannot hold, a fault of the dataset, a system error.
    fn write(options: &Self::Options, source: &Source<'_>, out: &OutFolder) -> Result<Vec<String>>;
}

/// A [`Format`] as an entry of the list.
pub struct Export {
    /// Name on the command line.
    pub name: &'static str,
    /// One line for the help.
    pub doc: &'static str,
    options: fn() -> Vec<ExportOption>,
    prepare: fn(Map<String, Value>) -> Result<Writer, serde_json::Error>,
}

/// Writes the chosen flights; returns remarks for the user.
type Writer = Box<dyn Fn(&Source<'_>, &OutFolder) -> Result<Vec<String>>>;

impl Export {
    /// The entry of a format.
    pub const fn of<F: Format>() -> Self {
        Self { name: F::NAME, doc: F::DOC, options: options_of::<F::Options>, prepare: prepare::<F> }
    }

    /// Options of the format.
    pub fn options(&self) -> Vec<ExportOption> {
        (self.options)()
    }

    /// The format with `options`, names and values as in its options' JSON Schema; those that are absent have their defaults.
    ///
    /// # Errors
    /// `export-option` for a value that the format does not take. Names that it does not have are not looked at.
    pub(crate) fn with(&self, options: Map<String, Value>) -> Result<Prepared> {
        let write = (self.prepare)(options).map_err(|error| {
            Diagnostic::new("export-option", Fault::Recipe, format!("an option of format `{}` is refused", self.name))
                .because(error)
        })?;
        Ok(Prepared { name: self.name, write })
    }
}

fn prepare<F: Format>(options: Map<String, Value>) -> Result<Writer, serde_json::Error> {
    let options: F::Options = serde_json::from_value(Value::Object(options))?;
    Ok(Box::new(move |source, out| F::write(&options, source, out)))
}

/// A format with its options, ready to write.
pub struct Prepared {
    /// Name of the format.
    pub name: &'static str,
    write: Writer,
}

impl Prepared {
    /// Writes the chosen flights of `dataset` into the new folder `out`; returns its size and remarks for the user.
    /// `progress` is called with the number of frames that are done and of all.
    ///
    /// # Errors
    /// Data that do not fit the format, a fault of the dataset or the choice, a system error. No folder is left then.
    pub fn write(
        &self,
        dataset: &PublishedDataset,
        choice: &Choice,
        out: &Path,
        progress: &dyn Fn(u64, u64),
    ) -> Result<(Written, Vec<String>)> {
        let source = Source::new(dataset, choice, progress)?;
        let folder = OutFolder::begin(out, dataset.folder())?;
        let mut remarks = (self.write)(&source, &folder)?;
        remarks.extend(source.remarks());
        Ok((folder.finish()?, remarks))
    }
}
