//! Objectives: a trait for authors, and what stands between it and the interface.

use crate::bindings::objective::exports::cosfly::plugin::reference as wire;
use crate::running::Running;
use crate::{Metadata, Params, Point};

/// Where a flight is to be.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Site {
    /// Of the recipe, the stage and the item: other items are to be other flights.
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

/// What to look at, from where, step by step.
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

    /// What to look at at each step.
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
    /// Its parameters; [`NoParams`](crate::NoParams) for none.
    type Params: Params;

    /// What it says of itself.
    fn describe() -> Metadata;
    /// A configured objective.
    ///
    /// # Errors
    /// What of the parameters contradicts itself.
    fn new(params: Self::Params) -> Result<Self, String>;
    /// The reference of one flight.
    ///
    /// # Errors
    /// Why there is nothing to fly; the item is published as rejected, with these words.
    fn produce(&self, site: &Site) -> Result<Plan, String>;
}

impl<T: Objective> Running<T> {
    pub fn configure_objective(&mut self, text: &str) -> Result<(), wire::Error> {
        self.put(text, T::new).map(drop)
    }

    pub fn produce(&self, site: wire::Site) -> Result<wire::Plan, wire::Error> {
        let objective = self.get()?;
        let site = Site {
            seed: site.seed,
            dt: site.dt,
            max_steps: site.max_steps as usize,
            bounds: site.bounds.try_into().unwrap_or_default(),
            clearance: site.clearance,
            max_speed: site.max_speed,
        };
        let plan = objective.produce(&site).map_err(wire::Error::Failed)?;
        Ok(wire::Plan {
            watched: plan.watched.into_flattened(),
            places: plan.places.into_flattened(),
            pull: plan.pull,
            notes: plan.notes,
        })
    }
}

/// Makes a type that is an [`Objective`](crate::Objective) the plugin of this crate.
#[macro_export]
macro_rules! objective {
    ($objective:ty) => {
        #[cfg(target_family = "wasm")]
        const _: () = {
            use $crate::bindings::objective::exports::cosfly::plugin::reference as wire;
            $crate::macros::thread_local! {
                static RUNNING: $crate::macros::RefCell<$crate::macros::Running<$objective>> =
                    const { $crate::macros::RefCell::new($crate::macros::Running::new()) };
            }
            struct Plugin;
            impl wire::Guest for Plugin {
                fn describe() -> wire::Metadata {
                    $crate::macros::Running::<$objective>::describe::<<$objective as $crate::Objective>::Params>(
                        <$objective as $crate::Objective>::describe(),
                    )
                }
                fn configure(params: String) -> Result<(), wire::Error> {
                    RUNNING.with_borrow_mut(|running| running.configure_objective(&params))
                }
                fn produce(site: wire::Site) -> Result<wire::Plan, wire::Error> {
                    RUNNING.with_borrow(|running| running.produce(site))
        }
            }
            $crate::bindings::objective::export_objective!(Plugin with_types_in $crate::bindings::objective);
        };
    };
}
