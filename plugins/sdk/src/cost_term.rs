//! Cost terms: a trait for authors, and the functions of the interface behind it.

use crate::abi::{Answer, Refusal};
use crate::running::Running;
use crate::{Metadata, Params, Point};

/// The properties of a configured term.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Shape {
    /// How many neighbours on each side the cost of a waypoint reads.
    pub support: u32,
    /// Whether [`CostTerm::evaluate`] fills in gradients when asked.
    pub gradients: bool,
}

/// The constants of a planned flight; world frame, metres.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Run {
    /// The seed of the recipe, the stage and the item.
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
    /// The parameters; [`NoParams`](crate::NoParams) for none.
    type Params: Params;

    /// Name, version and purpose.
    fn describe() -> Metadata;
    /// A configured term.
    ///
    /// # Errors
    /// Parameters that contradict each other.
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

/// A plugin that is a cost term, and room for its answers, which are thousands per flight.
#[doc(hidden)]
pub struct RunningTerm<T> {
    term: Running<T>,
    costs: Vec<f64>,
    gradients: Vec<Point>,
    /// Of costs and gradients: 0 for success, then address and count of each.
    answer: [usize; 5],
}

impl<T: CostTerm> RunningTerm<T> {
    pub const fn new() -> Self {
        Self { term: Running::new(), costs: vec![], gradients: vec![], answer: [0; 5] }
    }

    pub fn configure(&mut self, text: &str) -> Answer {
        let shape = self.term.put(text, T::new).map(T::shape);
        Answer::outcome(shape, |all, shape| all.word(shape.support as usize).word(usize::from(shape.gradients)))
    }

    pub fn begin(&mut self, run: Run) -> Answer {
        let begun = self.term.get_mut().and_then(|term| term.begin(run).map_err(Refusal::Failed));
        Answer::outcome(begun, |all, ()| all)
    }

    pub fn evaluate(&mut self, waypoints: &[Point], want_gradients: bool) -> *const usize {
        let Self { term, costs, gradients, answer } = self;
        costs.clear();
        costs.resize(waypoints.len(), 0.0);
        gradients.clear();
        gradients.resize(if want_gradients { waypoints.len() } else { 0 }, [0.0; 3]);
        let wanted = want_gradients.then_some(&mut gradients[..]);
        let evaluated = term.get().and_then(|term| term.evaluate(waypoints, costs, wanted).map_err(Refusal::Failed));
        if evaluated.is_err() {
            return Answer::outcome(evaluated, |all, ()| all).leave();
        }
        let places = [costs.as_ptr().expose_provenance(), gradients.as_ptr().expose_provenance()];
        *answer = [0, places[0], costs.len(), places[1], 3 * gradients.len()];
        answer.as_ptr()
    }
}

impl Run {
    /// A run as it crosses the border.
    #[doc(hidden)]
    pub fn of(seed: u64, dt: f64, targets: &[f64], headings: Vec<f64>, directions: &[f64], body: &[f64]) -> Self {
        let points = |flat: &[f64]| flat.as_chunks::<3>().0.to_vec();
        Self {
            seed,
            dt,
            targets: points(targets),
            headings,
            directions: directions.as_chunks::<2>().0.to_vec(),
            body_points: points(body).as_chunks::<8>().0.to_vec(),
        }
    }
}

/// Makes a type that is a [`CostTerm`](crate::CostTerm) the plugin of this crate.
#[macro_export]
macro_rules! cost_term {
    ($term:ty) => {
        #[cfg(target_family = "wasm")]
        const _: () = {
            use $crate::macros::{RefCell, RunningTerm, abi, description, thread_local};
            $crate::border!();
            thread_local! {
                static RUNNING: RefCell<RunningTerm<$term>> = const { RefCell::new(RunningTerm::new()) };
            }

            #[unsafe(export_name = "cosfly:plugin/cost@0.1.0#describe")]
            extern "C" fn describe() -> *const usize {
                description::<<$term as $crate::CostTerm>::Params>(<$term as $crate::CostTerm>::describe()).leave()
            }

            #[unsafe(export_name = "cosfly:plugin/cost@0.1.0#configure")]
            unsafe extern "C" fn configure(text: *mut u8, bytes: usize) -> *const usize {
                // SAFETY: the host keeps to the canonical ABI, here and below.
                let text = unsafe { abi::text(text, bytes) };
                RUNNING.with_borrow_mut(|running| running.configure(&text)).leave()
            }

            // Address and count of the feet, headings, directions, points of the body and channels.
            #[unsafe(export_name = "cosfly:plugin/cost@0.1.0#begin")]
            unsafe extern "C" fn begin(
                seed: u64,
                dt: f64,
                feet: *mut f64,
                f: usize,
                headings: *mut f64,
                h: usize,
                directions: *mut f64,
                d: usize,
                body: *mut f64,
                b: usize,
                _: *mut u8,
                _: usize,
            ) -> *const usize {
                let (feet, headings, directions, body) = unsafe {
                    (abi::list(feet, f), abi::list(headings, h), abi::list(directions, d), abi::list(body, b))
                };
                let run = $crate::Run::of(seed, dt, &feet, headings, &directions, &body);
                RUNNING.with_borrow_mut(|running| running.begin(run)).leave()
            }

            #[unsafe(export_name = "cosfly:plugin/cost@0.1.0#evaluate")]
            unsafe extern "C" fn evaluate(numbers: *mut f64, count: usize, want_gradients: bool) -> *const usize {
                let numbers = unsafe { abi::list(numbers, count) };
                RUNNING.with_borrow_mut(|running| running.evaluate(numbers.as_chunks().0, want_gradients))
            }
        };
    };
}
