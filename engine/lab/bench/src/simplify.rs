//! Boxes for planning: how few, what they gain and lose, and how long that takes, by tolerance.

use crate::clock::timed;
use cosfly_domain::{Obstacle, ObstacleKind, OrientedBox};
use cosfly_geometry::BoxBvh;
use cosfly_scenes::{Scene, SceneKind};
use cosfly_town::simplify::{SimplifyConfig, simplify};
use serde::Serialize;
use std::fmt;

/// Tolerances in metres with shares of empty space: no joining over gaps, the defaults, and looser ones.
const LIMITS: [[f64; 2]; 6] = [[0.0, 0.0], [0.25, 0.1], [0.5, 0.1], [1.0, 0.3], [2.0, 0.3], [2.0, 0.6]];
/// Runs of one row, of which the fastest counts.
const RUNS: usize = 3;

/// One row for each pair of limits.
#[derive(Debug, Serialize)]
pub struct SimplifyTable {
    /// Boxes before.
    pub boxes: usize,
    /// CPU time of a tree over the boxes before, seconds: the scale of the others.
    pub tree_s: f64,
    /// Rows.
    pub rows: Vec<SimplifyRow>,
}

/// Boxes of one pair of limits.
#[derive(Debug, Serialize)]
pub struct SimplifyRow {
    /// Tolerance, metres.
    pub tolerance_m: f64,
    /// Most empty space of a joined box.
    pub max_empty_share: f64,
    /// Boxes after.
    pub boxes: usize,
    /// Space gained, as a share of the volume before.
    pub gained_share: f64,
    /// Space lost, as a share of the volume before.
    pub lost_share: f64,
    /// CPU time of one thread, seconds.
    pub cpu_s: f64,
}

/// Some 65,000 boxes of a generated town.
pub fn fine_boxes(seed: u64) -> Vec<OrientedBox> {
    Scene::generate(SceneKind::Fine, seed).boxes
}

/// Simplifies boxes with all limits in turns.
pub fn simplify_table(boxes: &[OrientedBox]) -> SimplifyTable {
    let obstacle =
        |shape: &OrientedBox| Obstacle { shape: *shape, kind: ObstacleKind::Building, object_id: 1, synthetic: false };
    let obstacles: Vec<Obstacle> = boxes.iter().map(obstacle).collect();
    let mut table = SimplifyTable { boxes: boxes.len(), tree_s: f64::INFINITY, rows: Vec::new() };
    for run in 0..RUNS {
        table.tree_s = table.tree_s.min(timed(|| BoxBvh::build(boxes.to_vec())).1);
        for (index, [tolerance_m, max_empty_share]) in LIMITS.into_iter().enumerate() {
            let config = SimplifyConfig { tolerance_m, max_empty_share, ..SimplifyConfig::default() };
            let ((kept, report), cpu_s) = timed(|| simplify(&obstacles, &[], &config));
            if run == 0 {
                table.rows.push(SimplifyRow {
                    tolerance_m,
                    max_empty_share,
                    boxes: kept.len(),
                    gained_share: report.added_volume_share,
                    lost_share: report.lost_volume_share,
                    cpu_s,
                });
            }
            table.rows[index].cpu_s = table.rows[index].cpu_s.min(cpu_s);
        }
    }
    table
}

impl fmt::Display for SimplifyTable {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(out, "{} boxes; a tree over them takes {:.3} s of one thread\n", self.boxes, self.tree_s)?;
        writeln!(out, "| tolerance m | empty share | boxes | gained % | lost % | CPU s | in trees |")?;
        writeln!(out, "| --- | --- | --- | --- | --- | --- | --- |")?;
        for row in &self.rows {
            writeln!(
                out,
                "| {} | {} | {} | {:.2} | {:.3} | {:.3} | {:.1} |",
                row.tolerance_m,
                row.max_empty_share,
                row.boxes,
                100.0 * row.gained_share,
                100.0 * row.lost_share,
                row.cpu_s,
                row.cpu_s / self.tree_s
            )?;
        }
        Ok(())
    }
}
