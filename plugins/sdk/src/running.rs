//! A plugin behind the functions of the interface, of whatever kind: it describes itself and is configured once.

use crate::abi::{Answer, Refusal};
use crate::{Metadata, Params, params};

/// The plugin of a module: none until it is configured.
#[doc(hidden)]
pub struct Running<T>(Option<T>);

impl<T> Running<T> {
    pub const fn new() -> Self {
        Self(None)
    }

    /// Makes the plugin from its parameters, JSON text.
    pub fn put<P: Params>(&mut self, text: &str, new: impl FnOnce(P) -> Result<T, String>) -> Result<&T, Refusal> {
        crate::log::panics_as_messages();
        let plugin = params::from_text(text).and_then(new).map_err(Refusal::InvalidParams)?;
        Ok(self.0.insert(plugin))
    }

    pub fn get(&self) -> Result<&T, Refusal> {
        self.0.as_ref().ok_or_else(unconfigured)
    }

    pub fn get_mut(&mut self) -> Result<&mut T, Refusal> {
        self.0.as_mut().ok_or_else(unconfigured)
    }
}

fn unconfigured() -> Refusal {
    Refusal::Failed("it was not configured".to_owned())
}

/// The answer to `describe`.
pub fn description<P: Params>(metadata: Metadata) -> Answer {
    let Metadata { name, version, summary } = metadata;
    Answer::default().text(name).text(version).text(summary).text(format!("{{{}}}", P::schema()))
}
