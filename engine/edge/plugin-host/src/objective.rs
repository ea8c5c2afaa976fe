//! A plugin as an objective: asked once per flight for what to look at, from where, when.

use crate::failure::PluginError;
use crate::interface_0_1::{Plan, Refusal, SiteContext};
use crate::plugin::Plugin;
use crate::sandbox::Said;
use crate::session::Session;
use crate::town::TownView;
use cosfly_diagnose::{counted, plausible, visible_text};
use std::sync::Arc;
use wasmtime::component::TypedFunc;

type Configure = TypedFunc<(String,), (Result<(), Refusal>,)>;
type Produce = TypedFunc<(SiteContext,), (Result<Plan, Refusal>,)>;

/// Result of drawing a reference.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawn {
    /// The reference; lengths and numbers are checked.
    pub plan: Plan,
    /// Messages of the plugin to users.
    pub warnings: Vec<String>,
    /// All that it said.
    pub said: Vec<Said>,
}

/// Asks `plugin` for a reference, with parameters as JSON text.
///
/// # Errors
/// Refusal or fault of the plugin; `Err` inside is its own word that there is nothing to fly.
pub fn draw_reference(
    plugin: &Plugin,
    town: Arc<dyn TownView>,
    params: &str,
    site: SiteContext,
) -> Result<Result<Drawn, String>, PluginError> {
    let mut session = Session::open(plugin, town)?;
    let configure: Configure = session.function("configure")?;
    let produce: Produce = session.function("produce")?;
    let (configured,) = session.call("configure", &configure, (params.to_owned(),))?;
    configured.map_err(|refusal| PluginError::failed(&plugin.shown, "configure", refusal.words()))?;
    let max_steps = site.max_steps as usize;
    let (plan,) = session.call("produce", &produce, (site,))?;
    let mut plan = match plan {
        Ok(plan) => plan,
        Err(refusal @ Refusal::Failed(_)) => return Ok(Err(refusal.words())),
        Err(refusal) => return Err(PluginError::failed(&plugin.shown, "produce", refusal.words())),
    };
    for text in plan.notes.iter_mut().flat_map(|(name, value)| [name, value]) {
        *text = visible_text(text);
    }
    check(&plan, max_steps).map_err(|message| PluginError::failed(&plugin.shown, "produce", message))?;
    Ok(Ok(Drawn { plan, warnings: session.warnings(), said: session.said() }))
}

fn check(plan: &Plan, max_steps: usize) -> Result<(), String> {
    let steps = plan.pull.len();
    for (name, length) in [("watched", plan.watched.len()), ("places", plan.places.len())] {
        if length != 3 * steps {
            return Err(format!(
                "it returned {length} of `{name}` for {steps}; there must be 3 per step",
                steps = counted(steps, "step"),
                length = counted(length, "number")
            ));
        }
    }
    if !(4..=max_steps).contains(&steps) {
        return Err(format!("it returned {steps}; there must be 4 to {max_steps}", steps = counted(steps, "step")));
    }
    for (name, numbers, width) in [("watched", &plan.watched, 3), ("places", &plan.places, 3), ("pull", &plan.pull, 1)]
    {
        if let Some((at, fault)) = numbers.iter().zip(0..).find_map(|(it, at)| Some((at, plausible(*it).err()?))) {
            return Err(format!("`{name}` at step {} {fault}: {:e}", at / width, numbers[at]));
        }
    }
    if let Some(step) = plan.pull.iter().position(|pull| !(0.0..=1.0).contains(pull)) {
        return Err(format!("`pull` is {} at step {step}; it must be between 0 and 1", plan.pull[step]));
    }
    if plan.notes.len() > 20 || plan.notes.iter().any(|(name, value)| name.len() > 60 || value.len() > 500) {
        return Err("its notes are more than 20, or longer than 60 letters and 500".to_owned());
    }
    Ok(())
}
