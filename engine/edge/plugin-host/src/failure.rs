//! Faults of plugins: the plugin, the function, the limit.

use cosfly_diagnose::{Diagnostic, Fault};

/// A refusal or a failure of a plugin.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PluginError {
    /// The file, as the user wrote it.
    pub plugin: String,
    /// The function of the interface, when one was running.
    pub function: Option<&'static str>,
    /// The fault: the value and the limit or rule.
    pub message: String,
    /// Remedy.
    pub hint: Option<String>,
}

impl PluginError {
    /// A refusal before any function runs.
    pub fn refused(plugin: &str, message: impl Into<String>) -> Self {
        Self { plugin: plugin.to_owned(), function: None, message: message.into(), hint: None }
    }

    /// A failure of a function.
    pub fn failed(plugin: &str, function: &'static str, message: impl Into<String>) -> Self {
        Self { plugin: plugin.to_owned(), function: Some(function), message: message.into(), hint: None }
    }

    /// Adds what to do next.
    pub fn hint(self, hint: impl Into<String>) -> Self {
        Self { hint: Some(hint.into()), ..self }
    }

    /// Diagnostic for users; `item` is the item that failed.
    pub fn diagnostic(&self, item: Option<&str>) -> Box<Diagnostic> {
        let place = item.map_or_else(String::new, |item| format!(" for `{item}`"));
        let diagnostic = match self.function {
            Some(function) => {
                let message = format!("plugin `{}` failed in `{function}`{place}", self.plugin);
                Diagnostic::new("plugin-failed", Fault::Input, message)
            }
            None => {
                let message = format!("plugin `{}` cannot be used{place}", self.plugin);
                Diagnostic::new("plugin-refused", Fault::Input, message)
            }
        };
        let diagnostic = diagnostic.because(&self.message);
        match &self.hint {
            Some(hint) => diagnostic.hint(hint),
            None if self.function.is_none() => diagnostic.hint(
                "a plugin is the `.wasm` file that `cargo build --release --target wasm32-unknown-unknown` writes below \
                 `target`; `cosfly plugin check FILE` says of which kind it is",
            ),
            None => diagnostic,
        }
    }
}

impl std::fmt::Display for PluginError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.function {
            Some(function) => write!(f, "plugin `{}` failed in `{function}`: {}", self.plugin, self.message),
            None => write!(f, "plugin `{}`: {}", self.plugin, self.message),
        }
    }
}

impl std::error::Error for PluginError {}
