//! A plugin as a stage: one flight in as an Arrow stream, a verdict or labels out.

use crate::failure::PluginError;
use crate::interface_0_1::{Refusal, StageEffect};
use crate::plugin::Plugin;
use crate::session::Session;
use crate::town::TownView;
use std::sync::Arc;
use wasmtime::component::TypedFunc;

type Configure = TypedFunc<(String,), (Result<StageEffect, Refusal>,)>;
type Run = TypedFunc<(Vec<u8>,), (Result<Vec<u8>, Refusal>,)>;

/// What a stage does with flights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// Keeps or rejects each.
    Filter,
    /// Labels their frames.
    Label,
}

/// What came of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Transformed {
    /// What to read into the answer.
    pub effect: Effect,
    /// An Arrow stream, not looked at yet.
    pub answer: Vec<u8>,
    /// What the plugin said that users are to read.
    pub warnings: Vec<String>,
}

/// Gives `flight` to `plugin`, with parameters as JSON text.
///
/// # Errors
/// What the plugin refuses or does wrong.
pub fn run_transform(
    plugin: &Plugin,
    town: Arc<dyn TownView>,
    params: &str,
    flight: Vec<u8>,
) -> Result<Transformed, PluginError> {
    let mut session = Session::open(plugin, town)?;
    let configure: Configure = session.function("configure")?;
    let run: Run = session.function("run")?;
    let (effect,) = session.call("configure", &configure, (params.to_owned(),))?;
    let effect = effect.map_err(|refusal| PluginError::failed(&plugin.shown, "configure", refusal.words()))?;
    let (answer,) = session.call("run", &run, (flight,))?;
    let answer = answer.map_err(|refusal| PluginError::failed(&plugin.shown, "run", refusal.words()))?;
    let effect = match effect {
        StageEffect::Filter => Effect::Filter,
        StageEffect::Label => Effect::Label,
    };
    Ok(Transformed { effect, answer, warnings: session.warnings() })
}
