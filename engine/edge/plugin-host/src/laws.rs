//! The laws of plugins, as `cosfly plugin check` tries them: pure, local, finite, with the gradient that their cost has.

use crate::cost_term::PluginTerm;
use crate::failure::PluginError;
use crate::interface_0_1::{Declaration, Plan, SiteContext};
use crate::objective::{Drawn, draw_reference};
use crate::plugin::Plugin;
use crate::tables::run_stage;
use crate::town::NoTown;
use cosfly_frames::{DVec3, RandomStream, Seed, TargetState, TargetTrack};
use cosfly_geometry::BoxBvh;
use cosfly_planner::config::ViewConfig;
use cosfly_planner::gradient::difference_gradient;
use cosfly_planner::{CostTerm, TermContext, Walk};
use cosfly_surroundings::exact::ExactObstacles;
use cosfly_surroundings::ground::GroundGrid;
use std::sync::Arc;

/// Frames of the flights that terms are tried on.
pub const FRAMES: usize = 200;
/// Flights per law.
const FLIGHTS: usize = 6;
/// Step of the differences that gradients are held against, metres.
const STEP_M: f64 = 1e-5;

/// Result of checking a law.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LawFinding {
    /// The law.
    pub law: &'static str,
    /// The observation; how the law was broken, if it was.
    pub words: String,
    /// Whether it holds.
    pub holds: bool,
}

fn holds(law: &'static str, words: impl Into<String>) -> LawFinding {
    LawFinding { law, words: words.into(), holds: true }
}

fn broken(law: &'static str, words: impl Into<String>) -> LawFinding {
    LawFinding { law, words: words.into(), holds: false }
}

/// Calls `visit` with the context of a winding walk of `frames` through an empty town.
pub fn with_context<T>(frames: usize, visit: impl FnOnce(&TermContext<'_>) -> T) -> T {
    let state = |k: usize| {
        let t = k as f64;
        let bend = 0.004 * t * t;
        TargetState { feet_in_world: DVec3::new(0.6 * t, bend, 0.0), heading_rad: 0.01 * t, speed_mps: 1.3 }
    };
    let track = TargetTrack { dt_s: 0.5, height_m: 1.75, radius_m: 0.3, states: (0..frames).map(state).collect() };
    let (exact, grid) = (BoxBvh::build(vec![]), GroundGrid::sample(&track, &|_, _| 0.0, 50.0));
    let surroundings = ExactObstacles::still(&track, &exact, &grid);
    let (view, walk) = (ViewConfig::default(), Walk::of(&track));
    visit(&TermContext { track: &track, view: &view, walk: &walk, surroundings: &surroundings })
}

/// Some way about the walk.
pub fn random_flight(stream: &mut RandomStream, track: &TargetTrack) -> Vec<DVec3> {
    let around = DVec3::new(stream.uniform(-30.0, 30.0), stream.uniform(-30.0, 30.0), stream.uniform(5.0, 40.0));
    let mut jitter = || stream.uniform(-2.0, 2.0);
    track.states.iter().map(|s| s.feet_in_world + around + DVec3::new(jitter(), jitter(), 0.5 * jitter())).collect()
}

/// Tries all laws of cost terms.
///
/// # Errors
/// Fault of the plugin.
pub fn check_cost_term(plugin: &Plugin, params: &str) -> Result<Vec<LawFinding>, PluginError> {
    let mut findings = vec![];
    for frames in [1, 2, 3, FRAMES] {
        with_context(frames, |context| try_flights(plugin, params, context, frames == FRAMES, &mut findings))?;
    }
    findings.insert(0, holds("shape", format!("one cost per waypoint for flights of 1, 2, 3 and {FRAMES} waypoints")));
    Ok(findings)
}

fn try_flights(
    plugin: &Plugin,
    params: &str,
    context: &TermContext<'_>,
    is_whole: bool,
    findings: &mut Vec<LawFinding>,
) -> Result<(), PluginError> {
    let open = || PluginTerm::open(plugin, Arc::new(NoTown), "checked", params, 7);
    let mut stream = Seed::of_item(1, "plugin", "check").stream("flights");
    let flights: Vec<Vec<DVec3>> = (0..FLIGHTS).map(|_| random_flight(&mut stream, context.track)).collect();
    let costs_of = |term: &PluginTerm, flight: &[DVec3]| -> Result<Vec<f64>, PluginError> {
        let mut costs = vec![0.0; flight.len()];
        term.cost(flight, context, &mut costs);
        term.began().failure().map_or(Ok(costs), Err)
    };
    let (first, second) = (open()?, open()?);
    term_begins(&first, context)?;
    term_begins(&second, context)?;
    let forth: Vec<Vec<f64>> = flights.iter().map(|flight| costs_of(&first, flight)).collect::<Result<_, _>>()?;
    if !is_whole {
        return Ok(());
    }
    let mut back: Vec<Vec<f64>> =
        flights.iter().rev().map(|flight| costs_of(&second, flight)).collect::<Result<_, _>>()?;
    back.reverse();
    findings.push(holds("values", "all costs are finite and at least 0"));
    findings.push(if !same_bits(&forth, &back) {
        broken(
            "pure",
            "an instance that was asked in another order gives other costs: it keeps something between calls",
        )
    } else if !is_same_again(&first, context, &flights, &forth, &costs_of)? {
        broken("pure", "asked again, it gives other costs: it keeps something between calls")
    } else {
        holds("pure", "two instances give the same bits, in any order, asked again, told again, between gradients")
    });
    findings.push(check_support(&second, context, &flights[0], &forth[0], &costs_of)?);
    findings.push(check_gradient(&second, context, &flights)?);
    Ok(())
}

/// Whether an instance that was asked much gives the same costs once more: after gradients, after half a flight, and after it
/// was told of the same track again.
fn is_same_again(
    term: &PluginTerm,
    context: &TermContext<'_>,
    flights: &[Vec<DVec3>],
    wanted: &[Vec<f64>],
    costs_of: &CostsOf<'_>,
) -> Result<bool, PluginError> {
    for (flight, wanted) in flights.iter().zip(wanted) {
        term.add_gradient(flight, context, 1.0, &mut vec![DVec3::ZERO; flight.len()]);
        let after_gradients = costs_of(term, flight)?;
        costs_of(term, &flight[..flight.len() / 2])?;
        let after_half = costs_of(term, flight)?;
        term_begins(term, context)?;
        let told_again = costs_of(term, flight)?;
        if !same_bits(&[after_gradients, after_half, told_again], &[wanted.clone(), wanted.clone(), wanted.clone()]) {
            return Ok(false);
        }
    }
    Ok(true)
}

fn term_begins(term: &PluginTerm, context: &TermContext<'_>) -> Result<(), PluginError> {
    term.begin(context);
    term.began().failure().map_or(Ok(()), Err)
}

fn same_bits(a: &[Vec<f64>], b: &[Vec<f64>]) -> bool {
    let bits = |flights: &[Vec<f64>]| flights.iter().flatten().map(|cost| cost.to_bits()).collect::<Vec<_>>();
    bits(a) == bits(b)
}

type CostsOf<'a> = dyn Fn(&PluginTerm, &[DVec3]) -> Result<Vec<f64>, PluginError> + 'a;

fn check_support(
    term: &PluginTerm,
    context: &TermContext<'_>,
    flight: &[DVec3],
    before: &[f64],
    costs_of: &CostsOf<'_>,
) -> Result<LawFinding, PluginError> {
    let support = term.support();
    for moved in [0, context.track.len() / 2, context.track.len() - 1] {
        let mut other = flight.to_vec();
        other[moved] += DVec3::new(1.0, -2.0, 3.0);
        let after = costs_of(term, &other)?;
        let strange = (0..after.len()).find(|k| k.abs_diff(moved) > support && after[*k] != before[*k]);
        if let Some(frame) = strange {
            let words = format!(
                "moving waypoint {moved} changes cost {frame}, {} away; its support is {support}",
                frame.abs_diff(moved)
            );
            return Ok(broken("support", words));
        }
    }
    Ok(holds("support", format!("costs read {support} neighbours on each side, as it says")))
}

fn check_gradient(
    term: &PluginTerm,
    context: &TermContext<'_>,
    flights: &[Vec<DVec3>],
) -> Result<LawFinding, PluginError> {
    if !term.shape().gradients {
        return Ok(holds("gradient", "it gives none; differences are taken, which costs six and more evaluations"));
    }
    let (mut worst, mut strange, mut all) = (0.0_f64, 0, 0);
    for flight in flights {
        let mut given = vec![DVec3::ZERO; flight.len()];
        term.add_gradient(flight, context, 1.0, &mut given);
        let mut wanted = vec![DVec3::ZERO; flight.len()];
        difference_gradient(term, flight, context, 1.0, STEP_M, &mut wanted);
        if let Some(failure) = term.began().failure() {
            return Err(failure);
        }
        for (a, b) in given.iter().zip(&wanted) {
            let off = (*a - *b).length() / (1.0 + b.length());
            all += 1;
            strange += i32::from(off > 1e-4);
            worst = worst.max(off);
        }
    }
    // Kinks, as at the edge of a zone, are allowed at single places.
    let words = format!("largest departure from differences {worst:.1e}, beyond 1e-4 at {strange} of {all} places");
    Ok(if strange * 100 > all { broken("gradient", words) } else { holds("gradient", words) })
}

/// Tries all laws of objectives, in an empty town.
///
/// # Errors
/// Fault of the plugin.
pub fn check_objective(plugin: &Plugin, params: &str) -> Result<Vec<LawFinding>, PluginError> {
    let site = |seed: u64| SiteContext {
        seed,
        dt: 0.5,
        max_steps: 4000,
        bounds: vec![-100.0, -100.0, 100.0, 100.0],
        clearance: 1.5,
        max_speed: 12.0,
        channels: vec![],
    };
    let draw = |seed: u64| draw_reference(plugin, Arc::new(NoTown), params, site(seed));
    let plan = match draw(1)? {
        Ok(Drawn { plan, .. }) => plan,
        Err(reason) => {
            let words = format!("without a town it has nothing to fly: {reason}");
            return Ok(vec![holds("shape", words)]);
        }
    };
    let again = draw(1)?.map(|drawn| drawn.plan);
    let pure = again.as_ref().is_ok_and(|again| plan_bits(again) == plan_bits(&plan));
    let other = draw(2)?.map(|drawn| drawn.plan);
    let differs = other.is_ok_and(|other| plan_bits(&other) != plan_bits(&plan));
    let points =
        |flat: &[f64]| -> Vec<DVec3> { flat.as_chunks::<3>().0.iter().map(|it| DVec3::from_array(*it)).collect() };
    let fastest = |flat: &[f64]| points(flat).windows(2).map(|it| it[1].distance(it[0]) / 0.5).fold(0.0, f64::max);
    let (watched, places) = (fastest(&plan.watched), fastest(&plan.places));
    let speeds =
        format!("watched point at most {watched:.1} m/s, places at most {places:.1} m/s; the drone's limit is 12 m/s");
    Ok(vec![
        holds("shape", format!("{} steps, {:.0} s", plan.pull.len(), plan.pull.len() as f64 * 0.5)),
        if pure {
            holds("pure", "the same seed gives the same bits")
        } else {
            broken("pure", "the same seed gives another plan")
        },
        holds("seed", if differs { "another seed gives another plan" } else { "every seed gives the same plan" }),
        if watched.max(places) <= 12.0 { holds("speed", speeds) } else { broken("speed", speeds) },
    ])
}

fn plan_bits(plan: &Plan) -> Vec<u64> {
    let numbers = plan.watched.iter().chain(&plan.places).chain(&plan.pull);
    numbers.map(|number| number.to_bits()).collect()
}

/// The sample flight with the columns that are declared.
pub type EncodeSample<'a> = dyn Fn(&Declaration) -> Result<Vec<u8>, PluginError> + 'a;
/// Answer, or the expected answer.
pub type ReadAnswer<'a> = dyn Fn(&Declaration, &[u8]) -> Result<String, String> + 'a;

/// Tries all laws of stages on a flight.
///
/// # Errors
/// Fault of the plugin.
pub fn check_stage(
    plugin: &Plugin,
    params: &str,
    encode: &EncodeSample<'_>,
    read: &ReadAnswer<'_>,
) -> Result<Vec<LawFinding>, PluginError> {
    let run = || run_stage(plugin, Arc::new(NoTown), params, encode);
    let (first, second) = (run()?, run()?);
    let declared = &first.0;
    let named = |columns: &[crate::Column]| {
        let each = columns.iter().map(|it| format!("`{}` ({})", it.name, it.kind.words()));
        if columns.is_empty() { "nothing".to_owned() } else { each.collect::<Vec<_>>().join(", ") }
    };
    let undescribed = declared.gives.iter().find(|column| column.doc.is_empty() && !declared.name.is_empty());
    let undescribed = undescribed.filter(|_| declared.effect != crate::Effect::Files);
    Ok(vec![
        match undescribed {
            Some(column) => broken("declaration", format!("it does not say what `{}` means", column.name)),
            None => holds("declaration", format!("reads {}; gives {}", named(&declared.reads), named(&declared.gives))),
        },
        match read(declared, &first.1.answer) {
            Ok(words) => holds("answer", words),
            Err(words) => broken("answer", words),
        },
        if first == second {
            holds("pure", "the same flight gives the same bytes")
        } else {
            broken("pure", "other bytes")
        },
    ])
}
