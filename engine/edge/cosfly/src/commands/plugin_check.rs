//! `cosfly plugin check`: what a plugin says of itself, and whether it keeps the laws of its kind.

use crate::command::{Command, Outcome, Refusals};
use crate::console::Console;
use crate::exit;
use clap::Parser;
use cosfly_diagnose::{Diagnostic, Fault, counted};
use cosfly_experts::plugins::config::Makes;
use cosfly_experts::plugins::{host, tables};
use cosfly_plugin_host::laws::{self, LawFinding};
use cosfly_plugin_host::{
    Declaration, Effect, Effort, Kind, NoTown, Plugin, PluginError, PluginTerm, check_given, check_schema,
    with_defaults,
};
use cosfly_schema::flight_table::{self, FlightColumns};
use serde_json::{Map, Value};
use std::fmt::Write;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

/// Describe a plugin and its parameters, and try the laws of its kind: pure, finite, local, gradient
#[derive(Debug, Parser)]
#[command(
    name = "check",
    after_help = "\
Examples:
  cosfly plugin check recipes/plugins/orbit.wasm
  cosfly plugin check recipes/plugins/wind.wasm --params '{\"speed_mps\": 9}'

Exits with 1 when a law is broken."
)]
pub struct Arguments {
    /// The plugin
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Its parameters as a JSON object [default: its defaults]
    #[arg(long, value_name = "JSON")]
    params: Option<String>,
    /// Run it in strict mode with this many instructions per call
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    fuel: u64,
}

impl Command for Arguments {
    fn run(&self, console: &dyn Console) -> Outcome {
        check(self, console)
    }
}

/// Prints the description, one line per law, and a verdict.
fn check(arguments: &Arguments, console: &dyn Console) -> Outcome {
    let started = Instant::now();
    let plugin = load(arguments)?;
    let took_ms = 1e3 * started.elapsed().as_secs_f64();
    let (params, schema) = params(arguments, &plugin)?;
    let mut text = describe(&plugin, &schema);
    let _ = writeln!(text, "loaded in {took_ms:.1} ms");
    let one = |error: PluginError| error.diagnostic(None);
    let findings = match plugin.kind {
        Kind::CostTerm => laws::check_cost_term(&plugin, &params).map_err(one)?,
        Kind::Objective => laws::check_objective(&plugin, &params).map_err(one)?,
        Kind::Stage => laws::check_stage(&plugin, &params, &encode_sample(&plugin), &read_answer).map_err(one)?,
    };
    for LawFinding { law, words, holds } in &findings {
        let _ = writeln!(text, "{} {law}: {words}", if *holds { "holds " } else { "BROKEN" });
    }
    if plugin.kind == Kind::CostTerm {
        let us = call_us(&plugin, &params).map_err(one)?;
        let strict = load_within(arguments, MOST_FUEL)?;
        let effort = effort(&strict, &params).map_err(one)?;
        let _ = writeln!(
            text,
            "speed: {us:.2} us per call of {} waypoints; {} instructions per waypoint; {} KiB of memory",
            laws::FRAMES,
            effort.fuel / laws::FRAMES as u64,
            effort.memory_bytes >> 10
        );
    }
    let broken = findings.iter().filter(|finding| !finding.holds).count();
    let _ = match broken {
        0 => writeln!(text, "it keeps the laws of its kind"),
        count => writeln!(text, "broken: {}", counted(count as u64, "law")),
    };
    console.print(&text)?;
    Ok(if broken == 0 { exit::SUCCESS } else { exit::FOUND_PROBLEMS })
}

/// Instructions of a call that is only counted.
const MOST_FUEL: u64 = 1_000_000_000_000;

/// The plugin of a command line.
fn load(arguments: &Arguments) -> Result<Plugin, Refusals> {
    load_within(arguments, arguments.fuel)
}

/// The plugin of a command line with `fuel` instructions per call; 0: without strict mode.
fn load_within(arguments: &Arguments, fuel: u64) -> Result<Plugin, Refusals> {
    let shown = arguments.file.display().to_string();
    let limits = cosfly_plugin_host::PluginLimits { fuel, ..Default::default() };
    host().load(&arguments.file, &shown, None, limits).map_err(|error| error.diagnostic(None).into())
}

/// Its parameters as JSON text with defaults, and their schema.
fn params(arguments: &Arguments, plugin: &Plugin) -> Result<(String, Value), Refusals> {
    let refused = |message: String| Diagnostic::new("plugin-params", Fault::Recipe, message);
    let schema = check_schema(&plugin.metadata.params_schema).map_err(refused)?;
    let given: Map<String, Value> = match &arguments.params {
        None => Map::new(),
        Some(text) => serde_json::from_str(text).map_err(|error| {
            refused(format!("`--params` is not a JSON object: {error}; write it like `{{\"radius_m\": 3}}`"))
        })?,
    };
    check_given(&schema, &given).map_err(refused)?;
    Ok((with_defaults(&schema, &given), schema))
}

fn describe(plugin: &Plugin, schema: &Value) -> String {
    let told = &plugin.metadata;
    let mut text = format!("`{}` {}, {}: {}\n", told.name, told.version, plugin.kind.words(), told.summary);
    for (name, rule) in schema["properties"].as_object().into_iter().flatten() {
        let word = |key: &str| rule.get(key).map(|value| format!(", {key} {value}")).unwrap_or_default();
        let about = rule.get("description").and_then(Value::as_str).unwrap_or_default();
        let kind = rule.get("type").and_then(Value::as_str).unwrap_or("any");
        let _ = writeln!(text, "  {name} ({kind}{}{}{}): {about}", word("default"), word("minimum"), word("maximum"));
    }
    text
}

/// The sample flight with the columns that the plugin declares.
fn encode_sample(plugin: &Plugin) -> impl Fn(&Declaration) -> Result<Vec<u8>, PluginError> {
    let shown = plugin.shown.clone();
    move |declared| {
        let makes = match declared.effect {
            Effect::Filter | Effect::Label => Makes::Flights,
            Effect::Annotate | Effect::Rows | Effect::Files => Makes::Extras,
        };
        let failed = |(message, hint): (String, Option<String>)| {
            hint.into_iter().fold(PluginError::failed(&shown, "configure", message), PluginError::hint)
        };
        tables::check(declared, makes).map_err(failed)?;
        let stream = FlightColumns::sample().encode(&tables::columns(&declared.reads));
        stream.map_err(|refusal| failed((refusal.message, refusal.hint)))
    }
}

fn read_answer(declared: &Declaration, answer: &[u8]) -> Result<String, String> {
    let gives = tables::columns(&declared.gives);
    let name = &declared.name;
    let count = |most| {
        let values = flight_table::read_answer(answer, &gives, 0..=most)?;
        Ok::<usize, String>(values.first().map_or(0, flight_table::Values::len))
    };
    match declared.effect {
        Effect::Filter => flight_table::verdict(answer, &gives).map(|verdict| {
            format!("a filter; it {} the sample flight", if verdict.keep { "keeps" } else { "rejects" })
        }),
        Effect::Label => flight_table::labels(answer, &gives, flight_table::SAMPLE_FRAMES).map(|labels| {
            let names: Vec<String> = labels.into_iter().map(|(name, _)| format!("`{name}`")).collect();
            format!("labels frames with {}", names.join(", "))
        }),
        Effect::Annotate => flight_table::read_answer(answer, &gives, 1..=1)
            .map(|_| format!("annotates flights in the table `{name}`, `makes = \"extras\"`")),
        Effect::Rows => count(flight_table::MOST_ROWS).map(|rows| {
            format!(
                "{rows} of the sample flight for the table `{name}`, `makes = \"extras\"`",
                rows = counted(rows, "row")
            )
        }),
        Effect::Files => count(flight_table::MOST_FILES).map(|files| {
            format!(
                "{files} of the sample flight for the folder `extras/{name}`, `makes = \"extras\"`",
                files = counted(files, "file")
            )
        }),
    }
}

/// Time of an evaluation, microseconds: the best of some rounds.
fn call_us(plugin: &Plugin, params: &str) -> Result<f64, PluginError> {
    use cosfly_planner::CostTerm;
    let term = PluginTerm::open(plugin, Arc::new(NoTown), "timed", params, 1)?;
    laws::with_context(laws::FRAMES, |context| {
        let mut stream = cosfly_frames::Seed::of_item(1, "plugin", "time").stream("flight");
        let flight = laws::random_flight(&mut stream, context.track);
        let mut costs = vec![0.0; flight.len()];
        let mut best = f64::INFINITY;
        for _ in 0..10 {
            let started = Instant::now();
            (0..50).for_each(|_| term.cost(&flight, context, &mut costs));
            best = best.min(started.elapsed().as_secs_f64() / 50.0);
        }
        term.began().failure().map_or(Ok(1e6 * best), Err)
    })
}

/// Instructions and memory of one evaluation in strict mode.
fn effort(strict: &Plugin, params: &str) -> Result<Effort, PluginError> {
    use cosfly_planner::CostTerm;
    let term = PluginTerm::open(strict, Arc::new(NoTown), "counted", params, 1)?;
    laws::with_context(laws::FRAMES, |context| {
        let mut stream = cosfly_frames::Seed::of_item(1, "plugin", "time").stream("flight");
        let flight = laws::random_flight(&mut stream, context.track);
        let mut costs = vec![0.0; flight.len()];
        term.cost(&flight, context, &mut costs);
        term.began().failure().map_or(Ok(term.began().effort()), Err)
    })
}
