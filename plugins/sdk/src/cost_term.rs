//! Cost terms: a trait for authors, and what stands between it and the interface.

use crate::bindings::cost_term::exports::cosfly::plugin::cost as wire;
use crate::running::Running;
use crate::{Metadata, Params, Point};

/// What a configured term is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Shape {
    /// How many neighbours on each side the cost of a waypoint reads.
    pub support: u32,
    /// Whether [`CostTerm::evaluate`] fills in gradients when asked.
    pub gradients: bool,
}

/// What stays the same while a flight is planned.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Run {
    /// Of the recipe, the stage and the item.
    pub seed: u64,
    /// Seconds between frames.
    pub dt: f64,
    /// The target's feet, one per frame.
    pub targets: Vec<Point>,
    /// Where the target faces, radians from x towards y.
    pub headings: Vec<f64>,
    /// Where the target walks, a horizontal unit vector; zero while it stands.
    pub directions: Vec<[f64; 2]>,
    /// The eight points of the body that are to be seen.
    pub body_points: Vec<[Point; 8]>,
}

/// A cost term of the planner: a cost per waypoint of a whole flight.
pub trait CostTerm: Sized + 'static {
    /// Its parameters; [`NoParams`](crate::NoParams) for none.
    type Params: Params;

    /// What it says of itself.
    fn describe() -> Metadata;
    /// A configured term.
    ///
    /// # Errors
    /// What of the parameters contradicts itself.
    fn new(params: Self::Params) -> Result<Self, String>;
    /// Support and gradients; by default, the own waypoint only and none.
    fn shape(&self) -> Shape {
        Shape::default()
    }
    /// Told once per track, before the first cost.
    ///
    /// # Errors
    /// Why it cannot work on this track.
    fn begin(&mut self, run: Run) -> Result<(), String>;
    /// Writes the cost of every waypoint, at least 0; `costs` is as long as `waypoints` and filled with 0. `gradients`, when asked
    /// for, is as long and filled with 0, and takes the slope of the summed costs.
    ///
    /// # Errors
    /// Why it gives up; the flight fails with these words.
    fn evaluate(&self, waypoints: &[Point], costs: &mut [f64], gradients: Option<&mut [Point]>) -> Result<(), String>;
}

/// Waypoints that [`per_waypoint`] takes together.
const GROUP: usize = 8;

/// Writes a cost for every waypoint from the waypoint itself and what is `beside` it (the target's feet, say), a few at a time:
/// the same costs as from a loop, and sooner where they are as light as a square root.
pub fn per_waypoint<T>(waypoints: &[Point], beside: &[T], costs: &mut [f64], cost: impl Fn(Point, &T) -> f64) {
    let count = waypoints.len().min(beside.len()).min(costs.len());
    let (points, last_points) = waypoints[..count].as_chunks::<GROUP>();
    let (others, last_others) = beside[..count].as_chunks::<GROUP>();
    let (groups, last_costs) = costs[..count].as_chunks_mut::<GROUP>();
    for ((points, others), costs) in points.iter().zip(others).zip(groups) {
        let mut group = [0.0; GROUP];
        for ((cost_of, point), other) in group.iter_mut().zip(points).zip(others) {
            *cost_of = cost(*point, other);
        }
        *costs = group;
    }
    for ((point, other), cost_of) in last_points.iter().zip(last_others).zip(last_costs) {
        *cost_of = cost(*point, other);
    }
}

impl<T: CostTerm> Running<T> {
    pub fn configure_term(&mut self, text: &str) -> Result<wire::Shape, wire::Error> {
        let Shape { support, gradients } = self.put(text, T::new)?.shape();
        Ok(wire::Shape { support, gradients })
    }

    pub fn begin(&mut self, run: wire::RunContext) -> Result<(), wire::Error> {
        let term = self.get_mut()?;
        let points = |flat: &[f64]| flat.as_chunks::<3>().0.to_vec();
        let bodies = points(&run.body_points);
        let run = Run {
            seed: run.seed,
            dt: run.dt,
            targets: points(&run.targets),
            headings: run.headings,
            directions: run.directions.as_chunks::<2>().0.to_vec(),
            body_points: bodies.as_chunks::<8>().0.to_vec(),
        };
        term.begin(run).map_err(wire::Error::Failed)
    }

    pub fn evaluate(&self, waypoints: &[f64], want_gradients: bool) -> Result<wire::Evaluation, wire::Error> {
        let term = self.get()?;
        let (points, _) = waypoints.as_chunks::<3>();
        let mut costs = vec![0.0; points.len()];
        let mut gradients = vec![[0.0; 3]; if want_gradients { points.len() } else { 0 }];
        let wanted = want_gradients.then_some(&mut gradients[..]);
        term.evaluate(points, &mut costs, wanted).map_err(wire::Error::Failed)?;
        Ok(wire::Evaluation { costs, gradients: gradients.into_flattened() })
    }
}

/// Makes a type that is a [`CostTerm`](crate::CostTerm) the plugin of this crate.
#[macro_export]
macro_rules! cost_term {
    ($term:ty) => {
        #[cfg(target_family = "wasm")]
        const _: () = {
            use $crate::bindings::cost_term::exports::cosfly::plugin::cost as wire;
            $crate::macros::thread_local! {
                static RUNNING: $crate::macros::RefCell<$crate::macros::Running<$term>> =
                    const { $crate::macros::RefCell::new($crate::macros::Running::new()) };
            }
            struct Plugin;
            impl wire::Guest for Plugin {
                fn describe() -> wire::Metadata {
                    $crate::macros::Running::<$term>::describe::<<$term as $crate::CostTerm>::Params>(
                        <$term as $crate::CostTerm>::describe(),
                    )
                }
                fn configure(params: String) -> Result<wire::Shape, wire::Error> {
                    RUNNING.with_borrow_mut(|running| running.configure_term(&params))
                }
                fn begin(run: wire::RunContext) -> Result<(), wire::Error> {
                    RUNNING.with_borrow_mut(|running| running.begin(run))
                }
                fn evaluate(waypoints: Vec<f64>, want_gradients: bool) -> Result<wire::Evaluation, wire::Error> {
                    RUNNING.with_borrow(|running| running.evaluate(&waypoints, want_gradients))
        }
            }
            $crate::bindings::cost_term::export_cost_term!(Plugin with_types_in $crate::bindings::cost_term);
        };
    };
}
