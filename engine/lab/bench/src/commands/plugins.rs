//! `plugins`: the cost of the border of plugins, against the same terms in native code, side by side in one run.

use super::outcome::{Outcome, print};
use cosfly_domain::PlanOutcome;
use cosfly_frames::{DVec3, Seed};
use cosfly_geometry::BoxBvh;
use cosfly_lab::clock::thread_cpu_s;
use cosfly_lab::median::median;
use cosfly_planner::{CostTerm, MucoConfig, TermContext, WeightedTerm, plan_with_terms};
use cosfly_plugin_host::{Host, Kind, NoTown, Plugin, PluginError, PluginLimits, PluginTerm, laws};
use cosfly_scenes::{SceneKind, SeededScene};
use std::fmt::Write;
use std::sync::Arc;
use std::time::Instant;

#[path = "../../twin/src/kernels.rs"]
mod kernels;

/// The plugin whose terms are native, too.
const TWIN: &[u8] = include_bytes!("../../twin/twin.wasm");
/// Rounds, and calls per round.
const ROUNDS: usize = 31;
const CALLS: usize = 200;
/// Rounds of whole flights.
const FLIGHT_ROUNDS: usize = 7;

/// The native twin of the plugin.
struct Native {
    heavy: bool,
}

impl CostTerm for Native {
    fn name(&self) -> &str {
        "twin"
    }

    fn support(&self) -> usize {
        0
    }

    fn cost(&self, waypoints: &[DVec3], context: &TermContext<'_>, per_frame: &mut [f64]) {
        let each = waypoints.iter().zip(&context.track.states).zip(per_frame);
        if self.heavy {
            each.for_each(|((w, s), cost)| *cost = kernels::heavy(w.to_array(), s.feet_in_world.to_array()));
        } else {
            each.for_each(|((w, s), cost)| *cost = kernels::root(w.to_array(), s.feet_in_world.to_array()));
        }
    }
}

/// Prints a table of ratios.
pub fn plugins() -> Outcome {
    let one = |error: PluginError| vec![error.diagnostic(None)];
    let host = Host::new(None);
    let limits = PluginLimits::default();
    let twin = host.load_bytes(TWIN, "twin.wasm", Some(Kind::CostTerm), limits).map_err(one)?;
    let mut text = String::from(
        "CPU time of this thread, median of rounds taken in turn; deadlines on; 200 waypoints per call\n\n\
         what                                      native     plugin    ratio\n",
    );
    for (heavy, what) in
        [(false, "a term of one square root, per call"), (true, "a term full of exp and atan2, per call")]
    {
        let (native, plugin, same) = calls(&twin, heavy).map_err(one)?;
        let _ =
            writeln!(text, "{what:<40} {native:>6.2} us  {plugin:>6.2} us   {:>5.2}   costs {same}", plugin / native);
    }
    let strict = PluginLimits { fuel: 1_000_000_000, ..limits };
    let strict = host.load_bytes(TWIN, "twin.wasm", Some(Kind::CostTerm), strict).map_err(one)?;
    for (heavy, what) in [(false, "the first one in strict mode (fuel)"), (true, "the second one in strict mode")] {
        let (native, plugin, same) = calls(&strict, heavy).map_err(one)?;
        let _ =
            writeln!(text, "{what:<40} {native:>6.2} us  {plugin:>6.2} us   {:>5.2}   costs {same}", plugin / native);
    }
    let (native, plugin, words) = flights(&twin).map_err(one)?;
    let what = "a whole planned trajectory with one term";
    let _ = writeln!(text, "{what:<40} {native:>6.1} ms  {plugin:>6.1} ms   {:>5.2}   {words}", plugin / native);
    let start = start_ms().map_err(one)?;
    let _ = writeln!(text, "start from the compile cache              {start:.2} ms");
    print(&text)
}

/// Microseconds per call, native and plugin, and whether the costs have the same bits.
fn calls(twin: &Plugin, heavy: bool) -> Result<(f64, f64, &'static str), PluginError> {
    let plugin = PluginTerm::open(twin, Arc::new(NoTown), "twin", &format!("{{\"heavy\":{heavy}}}"), 1)?;
    let native = Native { heavy };
    laws::with_context(laws::FRAMES, |context| {
        let mut stream = Seed::of_item(1, "plugin", "bench").stream("flight");
        let flight = laws::random_flight(&mut stream, context.track);
        let (mut a, mut b) = (vec![0.0; flight.len()], vec![0.0; flight.len()]);
        let (mut native_us, mut plugin_us) = (vec![], vec![]);
        plugin.begin(context);
        for _ in 0..ROUNDS {
            for (term, costs, times) in
                [(&native as &dyn CostTerm, &mut a, &mut native_us), (&plugin as &dyn CostTerm, &mut b, &mut plugin_us)]
            {
                let begin = thread_cpu_s();
                (0..CALLS).for_each(|_| term.cost(std::hint::black_box(&flight), context, costs));
                times.push(1e6 * (thread_cpu_s() - begin) / CALLS as f64);
            }
        }
        let same = a.iter().zip(&b).all(|(a, b)| a.to_bits() == b.to_bits());
        let words = if same { "equal to the last bit" } else { "NOT EQUAL" };
        plugin.began().failure().map_or(Ok((median(native_us), median(plugin_us), words)), Err)
    })
}

/// Milliseconds per flight, native and plugin, and how the flights compare.
fn flights(twin: &Plugin) -> Result<(f64, f64, String), PluginError> {
    let scene = SeededScene::generate(SceneKind::Leafy, 1);
    let (track, exact) = (scene.walker(1, 0), BoxBvh::build(scene.boxes.clone()));
    let config = MucoConfig::default();
    let plan = |term: Box<dyn CostTerm>| {
        let extra = vec![WeightedTerm { term, weight: 0.02 }];
        let begin = thread_cpu_s();
        let outcome = plan_with_terms(
            &track,
            &exact,
            &scene.boxes,
            &|_, _| 0.0,
            &config,
            extra,
            Seed::of_item(1, "plugin", "bench"),
        );
        (outcome, 1e3 * (thread_cpu_s() - begin))
    };
    let (mut native_ms, mut plugin_ms, mut words) = (vec![], vec![], String::new());
    for _ in 0..FLIGHT_ROUNDS {
        let (native, took) = plan(Box::new(Native { heavy: false }));
        native_ms.push(took);
        let term = PluginTerm::open(twin, Arc::new(NoTown), "twin", "{}", 1)?;
        let began = term.began();
        let (plugin, took) = plan(Box::new(term));
        plugin_ms.push(took);
        if let Some(failure) = began.failure() {
            return Err(failure);
        }
        words = match (native, plugin) {
            (PlanOutcome::Planned(a), PlanOutcome::Planned(b)) if a == b => "equal to the last bit".to_owned(),
            (PlanOutcome::Planned(_), PlanOutcome::Planned(_)) => "NOT EQUAL".to_owned(),
            _ => "no flight".to_owned(),
        };
    }
    Ok((median(native_ms), median(plugin_ms), words))
}

/// Milliseconds from a kept compilation to a configured term, with the engine already there.
fn start_ms() -> Result<f64, PluginError> {
    let refused = |error: std::io::Error| PluginError::refused("twin.wasm", format!("no temporary folder: {error}"));
    let folder = tempfile::tempdir().map_err(refused)?;
    let open = || -> Result<f64, PluginError> {
        let begin = Instant::now();
        let host = Host::new(Some(folder.path().join("kept")));
        let plugin = host.load_bytes(TWIN, "twin.wasm", Some(Kind::CostTerm), PluginLimits::default())?;
        PluginTerm::open(&plugin, Arc::new(NoTown), "twin", "{}", 1)?;
        Ok(1e3 * begin.elapsed().as_secs_f64())
    };
    open()?;
    Ok(median((0..9).map(|_| open()).collect::<Result<_, _>>()?))
}
