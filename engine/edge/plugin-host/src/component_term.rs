//! A cost term in a component.

use crate::failure::PluginError;
use crate::interface_0_1::{Evaluation, Refusal, RunContext, TermShape};
use crate::plugin::Plugin;
use crate::sandbox::Sandbox;
use crate::session::Session;
use crate::town::TownView;
use cosfly_frames::DVec3;
use std::sync::Arc;
use wasmtime::component::TypedFunc;

type Configure = TypedFunc<(String,), (Result<TermShape, Refusal>,)>;
type Begin = TypedFunc<(RunContext,), (Result<(), Refusal>,)>;
type Evaluate<'a> = TypedFunc<(&'a [f64], bool), (Result<Evaluation, Refusal>,)>;

/// One instance.
pub struct ComponentTerm {
    session: Session,
    begin: Begin,
    evaluate: Evaluate<'static>,
    /// The waypoints as they cross the border; kept, because some thousands of calls need it.
    flat: Vec<f64>,
}

impl ComponentTerm {
    /// An instance with parameters as JSON text.
    pub fn open(plugin: &Plugin, town: Arc<dyn TownView>, params: &str) -> Result<(Self, TermShape), PluginError> {
        let mut session = Session::open(plugin, town)?;
        let configure: Configure = session.function("configure")?;
        let (begin, evaluate) = (session.function("begin")?, session.function("evaluate")?);
        let (shape,) = session.call("configure", &configure, (params.to_owned(),))?;
        let shape = shape.map_err(|refusal| PluginError::failed(&plugin.shown, "configure", refusal.words()))?;
        Ok((Self { session, begin, evaluate, flat: Vec::new() }, shape))
    }

    /// Tells it of a track.
    ///
    /// # Errors
    /// The failure of the plugin; its own refusal inside.
    pub fn begin(&mut self, run: RunContext) -> Result<Result<(), Refusal>, PluginError> {
        self.session.call("begin", &self.begin, (run,)).map(|(outcome,)| outcome)
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
        self.flat.resize(3 * waypoints.len(), 0.0);
        let (triples, _) = self.flat.as_chunks_mut::<3>();
        triples.iter_mut().zip(waypoints).for_each(|(triple, waypoint)| *triple = waypoint.to_array());
        let function: Evaluate<'_> = self.evaluate;
        let (answer,) = self.session.call("evaluate", &function, (&self.flat[..], want_gradients))?;
        Ok(answer.map(|given| {
            if given.costs.len() == costs.len() {
                costs.copy_from_slice(&given.costs);
            }
            *gradients = given.gradients;
            given.costs.len()
        }))
    }

    /// The sandbox that it runs in.
    pub fn sandbox(&self) -> &Sandbox {
        self.session.sandbox()
    }
}
