//! A plugin as a cost term of the planner: the solver cannot tell it from a built-in one.

use crate::failure::PluginError;
use crate::interface_0_1::{Evaluation, Refusal, RunContext, TermShape};
use crate::plugin::Plugin;
use crate::session::Session;
use crate::town::TownView;
use cosfly_frames::{DVec3, TargetTrack};
use cosfly_planner::walk::Walk;
use cosfly_planner::{CostTerm, TermContext, body_points};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use wasmtime::component::TypedFunc;

type Configure = TypedFunc<(String,), (Result<TermShape, Refusal>,)>;
type Begin = TypedFunc<(RunContext,), (Result<(), Refusal>,)>;
type Evaluate<'a> = TypedFunc<(&'a [f64], bool), (Result<Evaluation, Refusal>,)>;

/// One configured instance of a plugin, for one flight. Costs nothing more after a failure, which [`Began::failure`] tells.
pub struct PluginTerm {
    name: String,
    shape: TermShape,
    seed: u64,
    running: Arc<Mutex<Running>>,
}

/// What is left of a term when the planner has taken it.
#[derive(Clone)]
pub struct Began(Arc<Mutex<Running>>);

struct Running {
    session: Session,
    begin: Begin,
    evaluate: Evaluate<'static>,
    /// The waypoints as they cross the border; kept, because some thousands of calls need it.
    flat: Vec<f64>,
    /// Address and length of the track that it was told of.
    told: Option<(usize, usize)>,
    failure: Option<PluginError>,
}

impl PluginTerm {
    /// Opens `plugin` as the term `name`, with parameters as JSON text.
    ///
    /// # Errors
    /// What the plugin refuses or does wrong.
    pub fn open(
        plugin: &Plugin,
        town: Arc<dyn TownView>,
        name: &str,
        params: &str,
        seed: u64,
    ) -> Result<Self, PluginError> {
        let mut session = Session::open(plugin, town)?;
        let configure: Configure = session.function("configure")?;
        let (begin, evaluate) = (session.function("begin")?, session.function("evaluate")?);
        let (shape,) = session.call("configure", &configure, (params.to_owned(),))?;
        let shape = shape.map_err(|refusal| PluginError::failed(&plugin.shown, "configure", refusal.words()))?;
        let running = Running { session, begin, evaluate, flat: Vec::new(), told: None, failure: None };
        Ok(Self { name: name.to_owned(), shape, seed, running: Arc::new(Mutex::new(running)) })
    }

    /// For asking how it went, later.
    pub fn began(&self) -> Began {
        Began(Arc::clone(&self.running))
    }

    /// What it is.
    pub fn shape(&self) -> TermShape {
        self.shape
    }

    fn running(&self) -> MutexGuard<'_, Running> {
        self.running.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Costs and, when wanted and known, gradients of `waypoints`; `None` after a failure.
    fn evaluate(&self, waypoints: &[DVec3], context: &TermContext<'_>, want_gradients: bool) -> Option<Evaluation> {
        let mut running = self.running();
        if running.failure.is_none() && running.told != Some(identity(context.track)) {
            running.tell(context, self.seed);
        }
        if running.failure.is_some() {
            return None;
        }
        match running.evaluate(waypoints, want_gradients) {
            Ok(evaluation) => Some(evaluation),
            Err(failure) => {
                running.failure = Some(failure);
                None
            }
        }
    }
}

impl Began {
    /// Why it gave up, if it did.
    pub fn failure(&self) -> Option<PluginError> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).failure.clone()
    }

    /// What it said that users are to read.
    pub fn warnings(&self) -> Vec<String> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).session.warnings()
    }

    /// What its last call took.
    pub fn effort(&self) -> crate::Effort {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).session.effort()
    }

    /// All that it said.
    pub fn said(&self) -> Vec<crate::Said> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).session.said()
    }
}

fn identity(track: &TargetTrack) -> (usize, usize) {
    (track.states.as_ptr() as usize, track.states.len())
}

impl Running {
    fn tell(&mut self, context: &TermContext<'_>, seed: u64) {
        let run = run_context(context.track, context.walk, seed);
        let told = self.session.call("begin", &self.begin, (run,)).and_then(|(answer,)| {
            answer.map_err(|refusal| PluginError::failed(self.session.shown(), "begin", refusal.words()))
        });
        match told {
            Ok(()) => self.told = Some(identity(context.track)),
            Err(failure) => self.failure = Some(failure),
        }
    }

    fn evaluate(&mut self, waypoints: &[DVec3], want_gradients: bool) -> Result<Evaluation, PluginError> {
        self.flat.resize(3 * waypoints.len(), 0.0);
        let (triples, _) = self.flat.as_chunks_mut::<3>();
        triples.iter_mut().zip(waypoints).for_each(|(triple, waypoint)| *triple = waypoint.to_array());
        let function: Evaluate<'_> = self.evaluate;
        let (answer,) = self.session.call("evaluate", &function, (&self.flat[..], want_gradients))?;
        let failed = |message: String| PluginError::failed(self.session.shown(), "evaluate", message);
        let evaluation = answer.map_err(|refusal| failed(refusal.words()))?;
        let (costs, gradients) = (&evaluation.costs, &evaluation.gradients);
        if costs.len() != waypoints.len() {
            return Err(failed(format!("it returned {} costs for {} waypoints", costs.len(), waypoints.len())));
        }
        if want_gradients && gradients.len() != 3 * waypoints.len() {
            let message =
                format!("it returned {} numbers of gradients for {} waypoints", gradients.len(), waypoints.len());
            return Err(failed(format!("{message}; there must be 3 per waypoint")));
        }
        let is_cost = |cost: &f64| *cost >= 0.0 && *cost < f64::INFINITY;
        if !costs.iter().all(is_cost) {
            let frame = costs.iter().position(|cost| !is_cost(cost)).unwrap_or_default();
            let message = format!("cost {frame} is {} at waypoint {}", costs[frame], waypoints[frame]);
            return Err(failed(format!("{message}; costs are finite and at least 0")));
        }
        if want_gradients && !gradients.iter().all(|slope| slope.is_finite()) {
            let at = gradients.iter().position(|slope| !slope.is_finite()).unwrap_or_default();
            let message =
                format!("number {at} of the gradients is {} at waypoint {}", gradients[at], waypoints[at / 3]);
            return Err(failed(format!("{message}; gradients are finite")));
        }
        Ok(evaluation)
    }
}

/// What a plugin is told of a track.
fn run_context(track: &TargetTrack, walk: &Walk, seed: u64) -> RunContext {
    let bodies = track.states.iter().flat_map(|state| body_points(state, track.height_m));
    RunContext {
        seed,
        dt: track.dt_s,
        targets: track.states.iter().flat_map(|state| state.feet_in_world.to_array()).collect(),
        headings: track.states.iter().map(|state| state.heading_rad).collect(),
        directions: walk.direction.iter().flat_map(|direction| direction.to_array()).collect(),
        body_points: bodies.flat_map(|point| point.to_array()).collect(),
        channels: Vec::new(),
    }
}

impl CostTerm for PluginTerm {
    fn name(&self) -> &str {
        &self.name
    }

    fn support(&self) -> usize {
        self.shape.support as usize
    }

    fn begin(&self, context: &TermContext<'_>) {
        let mut running = self.running();
        if running.failure.is_none() {
            running.tell(context, self.seed);
        }
    }

    fn cost(&self, waypoints: &[DVec3], context: &TermContext<'_>, per_frame: &mut [f64]) {
        match self.evaluate(waypoints, context, false) {
            Some(evaluation) => per_frame.copy_from_slice(&evaluation.costs),
            None => per_frame.fill(0.0),
        }
    }

    fn add_gradient(
        &self,
        waypoints: &[DVec3],
        context: &TermContext<'_>,
        weight: f64,
        gradient: &mut [DVec3],
    ) -> bool {
        if !self.shape.gradients {
            return false;
        }
        if let Some(evaluation) = self.evaluate(waypoints, context, true) {
            let (slopes, _) = evaluation.gradients.as_chunks::<3>();
            for (sum, slope) in gradient.iter_mut().zip(slopes) {
                *sum += weight * DVec3::from_array(*slope);
            }
        }
        true
    }
}
