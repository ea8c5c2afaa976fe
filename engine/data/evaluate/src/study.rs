//! Small networks that test two findings of the paper on a dataset: that the history of poses matters most, and that
//! learning from perturbed inputs (denoising) beats learning from experts alone on yaw.

use crate::methods::{Method, training_windows};
use crate::report::Score;
use crate::scoring::{MethodTallies, score, total};
use crate::settings::{InputRole, Settings};
use crate::strata::Membership;
use crate::windows::{Flights, Window, WindowSet};
use cosfly_metrics::baselines::Network;
use cosfly_metrics::baselines::network::{Inputs, Lessons, Training};
use cosfly_metrics::{METRICS, Tally, bootstrap};
use rayon::prelude::*;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Networks per configuration, from different seeds.
const SEEDS: u64 = 3;
/// Metrics of the study.
const KEYS: [&str; 4] = ["ade_m", "fde_m", "sr_1m", "yaw_mae_deg"];

/// What networks are trained on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Paradigm {
    /// Perturbed input, the expert's truth.
    Denoising,
    /// The expert's input, its own truth.
    ExpertOnly,
    /// Both.
    Mixed,
}

/// What the networks found.
#[derive(Clone, Debug, Serialize)]
pub struct Study {
    /// What was trained how, with its scores on the scored windows.
    pub networks: Vec<NetworkReport>,
    /// Pose history matters most.
    pub pose_history: Finding,
    /// Denoising beats expert-only on yaw.
    pub denoising: Finding,
}

/// One configuration.
#[derive(Clone, Debug, Serialize)]
pub struct NetworkReport {
    /// In words.
    pub name: String,
    /// Windows learnt from.
    pub lessons: usize,
    /// Mean over seeds of each metric.
    pub scores: BTreeMap<&'static str, f64>,
    /// Standard deviation over seeds.
    pub deviations: BTreeMap<&'static str, f64>,
}

/// A finding of the paper, tested.
#[derive(Clone, Debug, Serialize)]
pub struct Finding {
    /// What the paper says.
    pub claim: &'static str,
    /// Whether its direction holds here: the whole interval is on the side that the paper says. How strongly is
    /// another matter, see `result`.
    pub holds: bool,
    /// The difference that was measured, with its interval.
    pub difference: Score,
    /// In words, with numbers.
    pub result: String,
}

struct Configuration {
    name: &'static str,
    inputs: Inputs,
    paradigm: Paradigm,
}

const FULL: usize = 0;
const WITHOUT_BOXES: usize = 1;
const WITHOUT_POSES: usize = 2;
const EXPERT_ONLY: usize = 4;

const CONFIGURATIONS: [Configuration; 5] = {
    use Paradigm::{Denoising, ExpertOnly, Mixed};
    let both = Inputs { poses: true, boxes: true };
    [
        Configuration { name: "poses and boxes, denoising", inputs: both, paradigm: Denoising },
        Configuration { name: "poses alone, denoising", inputs: Inputs { boxes: false, ..both }, paradigm: Denoising },
        Configuration { name: "boxes alone, denoising", inputs: Inputs { poses: false, ..both }, paradigm: Denoising },
        Configuration { name: "poses and boxes, mixed", inputs: both, paradigm: Mixed },
        Configuration { name: "poses and boxes, expert only", inputs: both, paradigm: ExpertOnly },
    ]
};

/// Trains all networks on split `train` and scores them on the windows for which `wanted` holds. Returns the study
/// and the first network of the full configuration; `None` when there is nothing to learn from or to resample.
pub fn study(
    flights: &Flights,
    windows: &WindowSet,
    memberships: &[Membership],
    settings: &Settings,
    wanted: &(dyn Fn(usize) -> bool + Sync),
) -> Option<(Study, Network)> {
    let lessons: Vec<Lessons> =
        CONFIGURATIONS.par_iter().map(|configuration| lessons(flights, settings, configuration)).collect();
    if lessons.iter().any(Lessons::is_empty) {
        return None;
    }
    let jobs: Vec<(usize, u64)> =
        (0..CONFIGURATIONS.len()).flat_map(|it| (0..SEEDS).map(move |seed| (it, seed))).collect();
    let trained: Vec<Network> = jobs
        .par_iter()
        .map(|(it, seed)| {
            let training = Training { seed: settings.seed.wrapping_mul(1000).wrapping_add(*seed), ..settings.training };
            Network::train(&lessons[*it], &training)
        })
        .collect::<Option<_>>()?;
    let first = trained.first()?.clone();
    let scored: Vec<MethodTallies> = trained
        .into_iter()
        .map(|network| score(&Method::Network(Box::new(network)), flights, windows, memberships, settings, wanted))
        .collect();
    let of = |it: usize| &scored[it * SEEDS as usize..][..SEEDS as usize];
    if of(FULL)[0].overall.len() < 2 {
        return None;
    }
    let networks: Vec<NetworkReport> = CONFIGURATIONS
        .iter()
        .enumerate()
        .map(|(it, configuration)| network_report(configuration.name, lessons[it].len(), of(it)))
        .collect();
    let pose_history = pose_history(&networks, of(WITHOUT_POSES), of(WITHOUT_BOXES), settings);
    let denoising = denoising(&networks, of(EXPERT_ONLY), of(FULL), settings);
    Some((Study { networks, pose_history, denoising }, first))
}

fn lessons(flights: &Flights, settings: &Settings, configuration: &Configuration) -> Lessons {
    let roles: &[InputRole] = match configuration.paradigm {
        Paradigm::Denoising => &[InputRole::Perturbed],
        Paradigm::ExpertOnly => &[InputRole::Expert],
        Paradigm::Mixed => &[InputRole::Perturbed, InputRole::Expert],
    };
    let mut lessons = Lessons::new(configuration.inputs);
    let shape = &settings.window;
    for window in roles.iter().flat_map(|role| training_windows(flights, settings, *role)) {
        let window: Window = window;
        let start = flights.anchor(window, shape, settings.anchor);
        lessons.push(&flights.view(window, shape), &start, &flights.truth(window, shape));
    }
    lessons
}

fn place(key: &str) -> usize {
    METRICS.iter().position(|metric| metric.key == key).unwrap_or(0)
}

fn network_report(name: &str, lessons: usize, seeds: &[MethodTallies]) -> NetworkReport {
    let (mut scores, mut deviations) = (BTreeMap::new(), BTreeMap::new());
    for key in KEYS {
        let values: Vec<f64> = seeds.iter().filter_map(|it| total(&it.overall).means()[place(key)]).collect();
        let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
        let square = values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>();
        scores.insert(key, mean);
        deviations.insert(key, (square / (values.len().max(2) - 1) as f64).sqrt());
    }
    NetworkReport { name: name.to_owned(), lessons, scores, deviations }
}

/// How much more `of` scores than `than`, mean over seeds, with the interval over trajectories: the same windows on
/// both sides, so the difference is resampled.
fn difference(key: &str, of: &[MethodTallies], than: &[MethodTallies], settings: &Settings) -> Score {
    let mut clusters = vec![Tally::default(); of[0].overall.len()];
    for (seeds, sign) in [(of, 1.0), (than, -1.0)] {
        for tallies in seeds {
            for (cluster, tally) in clusters.iter_mut().zip(&tallies.overall) {
                cluster.windows += if sign > 0.0 { tally.windows } else { 0.0 };
                cluster.sums.iter_mut().zip(&tally.sums).for_each(|(sum, value)| *sum += sign * value);
            }
        }
    }
    let value = total(&clusters).means()[place(key)].unwrap_or(0.0);
    let interval = bootstrap::intervals(&clusters, settings.resamples, settings.seed)[place(key)];
    Score { value, low: interval.map(|it| it.0), high: interval.map(|it| it.1) }
}

fn pose_history(
    networks: &[NetworkReport],
    without_poses: &[MethodTallies],
    without_boxes: &[MethodTallies],
    settings: &Settings,
) -> Finding {
    let fde = |it: usize| networks[it].scores["fde_m"];
    let difference = difference("fde_m", without_poses, without_boxes, settings);
    let holds = difference.low.is_some_and(|low| low > 0.0) && fde(WITHOUT_POSES) > fde(FULL);
    let result = format!(
        "FDE {:.2} m with all inputs, {:.2} m without poses ({:.2} times; the paper: 3.1), {:.2} m without boxes ({:.2} times)",
        fde(FULL),
        fde(WITHOUT_POSES),
        fde(WITHOUT_POSES) / fde(FULL).max(1e-9),
        fde(WITHOUT_BOXES),
        fde(WITHOUT_BOXES) / fde(FULL).max(1e-9)
    );
    Finding { claim: "pose history is the decisive input", holds, difference, result }
}

fn denoising(
    networks: &[NetworkReport],
    expert_only: &[MethodTallies],
    denoised: &[MethodTallies],
    settings: &Settings,
) -> Finding {
    let yaw = |it: usize| networks[it].scores["yaw_mae_deg"];
    let difference = difference("yaw_mae_deg", expert_only, denoised, settings);
    let holds = difference.low.is_some_and(|low| low > 0.0);
    let result = format!(
        "yaw MAE {:.2} degrees after learning from experts alone, {:.2} after denoising ({:.2} times; the paper: 1.7)",
        yaw(EXPERT_ONLY),
        yaw(FULL),
        yaw(EXPERT_ONLY) / yaw(FULL).max(1e-9)
    );
    Finding { claim: "expert-only training degrades yaw; denoising does not", holds, difference, result }
}

impl Study {
    /// Its section of the report.
    pub fn to_markdown(&self) -> String {
        let mut text = "\n## Two findings of the paper, tested with small networks\n\n".to_owned();
        let head = ["network", "windows learnt", "ADE m", "FDE m", "SR@1m %", "Yaw MAE deg"].map(str::to_owned);
        let rows = self.networks.iter().map(|network| {
            let cell = |key: &str| {
                let (value, deviation) = (network.scores[key], network.deviations[key]);
                let factor = if key == "sr_1m" { 100.0 } else { 1.0 };
                format!("{:.2} ± {:.2}", factor * value, factor * deviation)
            };
            let first = [network.name.clone(), network.lessons.to_string()];
            first.into_iter().chain(KEYS.iter().map(|key| cell(key))).collect::<Vec<_>>()
        });
        text.push_str(&crate::report::table(&head, &rows.collect::<Vec<_>>()));
        let _ = writeln!(text, "\n± is the deviation over {SEEDS} seeds. Judged on the scored windows.\n");
        for (finding, unit) in [
            (&self.pose_history, "m of FDE between losing poses and losing boxes"),
            (&self.denoising, "degrees between the two"),
        ] {
            let verdict = if finding.holds { "the direction holds" } else { "does NOT hold" };
            let interval = match (finding.difference.low, finding.difference.high) {
                (Some(low), Some(high)) => format!(" [{low:.2}, {high:.2}]"),
                _ => String::new(),
            };
            let _ = writeln!(
                text,
                "- {verdict}: \"{}\". Here: {}; {:.2}{interval} {unit}.",
                finding.claim, finding.result, finding.difference.value
            );
        }
        text
    }
}
