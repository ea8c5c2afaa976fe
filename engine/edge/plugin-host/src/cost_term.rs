//! A plugin as a cost term of the planner: the solver cannot tell it from a built-in one.

use crate::failure::PluginError;
use crate::interface_0_1::{RunContext, TermShape};
use crate::plugin::Plugin;
use crate::term_border::TermBorder;
use crate::town::TownView;
use cosfly_diagnose::{LARGEST_MAGNITUDE, counted, plausible};
use cosfly_frames::{DVec3, TargetTrack};
use cosfly_planner::{CostTerm, TermContext, Walk};
use cosfly_surroundings::visibility::body_points;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The receiver of gradients.
type Take<'a> = dyn FnMut(&[f64]) + 'a;

/// One configured instance of a plugin, for one flight. Costs nothing more after a failure, which [`Began::failure`] tells.
pub struct PluginTerm {
    name: String,
    shape: TermShape,
    seed: u64,
    running: Arc<Mutex<Running>>,
}

/// The handle that is left of a term once the planner has taken it.
#[derive(Clone)]
pub struct Began(Arc<Mutex<Running>>);

struct Running {
    border: TermBorder,
    /// The last gradients; kept, because some hundreds of calls need room for them.
    gradients: Vec<f64>,
    /// Address and length of the track that it was told of.
    told: Option<(usize, usize)>,
    failure: Option<PluginError>,
}

impl PluginTerm {
    /// Opens `plugin` as the term `name`, with parameters as JSON text.
    ///
    /// # Errors
    /// The refusal or failure of the plugin.
    pub fn open(
        plugin: &Plugin,
        town: Arc<dyn TownView>,
        name: &str,
        params: &str,
        seed: u64,
    ) -> Result<Self, PluginError> {
        let (border, shape) = TermBorder::open(plugin, town, params)?;
        let running = Running { border, gradients: Vec::new(), told: None, failure: None };
        Ok(Self { name: name.to_owned(), shape, seed, running: Arc::new(Mutex::new(running)) })
    }

    /// A handle for asking later how it went.
    pub fn began(&self) -> Began {
        Began(Arc::clone(&self.running))
    }

    /// The properties.
    pub fn shape(&self) -> TermShape {
        self.shape
    }

    fn running(&self) -> MutexGuard<'_, Running> {
        self.running.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Writes the costs of `waypoints` and gives gradients, when wanted, to `take`; false after a failure.
    fn evaluate(
        &self,
        waypoints: &[DVec3],
        context: &TermContext<'_>,
        costs: &mut [f64],
        take: Option<&mut Take<'_>>,
    ) -> bool {
        let mut running = self.running();
        if running.failure.is_none() && running.told != Some(identity(context.track)) {
            running.tell(context, self.seed);
        }
        if running.failure.is_some() {
            return false;
        }
        match (running.evaluate(waypoints, costs, take.is_some()), take) {
            (Ok(()), Some(take)) => take(&running.gradients),
            (Ok(()), None) => {}
            (Err(failure), _) => running.failure = Some(failure),
        }
        running.failure.is_none()
    }
}

impl Began {
    /// The failure, where there was one.
    pub fn failure(&self) -> Option<PluginError> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).failure.clone()
    }

    /// The messages that users are to read.
    pub fn warnings(&self) -> Vec<String> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).border.sandbox().warnings()
    }

    /// The effort of the last call.
    pub fn effort(&self) -> crate::Effort {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).border.sandbox().effort()
    }

    /// All messages.
    pub fn said(&self) -> Vec<crate::Said> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).border.sandbox().said()
    }
}

fn identity(track: &TargetTrack) -> (usize, usize) {
    (track.states.as_ptr() as usize, track.states.len())
}

impl Running {
    fn tell(&mut self, context: &TermContext<'_>, seed: u64) {
        let run = run_context(context.track, context.walk, seed);
        let told = self.border.begin(run).and_then(|answer| {
            answer.map_err(|refusal| PluginError::failed(self.border.sandbox().shown(), "begin", refusal.words()))
        });
        match told {
            Ok(()) => self.told = Some(identity(context.track)),
            Err(failure) => self.failure = Some(failure),
        }
    }

    fn evaluate(&mut self, waypoints: &[DVec3], costs: &mut [f64], want_gradients: bool) -> Result<(), PluginError> {
        let answer = self.border.evaluate(waypoints, want_gradients, costs, &mut self.gradients)?;
        let gradients = want_gradients.then_some(&self.gradients[..]);
        let checked = match answer {
            Ok(count) if count == waypoints.len() => check(costs, gradients, waypoints),
            Ok(count) => Err(format!("it returned {count} costs for {}", counted(waypoints.len(), "waypoint"))),
            Err(refusal) => Err(refusal.words()),
        };
        checked.map_err(|message| PluginError::failed(self.border.sandbox().shown(), "evaluate", message))
    }
}

/// Checks that all costs and gradients are plausible numbers and complete; otherwise the fault.
fn check(costs: &[f64], gradients: Option<&[f64]>, waypoints: &[DVec3]) -> Result<(), String> {
    let is_cost = |cost: &f64| *cost >= 0.0 && plausible(*cost).is_ok();
    if let Some(frame) = first_wrong(costs, 0, is_cost) {
        let message = format!("cost {frame} is {} at waypoint {}", costs[frame], waypoints[frame]);
        return Err(format!("{message}; costs are numbers from 0 to {LARGEST_MAGNITUDE:e}"));
    }
    let Some(gradients) = gradients else { return Ok(()) };
    if gradients.len() != 3 * waypoints.len() {
        let message = format!(
            "it returned {} of gradients for {}",
            counted(gradients.len(), "number"),
            counted(waypoints.len(), "waypoint")
        );
        return Err(format!("{message}; there must be 3 per waypoint"));
    }
    if let Some(at) = first_wrong(gradients, SIGN, |slope| plausible(*slope).is_ok()) {
        let message = format!("number {at} of the gradients is {} at waypoint {}", gradients[at], waypoints[at / 3]);
        return Err(format!("{message}; gradients are numbers up to {LARGEST_MAGNITUDE:e} in magnitude"));
    }
    Ok(())
}

/// The bit of a number's sign.
const SIGN: u64 = 1 << 63;

/// The first number that is not `right`. Plausible positive ones are seen to be right by their bits, some at a time and without
/// the bits of `mask`; only when there are others is every one looked at.
fn first_wrong(numbers: &[f64], mask: u64, right: impl Fn(&f64) -> bool) -> Option<usize> {
    let last = LARGEST_MAGNITUDE.to_bits();
    let strange = |number: &f64| {
        let bits = number.to_bits() & !mask;
        bits | last.wrapping_sub(bits)
    };
    let any = numbers.iter().fold(0, |any, number| any | strange(number));
    if any & SIGN == 0 { None } else { numbers.iter().position(|number| !right(number)) }
}

/// A track as plugins are told of it.
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
        if !self.evaluate(waypoints, context, per_frame, None) {
            per_frame.fill(0.0);
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
        let mut add = |slopes: &[f64]| {
            for (sum, slope) in gradient.iter_mut().zip(slopes.as_chunks::<3>().0) {
                *sum += weight * DVec3::from_array(*slope);
            }
        };
        self.evaluate(waypoints, context, &mut vec![0.0; waypoints.len()], Some(&mut add));
        true
    }
}
