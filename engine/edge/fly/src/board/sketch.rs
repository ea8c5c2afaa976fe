//! [`sketch`]: an episode from above, as a drawing of a few kilobytes that moves without a script.

use crate::log::LogLine;
use crate::suite::EpisodeTask;
use cosfly_domain::OrientedBox;
use std::fmt::Write as _;

/// Side of the drawing, pixels.
const SIDE: f64 = 280.0;
/// Margin around the paths, metres.
const MARGIN_M: f64 = 12.0;
/// Most points of a path.
const MOST_POINTS: usize = 60;
/// Most obstacles.
const MOST_BOXES: usize = 80;
/// Speed of the drawing, times that of the flight.
const FASTER: f64 = 4.0;

/// The drawing of an episode: obstacles, the walk of the target, the flight (where the target is not tracked, dashed); nothing without steps.
pub(super) fn sketch(task: &EpisodeTask, steps: &[LogLine]) -> String {
    let Some(last) = steps.last() else { return String::new() };
    let kept = |at: &usize| at.is_multiple_of(steps.len().div_ceil(MOST_POINTS)) || *at + 1 == steps.len();
    let kept: Vec<&LogLine> = (0..steps.len()).filter(kept).map(|at| &steps[at]).collect();
    let view = View::around(&kept);
    let drone: Vec<[f64; 2]> = kept.iter().map(|line| view.place(line.position_in_world)).collect();
    let target: Vec<[f64; 2]> = kept.iter().map(|line| view.place(line.target_in_world)).collect();
    let mut svg = format!(
        "<svg viewBox=\"0 0 {SIDE} {SIDE}\" width=\"{SIDE}\" height=\"{SIDE}\" role=\"img\" \
         aria-label=\"the flight from above\"><rect width=\"{SIDE}\" height=\"{SIDE}\" fill=\"#f4f2ec\"/><g fill=\"#c9c5b8\">"
    );
    obstacles(task, &view).iter().for_each(|shape| _ = write!(svg, "<path d=\"{}Z\"/>", path(shape)));
    svg.push_str("</g><g fill=\"none\" stroke-width=\"1.5\">");
    let _ = write!(svg, "<path d=\"{}\" stroke=\"#2a78d6\"/>", path(&target));
    for run in drone.windows(2).zip(&kept).collect::<Vec<_>>().chunk_by(|a, b| a.1.tracked == b.1.tracked) {
        let points: Vec<[f64; 2]> = run.iter().map(|it| it.0[0]).chain(run.last().map(|it| it.0[1])).collect();
        let dashes = if run[0].1.tracked { "" } else { " stroke-dasharray=\"3 3\"" };
        let _ = write!(svg, "<path d=\"{}\" stroke=\"#d4432f\"{dashes}/>", path(&points));
    }
    svg.push_str("</g>");
    let length_s = (last.time_s / FASTER).max(0.1);
    for (points, colour) in [(&target, "#2a78d6"), (&drone, "#d4432f")] {
        let _ = write!(
            svg,
            "<circle r=\"4\" fill=\"{colour}\"><animateMotion dur=\"{length_s:.1}s\" repeatCount=\"indefinite\" \
             calcMode=\"linear\" path=\"{}\"/></circle>",
            path(points)
        );
    }
    svg + "</svg>"
}

/// The part of the world that is drawn: its smallest corner, and pixels a metre.
struct View {
    corner_in_world: [f64; 2],
    scale: f64,
}

impl View {
    fn around(lines: &[&LogLine]) -> Self {
        let places = || lines.iter().flat_map(|line| [line.position_in_world, line.target_in_world]);
        let ends = |axis: usize| {
            let values = places().map(|place| place[axis]);
            values.fold((f64::MAX, f64::MIN), |(low, high), value| (low.min(value), high.max(value)))
        };
        let [x, y] = [0, 1].map(ends);
        let size_m = (x.1 - x.0).max(y.1 - y.0) + 2.0 * MARGIN_M;
        Self { corner_in_world: [x, y].map(|(low, high)| 0.5 * (low + high - size_m)), scale: SIDE / size_m }
    }

    /// Pixels of a point: x to the right, y down, as the world's axes lie from above.
    fn place(&self, point: [f64; 3]) -> [f64; 2] {
        [0, 1].map(|axis| (point[axis] - self.corner_in_world[axis]) * self.scale)
    }
}

/// Footprints of the largest obstacles in view.
fn obstacles(task: &EpisodeTask, view: &View) -> Vec<[[f64; 2]; 4]> {
    let is_in_view = |shape: &&OrientedBox| {
        let (low, high) = shape.bounds_in_world();
        let (low, high) = (view.place(low.to_array()), view.place(high.to_array()));
        low.iter().all(|low| *low < SIDE) && high.iter().all(|high| *high > 0.0)
    };
    let town = &task.scenery.town;
    let mut shapes: Vec<&OrientedBox> = town.obstacles.iter().map(|it| &it.shape).filter(is_in_view).collect();
    let area = |shape: &OrientedBox| shape.half_extents_m.x * shape.half_extents_m.y;
    shapes.sort_by(|a, b| area(b).total_cmp(&area(a)));
    shapes.truncate(MOST_BOXES);
    let corners = |shape: &&OrientedBox| {
        let corners = shape.corners_in_world();
        [0, 1, 3, 2].map(|at| view.place(corners[at].to_array()))
    };
    shapes.iter().map(corners).collect()
}

/// Points as the data of a path, whole pixels and tenths.
fn path(points: &[[f64; 2]]) -> String {
    let mut text = String::new();
    for (at, [x, y]) in points.iter().enumerate() {
        let _ = write!(text, "{}{x:.1} {y:.1}", if at == 0 { 'M' } else { 'L' });
    }
    text
}
