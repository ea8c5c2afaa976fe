//! The picture: final errors with their intervals, and errors waypoint by waypoint, method beside method.

use super::result::{Evaluation, MethodReport};
use cosfly_plot::axis::{Axis, label};
use cosfly_plot::bars::{BAR_PX, Bar, Bars};
use cosfly_plot::document::{ChartDocument, TextAnchor};
use cosfly_plot::lines::{Line, Lines};

const COLOURS: [&str; 9] =
    ["#c0392b", "#7f8c8d", "#2471a3", "#5dade2", "#b7950b", "#1e8449", "#82c596", "#6c3483", "#34495e"];
/// Size and top edge of the panels, and left edges and widths of bars and lines, pixels.
const WIDTH_PX: f64 = 980.0;
const TOP_PX: f64 = 64.0;
const BARS: (f64, f64) = (170.0, 300.0);
const LINES: (f64, f64) = (620.0, 320.0);

impl Evaluation {
    /// The picture, SVG.
    pub fn to_svg(&self) -> String {
        let height = (BAR_PX * self.methods.len() as f64).max(200.0);
        let title = format!("Errors of predictions and baselines on {}", self.dataset.name);
        let mut document = ChartDocument::new(&title, WIDTH_PX, TOP_PX + height + 56.0);
        bars(&mut document, &self.methods, height);
        lines(&mut document, &self.methods, height);
        document.finish()
    }
}

fn colour(place: usize) -> &'static str {
    COLOURS[place % COLOURS.len()]
}

fn bars(document: &mut ChartDocument, methods: &[MethodReport], height: f64) {
    let bars: Vec<Bar<'_>> = methods
        .iter()
        .enumerate()
        .filter_map(|(place, method)| {
            let score = method.scores.get("fde_m")?;
            let interval = score.low.zip(score.high);
            Some(Bar { name: &method.name, value: score.value, interval, colour: colour(place) })
        })
        .collect();
    let ends: Vec<f64> = bars.iter().map(Bar::end).collect();
    let axis = Axis::of(&ends);
    document.heading((16.0, 26.0), "Final displacement error with 95 % interval, metres");
    note(document, 16.0, axis, "bars with an arrow are longer");
    Bars { left: BARS.0, top: TOP_PX, width: BARS.1, height, decimals: 2 }.draw(document, axis, &bars);
}

fn lines(document: &mut ChartDocument, methods: &[MethodReport], height: f64) {
    let lines: Vec<Line<'_>> = methods
        .iter()
        .enumerate()
        .map(|(place, method)| Line { values: &method.by_step_m, colour: colour(place) })
        .collect();
    let most: Vec<f64> = lines.iter().map(|line| line.values.iter().copied().fold(0.0, f64::max)).collect();
    let axis = Axis::of(&most);
    let left = LINES.0 - 40.0;
    document.heading((left, 26.0), "Displacement error by waypoint, metres");
    note(document, left, axis, "lines that leave it go on");
    let caption = "waypoint; colours as on the left";
    Lines { left: LINES.0, top: TOP_PX, width: LINES.1, height, caption }.draw(document, axis, &lines);
}

/// A note below a heading where the axis is cut.
fn note(document: &mut ChartDocument, left: f64, axis: Axis, beyond: &str) {
    if axis.is_cut {
        let note = format!("axis cut at {} m; {beyond}", label(axis.end));
        document.words((left, 44.0), &note, TextAnchor::Start, "#555");
    }
}
