//! The border to a cost term: the interface's functions, however they are called.

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
pub trait TermBorder: Send {
    /// Tells it of a track.
    ///
    /// # Errors
    /// What the plugin did wrong; its own words inside.
    fn begin(&mut self, run: RunContext) -> Result<Result<(), Refusal>, PluginError>;

    /// Writes the costs of `waypoints` and, when wanted, their gradients, as the plugin gives them; how many costs that are. They
    /// are written only when that is how many are wanted.
    ///
    /// # Errors
    /// What the plugin did wrong; its own words inside.
    fn evaluate(
        &mut self,
        waypoints: &[DVec3],
        want_gradients: bool,
        costs: &mut [f64],
        gradients: &mut Vec<f64>,
    ) -> Result<Result<usize, Refusal>, PluginError>;

    /// Where it runs.
    fn sandbox(&self) -> &Sandbox;
}

/// A new instance with parameters as JSON text.
///
/// # Errors
/// What the plugin refuses or does wrong.
pub fn open(
    plugin: &Plugin,
    town: Arc<dyn TownView>,
    params: &str,
) -> Result<(Box<dyn TermBorder>, TermShape), PluginError> {
    Ok(match &plugin.compiled.code {
        Code::Module(_) => {
            let (term, shape) = DirectTerm::open(plugin, town, params)?;
            (Box::new(term), shape)
        }
        Code::Component(_) => {
            let (term, shape) = ComponentTerm::open(plugin, town, params)?;
            (Box::new(term), shape)
        }
    })
}
