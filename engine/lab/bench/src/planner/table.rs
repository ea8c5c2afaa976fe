//! The planner table: one row per scene and contender, with means and extremes over paths.

use super::contender::Contender;
use super::figures::{Figures, Flight};
use super::outcomes::{PathOutcome, PlannerOptions};
use crate::median::median;
use serde::Serialize;
use std::fmt;

/// All rows, printed as a table.
#[derive(Clone, Debug, Serialize)]
pub struct PlannerTable {
    /// Rows by scene, then contender.
    pub rows: Vec<Row>,
}

/// Figures of one contender in one scene: means over the planned paths, extremes over all of their frames.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Name of the scene or recipe.
    pub scene: String,
    /// Number of unsimplified boxes.
    pub boxes: usize,
    /// Name of the planner.
    pub planner: String,
    /// Number of paths with a flight.
    pub planned: usize,
    /// Number of paths without a flight.
    pub infeasible: usize,
    /// Mean visibility, 0..1.
    pub visibility: f64,
    /// Mean share of frames with at least half of the target visible, 0..1.
    pub frames_half_visible: f64,
    /// Mean visibility as a share of that of the lattice's best path; `None` for planners without a lattice.
    pub share_of_lattice: Option<f64>,
    /// Mean distance, metres.
    pub distance_m: f64,
    /// Mean path length, metres.
    pub length_m: f64,
    /// Length of all flights divided by that of their targets.
    pub length_ratio: f64,
    /// Smallest clearance, metres.
    pub min_clearance_m: f64,
    /// Number of colliding segments.
    pub collisions: u32,
    /// Number of segments below the clearance limit.
    pub margin_violations: u32,
    /// Largest speed, m/s.
    pub max_speed_mps: f64,
    /// Largest acceleration, m/s^2.
    pub max_acceleration_mps2: f64,
    /// Largest jerk, m/s^3.
    pub max_jerk_mps3: f64,
    /// Mean angle from straight behind the target, degrees.
    pub rear_angle_deg: f64,
    /// Mean CPU time per path, milliseconds, including paths without a flight.
    pub mean_ms: f64,
    /// Median CPU time per path, milliseconds.
    pub median_ms: f64,
    /// Mean number of expanded nodes.
    pub nodes: f64,
    /// Median over paths of A*'s time divided by this planner's; `None` without `astar` in the run.
    pub speed_up: Option<f64>,
    /// Reasons for missing flights.
    pub reasons: Vec<String>,
}

/// Summarises outcomes in a table.
pub fn tabulate(options: &PlannerOptions<'_>, outcomes: &[PathOutcome]) -> PlannerTable {
    let rows = options.grounds.iter().enumerate().flat_map(|(index, ground)| {
        let of_ground: Vec<&PathOutcome> = outcomes.iter().filter(|outcome| outcome.ground == index).collect();
        rows(&ground.name, ground.exact_boxes, &options.contenders, &of_ground)
    });
    PlannerTable { rows: rows.collect() }
}

/// Rows of one scene.
fn rows(scene: &str, boxes: usize, contenders: &[Contender], outcomes: &[&PathOutcome]) -> Vec<Row> {
    let reference = contenders.iter().position(|&contender| contender == Contender::Astar);
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
    let shares: Vec<f64> = good.iter().filter_map(|figures| figures.share_of_lattice).collect();
    Row {
        scene: String::new(),
        boxes: 0,
        planner: planner.to_owned(),
        planned: good.len(),
        infeasible: flights.len() - good.len(),
        visibility: mean(&|f| f.visibility),
        frames_half_visible: mean(&|f| f.frames_half_visible),
        share_of_lattice: (!shares.is_empty()).then(|| shares.iter().sum::<f64>() / shares.len() as f64),
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

/// Column headings and widths, after scene and planner.
const HEADINGS: [(&str, usize); 18] = [
    ("vis", 5),
    ("opt", 5),
    (">=.5", 5),
    ("dist", 5),
    ("len", 4),
    ("ratio", 5),
    ("clear", 5),
    ("hit", 4),
    ("near", 4),
    ("v", 5),
    ("a", 5),
    ("j", 5),
    ("rear", 4),
    ("none", 4),
    ("ms", 7),
    ("median", 7),
    ("nodes", 8),
    ("faster", 6),
];

impl Row {
    /// Cells under [`HEADINGS`].
    fn cells(&self) -> [String; HEADINGS.len()] {
        let faster = |times: f64| if times < 10.0 { format!("{times:.1}x") } else { format!("{times:.0}x") };
        [
            format!("{:.3}", self.visibility),
            self.share_of_lattice.map_or("-".to_owned(), |share| format!("{share:.3}")),
            format!("{:.3}", self.frames_half_visible),
            format!("{:.1}", self.distance_m),
            format!("{:.0}", self.length_m),
            format!("{:.2}", self.length_ratio),
            format!("{:.2}", self.min_clearance_m),
            self.collisions.to_string(),
            self.margin_violations.to_string(),
            format!("{:.1}", self.max_speed_mps),
            format!("{:.1}", self.max_acceleration_mps2),
            format!("{:.1}", self.max_jerk_mps3),
            format!("{:.0}", self.rear_angle_deg),
            self.infeasible.to_string(),
            format!("{:.2}", self.mean_ms),
            format!("{:.2}", self.median_ms),
            if self.nodes > 0.0 { format!("{:.0}", self.nodes) } else { "-".to_owned() },
            self.speed_up.map_or("-".to_owned(), faster),
        ]
    }
}

impl fmt::Display for PlannerTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let widest = |of: &dyn Fn(&Row) -> usize, head: &str| self.rows.iter().map(of).fold(head.len(), usize::max);
        let scene = widest(&|row| row.scene.len(), "scene");
        let planner = widest(&|row| row.planner.len(), "planner");
        write!(f, "{:scene$}  {:planner$}", "scene", "planner")?;
        for (head, width) in HEADINGS {
            write!(f, " {head:>width$}")?;
        }
        writeln!(f)?;
        for (index, row) in self.rows.iter().enumerate() {
            if index > 0 && self.rows[index - 1].scene != row.scene {
                writeln!(f)?;
            }
            write!(f, "{:scene$}  {:planner$}", row.scene, row.planner)?;
            for (cell, (_, width)) in row.cells().iter().zip(HEADINGS) {
                write!(f, " {cell:>width$}")?;
            }
            writeln!(f)?;
        }
        for row in &self.rows {
            for reason in &row.reasons {
                writeln!(f, "no flight: {} {} {reason}", row.scene, row.planner)?;
            }
        }
        Ok(())
    }
}

/// Legend of [`PlannerTable`], for the end of a printed table.
pub const LEGEND: &str = "\
vis: mean share of visible body points; opt: the same relative to the best path through the lattice;
>=.5: share of frames with half of them visible; dist: to the feet, m; len: of the flight, m; ratio: to the walk;
clear: smallest distance of the swept path to any box, m; hit, near: segments closer than 0.5 m and than the limit;
v, a, j: largest speed, acceleration, jerk (m, s); rear: degrees off the walker's back; none: paths without a flight;
ms: CPU time of the planning thread, mean and median; faster: median over paths of A*'s time divided by this planner's.
All flights are evaluated against the unsimplified map.
";

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planner::outcomes::outcomes;
    use crate::planner::scene::Ground;
    use cosfly_planner::MucoConfig;
    use cosfly_planner::baselines::Baseline;
    use cosfly_scenes::SceneKind;

    #[test]
    fn rows_are_one_per_scene_and_planner_and_judged_alike() {
        let mut ground = Ground::scene(SceneKind::Canyon, 2, 2);
        ground.tracks.iter_mut().for_each(|track| track.states.truncate(30));
        let contenders =
            vec![Contender::Cosfly, Contender::Paper, Contender::Astar, Contender::Baseline(Baseline::AstarFast)];
        let config = MucoConfig::default();
        let options = PlannerOptions { grounds: vec![ground], contenders, config, progress: &|_, _| {} };
        let table = tabulate(&options, &outcomes(&options));
        assert_eq!(table.rows.len(), 4);
        let (ours, slow, fast) = (&table.rows[0], &table.rows[2], &table.rows[3]);
        assert_eq!((ours.collisions, ours.margin_violations, slow.collisions), (0, 0, 0), "{table}");
        assert_eq!((slow.visibility, slow.nodes, slow.length_m), (fast.visibility, fast.nodes, fast.length_m));
        assert_eq!(slow.speed_up, Some(1.0));
        assert!(table.to_string().lines().next().is_some_and(|headings| headings.contains("faster")));
    }
}
