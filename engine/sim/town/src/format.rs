//! The seam of map formats: [`MapFormat`] for one format, [`Format`] for a list of them.

use crate::{FormatOptions, MapError};
use core::fmt;
use cosfly_domain::Town;
use schemars::JsonSchema;
use serde::{Serialize, de::DeserializeOwned};
use serde_json::Value;

/// A map format: a reader over bytes, and the options that it owns.
///
/// Laws, tested over all formats: a format recognises its own files only; truncated, damaged and absurd files are
/// refused with an error in bounded time and memory; the same bytes and options give the same town; formats that have
/// an option of the same name describe it alike.
pub trait MapFormat {
    /// Options of the format. A recipe gives them in the table `options` of its stage `map`.
    type Options: Default + Serialize + DeserializeOwned + JsonSchema;

    /// Name in messages and in the reference.
    const NAME: &'static str;

    /// A small file with everything that the format can say; the laws run over it.
    const EXAMPLE: &'static [u8];

    /// Whether a file that begins with `head`, at most [`Format::HEAD_BYTES`] bytes, is of this format.
    fn recognises(head: &[u8]) -> bool;

    /// The town as the file states it, and warnings about what the reader coped with. Planning boxes, bounds and the
    /// fill follow later, for all formats alike.
    ///
    /// # Errors
    /// The broken rule, its place in the file, and what the user can do.
    fn read(bytes: &[u8], options: &Self::Options) -> Result<(Town, Vec<String>), MapError>;
}

/// [`MapFormat::read`] of any format.
type Read = fn(&[u8], &FormatOptions) -> Result<(Town, Vec<String>), MapError>;

/// A [`MapFormat`] without its types.
#[derive(Clone, Copy)]
pub struct Format {
    name: &'static str,
    example: &'static [u8],
    recognises: fn(&[u8]) -> bool,
    read: Read,
    schema: fn() -> Value,
    filled: fn(&FormatOptions) -> Result<FormatOptions, MapError>,
}

impl Format {
    /// Bytes at the beginning of a file that tell its format.
    pub const HEAD_BYTES: usize = 4096;

    /// The format `F`.
    pub const fn of<F: MapFormat>() -> Self {
        Self {
            name: F::NAME,
            example: F::EXAMPLE,
            recognises: F::recognises,
            read: |bytes, options| F::read(bytes, &read_options::<F>(options)?),
            schema: || schemars::schema_for!(F::Options).to_value(),
            filled: |options| Ok(FormatOptions::of(&read_options::<F>(options)?)),
        }
    }

    /// Name in messages and in the reference.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// See [`MapFormat::EXAMPLE`].
    pub fn example(&self) -> &'static [u8] {
        self.example
    }

    /// Whether a file that begins with `bytes` is of this format.
    pub fn recognises(&self, bytes: &[u8]) -> bool {
        (self.recognises)(&bytes[..bytes.len().min(Self::HEAD_BYTES)])
    }

    /// See [`MapFormat::read`].
    ///
    /// # Errors
    /// Those of [`MapFormat::read`], and options that do not belong to this format.
    pub fn read(&self, bytes: &[u8], options: &FormatOptions) -> Result<(Town, Vec<String>), MapError> {
        (self.read)(bytes, options)
    }

    /// JSON Schema of the format's options, an object.
    pub fn schema(&self) -> Value {
        (self.schema)()
    }

    /// Names of the format's options, sorted.
    pub fn option_names(&self) -> Vec<String> {
        let schema = self.schema();
        schema["properties"].as_object().into_iter().flatten().map(|(name, _)| name.clone()).collect()
    }

    /// Those of `options` that belong to this format, and the defaults of its others.
    ///
    /// # Errors
    /// An option of the wrong type.
    pub fn filled(&self, options: &FormatOptions) -> Result<FormatOptions, MapError> {
        (self.filled)(&options.only(&self.option_names()))
    }
}

impl fmt::Debug for Format {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(self.name)
    }
}

fn read_options<F: MapFormat>(options: &FormatOptions) -> Result<F::Options, MapError> {
    options.read().map_err(|rule| MapError::new(format!("an option does not belong to {} maps: {rule}", F::NAME)))
}
