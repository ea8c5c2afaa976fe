//! Objectives: a trait for authors, and the functions of the interface behind it.

use crate::abi::{Answer, Refusal};
use crate::running::Running;
use crate::{Metadata, Params, Point};

/// Where a flight is to be.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Site {
    /// The seed of the recipe, the stage and the item: other items are to be other flights.
    pub seed: u64,
    /// Seconds between steps.
    pub dt: f64,
    /// Most steps.
    pub max_steps: usize,
    /// The ground that people use, from above: smallest x and y, largest x and y.
    pub bounds: [f64; 4],
    /// Distance that is kept from obstacles, metres.
    pub clearance: f64,
    /// Largest speed, metres per second.
    pub max_speed: f64,
}

/// The points to look at and the places to be, step by step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plan {
    watched: Vec<Point>,
    places: Vec<Point>,
    pull: Vec<f64>,
    notes: Vec<(String, String)>,
}

impl Plan {
    /// Adds a step: the point to look at, where to be, and how much that matters (0 to 1; 1 marks a waypoint that is to be met).
    pub fn push(&mut self, watched: Point, place: Point, pull: f64) {
        self.watched.push(watched);
        self.places.push(place);
        self.pull.push(pull);
    }

    /// Adds a fact for the summary.
    pub fn note(&mut self, name: &str, value: impl ToString) {
        self.notes.push((name.to_owned(), value.to_string()));
    }

    /// How many steps there are.
    pub fn len(&self) -> usize {
        self.pull.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.pull.is_empty()
    }

    /// Where to be at each step.
    pub fn places(&self) -> &[Point] {
        &self.places
    }

    /// The point to look at at each step.
    pub fn watched(&self) -> &[Point] {
        &self.watched
    }

    /// The steps that mark waypoints.
    pub fn marks(&self) -> Vec<usize> {
        (0..self.len()).filter(|step| self.pull[*step] >= 1.0).collect()
    }
}

/// An objective.
pub trait Objective: Sized + 'static {
    /// The parameters; [`NoParams`](crate::NoParams) for none.
    type Params: Params;

    /// Name, version and purpose.
    fn describe() -> Metadata;
    /// A configured objective.
    ///
    /// # Errors
    /// Parameters that contradict each other.
    fn new(params: Self::Params) -> Result<Self, String>;
    /// The reference of one flight.
    ///
    /// # Errors
    /// Why there is nothing to fly; the item is published as rejected, with these words.
    fn produce(&self, site: &Site) -> Result<Plan, String>;
}

impl<T: Objective> Running<T> {
    pub fn configure_objective(&mut self, text: &str) -> Answer {
        Answer::outcome(self.put(text, T::new).map(drop), |all, ()| all)
    }

    pub fn produce(&self, site: &Site) -> Answer {
        let plan = self.get().and_then(|objective| objective.produce(site).map_err(Refusal::Failed));
        Answer::outcome(plan, |all, plan| {
            let all = all.list(plan.watched.into_flattened()).list(plan.places.into_flattened()).list(plan.pull);
            all.records(plan.notes, |all, (name, value)| all.text(name).text(value))
        })
    }
}

/// Makes a type that is an [`Objective`](crate::Objective) the plugin of this crate.
#[macro_export]
macro_rules! objective {
    ($objective:ty) => {
        #[cfg(target_family = "wasm")]
        const _: () = {
            use $crate::macros::{RefCell, Running, abi, description, thread_local};
            $crate::border!();
            thread_local! {
                static RUNNING: RefCell<Running<$objective>> = const { RefCell::new(Running::new()) };
            }

            #[unsafe(export_name = "cosfly:plugin/reference@0.1.0#describe")]
            extern "C" fn describe() -> *const usize {
                let metadata = <$objective as $crate::Objective>::describe();
                description::<<$objective as $crate::Objective>::Params>(metadata).leave()
            }

            #[unsafe(export_name = "cosfly:plugin/reference@0.1.0#configure")]
            unsafe extern "C" fn configure(text: *mut u8, bytes: usize) -> *const usize {
                // SAFETY: the host keeps to the canonical ABI, here and below.
                let text = unsafe { abi::text(text, bytes) };
                RUNNING.with_borrow_mut(|running| running.configure_objective(&text)).leave()
            }

            // Address and count of the bounds, and of the channels.
            #[unsafe(export_name = "cosfly:plugin/reference@0.1.0#produce")]
            unsafe extern "C" fn produce(
                seed: u64,
                dt: f64,
                max_steps: usize,
                bounds: *mut f64,
                b: usize,
                clearance: f64,
                max_speed: f64,
                _: *mut u8,
                _: usize,
            ) -> *const usize {
                let bounds = unsafe { abi::list(bounds, b) }.try_into().unwrap_or_default();
                let site = $crate::Site { seed, dt, max_steps, bounds, clearance, max_speed };
                RUNNING.with_borrow(|running| running.produce(&site)).leave()
            }
        };
    };
}
