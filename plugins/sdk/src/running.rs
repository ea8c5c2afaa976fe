//! What all kinds of plugins do behind the functions of the interface: describe themselves, and be configured once.

use crate::bindings::types::{Error, Metadata as Told};
use crate::{Metadata, Params, params};

/// A plugin at work: nothing until it is configured.
#[doc(hidden)]
pub struct Running<T>(Option<T>);

impl<T> Running<T> {
    pub const fn new() -> Self {
        Self(None)
    }

    /// What `describe` answers.
    pub fn describe<P: Params>(told: Metadata) -> Told {
        Told {
            name: told.name.to_owned(),
            version: told.version.to_owned(),
            summary: told.summary.to_owned(),
            params_schema: format!("{{{}}}", P::schema()),
        }
    }

    /// Makes the plugin from its parameters, JSON text.
    pub fn put<P: Params>(&mut self, text: &str, new: impl FnOnce(P) -> Result<T, String>) -> Result<&T, Error> {
        crate::log::panics_as_messages();
        let plugin = params::from_text(text).and_then(new).map_err(Error::InvalidParams)?;
        Ok(self.0.insert(plugin))
    }

    pub fn get(&self) -> Result<&T, Error> {
        self.0.as_ref().ok_or_else(unconfigured)
    }

    pub fn get_mut(&mut self) -> Result<&mut T, Error> {
        self.0.as_mut().ok_or_else(unconfigured)
    }
}

fn unconfigured() -> Error {
    Error::Failed("it was not configured".to_owned())
}
