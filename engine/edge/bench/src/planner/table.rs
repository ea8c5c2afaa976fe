//! The table: one row per scene and contender, means over paths and extremes over all of them.

use super::PathOutcome;
use super::contender::Contender;
use super::figures::{Figures, Flight};
use cosfly_planner::baselines::Baseline;
use serde::Serialize;
use std::fmt;

/// All rows; prints as a table.
#[derive(Clone, Debug, Serialize)]
pub struct PlannerTable {
    /// By scene, then contender.
    pub rows: Vec<Row>,
}

/// One contender in one scene: means over the planned paths, extremes over all of their frames.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Scene or recipe.
    pub scene: String,
    /// Unsimplified boxes.
    pub boxes: usize,
    /// Planner.
    pub planner: String,
    /// Paths with a flight.
    pub planned: usize,
    /// Paths without one.
    pub infeasible: usize,
    /// Mean visibility.
    pub visibility: f64,
    /// Mean share of frames that see at least half of the target.
    pub frames_half_visible: f64,
    /// Mean distance, metres.
    pub distance_m: f64,
    /// Mean length, metres.
    pub length_m: f64,
    /// Length of all flights divided by that of their targets.
    pub length_ratio: f64,
    /// Smallest clearance, metres.
    pub min_clearance_m: f64,
    /// Segments that collide.
    pub collisions: u32,
    /// Segments below the clearance limit.
    pub margin_violations: u32,
    /// Largest speed, m/s.
    pub max_speed_mps: f64,
    /// Largest acceleration, m/s^2.
    pub max_acceleration_mps2: f64,
    /// Largest jerk, m/s^3.
    pub max_jerk_mps3: f64,
    /// Mean angle off the rear, degrees.
    pub rear_angle_deg: f64,
    /// Mean CPU time of a path, milliseconds, those without a flight included.
    pub mean_ms: f64,
    /// Median of the same.
    pub median_ms: f64,
    /// Mean number of nodes expanded.
    pub nodes: f64,
    /// Median over paths of A*'s time divided by this planner's; `None` without `astar` in the run.
    pub speed_up: Option<f64>,
    /// Reasons of the paths without a flight.
    pub reasons: Vec<String>,
}

/// The rows of one scene.
pub fn rows(scene: &str, boxes: usize, contenders: &[Contender], outcomes: &[&PathOutcome]) -> Vec<Row> {
    let reference = contenders.iter().position(|&contender| contender == Contender::Baseline(Baseline::Astar));
    contenders
        .iter()
        .enumerate()
        .map(|(index, contender)| {
            let flights: Vec<&Flight> = outcomes.iter().map(|outcome| &outcome.flights[index]).collect();
            let ratios = reference.map(|reference| {
                median(outcomes.iter().map(|o| o.flights[reference].cpu_s / o.flights[index].cpu_s.max(1e-9)).collect())
            });
            Row { scene: scene.to_owned(), boxes, speed_up: ratios, ..row(contender.name(), &flights, outcomes) }
        })
        .collect()
}

fn row(planner: &str, flights: &[&Flight], outcomes: &[&PathOutcome]) -> Row {
    let good: Vec<&Figures> = flights.iter().filter_map(|flight| flight.figures.as_ref().ok()).collect();
    let mean = |of: &dyn Fn(&Figures) -> f64| good.iter().map(|f| of(f)).sum::<f64>() / good.len().max(1) as f64;
    let most = |of: &dyn Fn(&Figures) -> f64| good.iter().map(|f| of(f)).fold(0.0, f64::max);
    let times_ms: Vec<f64> = flights.iter().map(|flight| 1e3 * flight.cpu_s).collect();
    let reason = |(flight, outcome): (&&Flight, &&PathOutcome)| {
        Some(format!("path {}: {}", outcome.path, flight.figures.as_ref().err()?))
    };
    let rear: Vec<f64> = good.iter().filter_map(|figures| figures.rear_angle_deg).collect();
    Row {
        scene: String::new(),
        boxes: 0,
        planner: planner.to_owned(),
        planned: good.len(),
        infeasible: flights.len() - good.len(),
        visibility: mean(&|f| f.visibility),
        frames_half_visible: mean(&|f| f.frames_half_visible),
        distance_m: mean(&|f| f.distance_m),
        length_m: mean(&|f| f.length_m),
        length_ratio: mean(&|f| f.length_m) / mean(&|f| f.target_length_m).max(1e-9),
        min_clearance_m: good.iter().map(|f| f.min_clearance_m).fold(50.0, f64::min),
        collisions: good.iter().map(|f| f.collisions).sum(),
        margin_violations: good.iter().map(|f| f.margin_violations).sum(),
        max_speed_mps: most(&|f| f.max_speed_mps),
        max_acceleration_mps2: most(&|f| f.max_acceleration_mps2),
        max_jerk_mps3: most(&|f| f.max_jerk_mps3),
        rear_angle_deg: rear.iter().sum::<f64>() / rear.len().max(1) as f64,
        mean_ms: times_ms.iter().sum::<f64>() / times_ms.len().max(1) as f64,
        median_ms: median(times_ms),
        nodes: mean(&|f| f.nodes as f64),
        speed_up: None,
        reasons: flights.iter().zip(outcomes).filter_map(reason).collect(),
    }
}

/// The middle value; the mean of the two middle ones of an even number; 0 of none.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    match values.len() {
        0 => 0.0,
        n if n % 2 == 1 => values[n / 2],
        n => 0.5 * (values[n / 2 - 1] + values[n / 2]),
    }
}

impl fmt::Display for PlannerTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = self.rows.iter().map(|row| row.planner.len()).max().unwrap_or(7).max(7);
        let scene = self.rows.iter().map(|row| row.scene.len()).max().unwrap_or(6).max(6);
        writeln!(
            f,
            "{:scene$} {:name$} {:>5} {:>5} {:>5} {:>5} {:>4} {:>5} {:>5} {:>4} {:>4} {:>5} {:>5} {:>5} {:>4} {:>8} {:>8} {:>6} {:>4}",
            "scene",
            "planner",
            "vis",
            ">=.5",
            "dist",
            "len",
            "x",
            "clear",
            "coll",
            "marg",
            "",
            "v",
            "a",
            "j",
            "rear",
            "ms",
            "nodes",
            "faster",
            "none"
        )?;
        let mut last = "";
        for row in &self.rows {
            if last != row.scene && !last.is_empty() {
                writeln!(f)?;
            }
            last = &row.scene;
            let faster =
                row.speed_up.map_or("-".to_owned(), |x| if x < 10.0 { format!("{x:.1}x") } else { format!("{x:.0}x") });
            writeln!(
                f,
                "{:scene$} {:name$} {:>5.3} {:>5.3} {:>5.1} {:>5.0} {:>4.2} {:>5.2} {:>5} {:>4} {:>4} {:>5.1} {:>5.1} {:>5.1} {:>4.0} {:>8.2} {:>8.0} {:>6} {:>4}",
                row.scene,
                row.planner,
                row.visibility,
                row.frames_half_visible,
                row.distance_m,
                row.length_m,
                row.length_ratio,
                row.min_clearance_m,
                row.collisions,
                row.margin_violations,
                "",
                row.max_speed_mps,
                row.max_acceleration_mps2,
                row.max_jerk_mps3,
                row.rear_angle_deg,
                row.mean_ms,
                row.nodes,
                faster,
                row.infeasible
            )?;
        }
        for row in &self.rows {
            for reason in &row.reasons {
                writeln!(f, "no flight: {} {} {reason}", row.scene, row.planner)?;
            }
        }
        Ok(())
    }
}
