//! The border to a cost term: the functions of the interface, through the component model or directly.

use crate::component_term::ComponentTerm;
use crate::direct_term::DirectTerm;
use crate::failure::PluginError;
use crate::interface_0_1::{Refusal, RunContext, TermShape};
use crate::plugin::{Code, Plugin};
use crate::sandbox::Sandbox;
use crate::town::TownView;
use cosfly_frames::DVec3;
use std::sync::Arc;

/// A configured instance of a cost term.
pub enum TermBorder {
    /// In a component.
    Component(ComponentTerm),
    /// In a core module.
    Direct(Box<DirectTerm>),
}

impl TermBorder {
    /// A new instance with parameters as JSON text, and its properties.
    ///
    /// # Errors
    /// The refusal or failure of the plugin.
    pub fn open(plugin: &Plugin, town: Arc<dyn TownView>, params: &str) -> Result<(Self, TermShape), PluginError> {
        match &plugin.compiled.code {
            Code::Module(_) => {
                DirectTerm::open(plugin, town, params).map(|(term, shape)| (Self::Direct(Box::new(term)), shape))
            }
            Code::Component(_) => {
                ComponentTerm::open(plugin, town, params).map(|(term, shape)| (Self::Component(term), shape))
            }
        }
    }

    /// Tells it of a track.
    ///
    /// # Errors
    /// The failure of the plugin; its own refusal inside.
    pub fn begin(&mut self, run: RunContext) -> Result<Result<(), Refusal>, PluginError> {
        match self {
            Self::Component(term) => term.begin(run),
            Self::Direct(term) => term.begin(run),
        }
    }

    /// Writes the costs of `waypoints` and, where wanted, their gradients; the number of costs that the plugin gives. They are written
    /// only if it is the wanted one.
    ///
    /// # Errors
    /// The failure of the plugin; its own refusal inside.
    pub fn evaluate(
        &mut self,
        waypoints: &[DVec3],
        want_gradients: bool,
        costs: &mut [f64],
        gradients: &mut Vec<f64>,
    ) -> Result<Result<usize, Refusal>, PluginError> {
        match self {
            Self::Component(term) => term.evaluate(waypoints, want_gradients, costs, gradients),
            Self::Direct(term) => term.evaluate(waypoints, want_gradients, costs, gradients),
        }
    }

    /// The sandbox that it runs in.
    pub fn sandbox(&self) -> &Sandbox {
        match self {
            Self::Component(term) => term.sandbox(),
            Self::Direct(term) => term.sandbox(),
        }
    }
}
