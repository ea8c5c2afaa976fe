//! Histograms, lines and strips as SVG, each with a name for screen readers and its numbers as a table.

use crate::statistics;
use crate::text::{escaped, percent, short};
use std::fmt::Write;

const WIDTH: f64 = 360.0;
const HEIGHT: f64 = 190.0;
/// Left, top, right and bottom of the area of a chart.
const AREA: [f64; 4] = [46.0, 10.0, 350.0, 156.0];

/// Numbers of experts and of perturbed flights beside each other.
pub struct Histogram<'a> {
    /// What is counted.
    pub title: &'a str,
    /// With the unit, below the axis.
    pub axis: &'a str,
    /// One number per thing that is counted.
    pub experts: Vec<f32>,
    /// The same of perturbed flights.
    pub perturbed: Vec<f32>,
    /// Least and greatest value that must be on the axis; others from the numbers.
    pub range: Option<(f64, f64)>,
    /// Bins are at least so wide.
    pub least_step: f64,
}

impl Histogram<'_> {
    /// A figure; nothing when there is nothing to count.
    pub fn draw(&self) -> String {
        let mut all: Vec<f64> =
            self.experts.iter().chain(&self.perturbed).map(|it| f64::from(*it)).filter(|it| it.is_finite()).collect();
        if all.is_empty() {
            return String::new();
        }
        all.sort_by(f64::total_cmp);
        let (low, high) =
            self.range.unwrap_or_else(|| (statistics::quantile(&all, 0.0), statistics::quantile(&all, 0.995)));
        let wanted = ((high - low) / self.least_step.max(1e-9) + 1.0).min(16.0);
        let edges = statistics::edges(low, high, wanted as usize);
        let series = [("expert", &self.experts), ("perturbed", &self.perturbed)];
        let series: Vec<(&str, Vec<f64>)> = series
            .into_iter()
            .filter(|(_, numbers)| !numbers.is_empty())
            .map(|(name, numbers)| (name, statistics::shares(numbers, &edges)))
            .collect();
        let summary = self.summary();
        let mut svg = open(&format!("Histogram: {}. {summary}", self.title));
        let top = series.iter().flat_map(|(_, shares)| shares).copied().fold(0.0, f64::max).max(1e-9);
        let axes = Axes { x: (edges[0], edges[edges.len() - 1]), y: (0.0, top) };
        axes.grid(&mut svg, &|share| format!("{:.0} %", 100.0 * share));
        for (name, shares) in &series {
            let _ = write!(svg, "<path class=\"{name}\" d=\"{}\"/>", steps(&axes, &edges, shares));
        }
        svg.push_str("</svg>");
        format!(
            "<figure class=\"card\"><h3>{}</h3>{svg}<figcaption><span class=\"axis\">{}</span>{summary}</figcaption>{}</figure>",
            escaped(self.title),
            escaped(self.axis),
            numbers(&edges, &series)
        )
    }

    fn summary(&self) -> String {
        let of = |name: &str, numbers: &[f32]| {
            let mut sorted: Vec<f64> = numbers.iter().map(|it| f64::from(*it)).filter(|it| it.is_finite()).collect();
            sorted.sort_by(f64::total_cmp);
            let [p5, p50, p95] = [0.05, 0.5, 0.95].map(|at| short(statistics::quantile(&sorted, at)));
            (!sorted.is_empty()).then(|| format!("{name}: median {p50}, 5 to 95 %: {p5} to {p95}"))
        };
        let parts = [of("experts", &self.experts), of("perturbed", &self.perturbed)];
        parts.into_iter().flatten().collect::<Vec<_>>().join("; ")
    }
}

fn steps(axes: &Axes, edges: &[f64], shares: &[f64]) -> String {
    let mut path = format!("M{:.1} {:.1}", axes.x(edges[0]), axes.y(0.0));
    for (bin, share) in shares.iter().enumerate() {
        let _ = write!(path, "V{:.1}H{:.1}", axes.y(*share), axes.x(edges[bin + 1]));
    }
    let _ = write!(path, "V{:.1}Z", axes.y(0.0));
    path
}

fn numbers(edges: &[f64], series: &[(&str, Vec<f64>)]) -> String {
    let mut table = String::from(
        "<details><summary>Numbers</summary><table><thead><tr><th scope=\"col\">from</th><th scope=\"col\">to</th>",
    );
    series.iter().for_each(|(name, _)| {
        let _ = write!(table, "<th scope=\"col\">{name}</th>");
    });
    table.push_str("</tr></thead><tbody>");
    for bin in 0..edges.len() - 1 {
        let _ = write!(table, "<tr><td>{}</td><td>{}</td>", short(edges[bin]), short(edges[bin + 1]));
        series.iter().for_each(|(_, shares)| {
            let _ = write!(table, "<td>{}</td>", percent(shares[bin]));
        });
        table.push_str("</tr>");
    }
    table.push_str("</tbody></table></details>");
    table
}

/// The start of a picture of the size of a chart, with its name.
fn open(name: &str) -> String {
    format!("<svg viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" aria-label=\"{}\">", escaped(name))
}

/// What the edges of the area stand for.
struct Axes {
    x: (f64, f64),
    y: (f64, f64),
}

impl Axes {
    fn x(&self, value: f64) -> f64 {
        AREA[0] + (AREA[2] - AREA[0]) * (value - self.x.0) / (self.x.1 - self.x.0).max(1e-12)
    }

    fn y(&self, value: f64) -> f64 {
        AREA[3] - (AREA[3] - AREA[1]) * (value - self.y.0) / (self.y.1 - self.y.0).max(1e-12)
    }

    fn grid(&self, svg: &mut String, y_label: &dyn Fn(f64) -> String) {
        for value in ticks(self.y, 4.0) {
            let y = self.y(value);
            let _ = write!(
                svg,
                "<path class=\"grid\" d=\"M{} {y:.1}H{}\"/><text x=\"{}\" y=\"{:.1}\" class=\"end\">{}</text>",
                AREA[0],
                AREA[2],
                AREA[0] - 5.0,
                y + 3.5,
                y_label(value)
            );
        }
        for value in ticks(self.x, 6.0) {
            let _ = write!(
                svg,
                "<text x=\"{:.1}\" y=\"{}\" class=\"mid\">{}</text>",
                self.x(value),
                AREA[3] + 16.0,
                short(value)
            );
        }
    }
}

fn ticks((low, high): (f64, f64), wanted: f64) -> Vec<f64> {
    let step = statistics::round_step((high - low) / wanted);
    let inside = statistics::edges(low, high, wanted as usize).into_iter();
    inside.map(|it| (it / step).round() * step).filter(|it| *it >= low - 1e-9 && *it <= high + 1e-9).collect()
}

/// Costs on their way down, each divided by its first; `stops` names the places when there are few.
pub fn convergence(curves: &[&[f64]], stops: Option<&[&str]>) -> String {
    let longest = curves.iter().map(|curve| curve.len()).max().unwrap_or(0);
    let relative: Vec<Vec<f64>> =
        curves.iter().map(|curve| curve.iter().map(|cost| (cost / curve[0]).clamp(1e-3, 1e3)).collect()).collect();
    let logs: Vec<f64> = relative.iter().flatten().map(|share| cosfly_frames::real::ln(*share)).collect();
    let (low, high) = logs.iter().fold((0.0_f64, 0.0_f64), |(low, high), it| (low.min(*it), high.max(*it)));
    let axes = Axes { x: (0.0, (longest - 1) as f64), y: (low - 0.05, high + 0.05) };
    let last: Vec<f64> = sorted(relative.iter().filter_map(|curve| curve.last().copied()));
    let summary = format!(
        "{} flight{}; the published cost is {} of the first in the median",
        curves.len(),
        if curves.len() == 1 { "" } else { "s" },
        percent(statistics::quantile(&last, 0.5))
    );
    let mut svg = open(&format!("Cost against its first value. {summary}"));
    for share in [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0] {
        let log = cosfly_frames::real::ln(share);
        if log >= axes.y.0 && log <= axes.y.1 {
            let y = axes.y(log);
            let _ = write!(
                svg,
                "<path class=\"grid\" d=\"M{} {y:.1}H{}\"/><text x=\"{}\" y=\"{:.1}\" class=\"end\">{:.0} %</text>",
                AREA[0],
                AREA[2],
                AREA[0] - 5.0,
                y + 3.5,
                100.0 * share
            );
        }
    }
    match stops {
        Some(stops) => stops.iter().enumerate().for_each(|(at, name)| {
            let anchor = if at == 0 {
                "start"
            } else if at + 1 == longest {
                "end"
            } else {
                "mid"
            };
            let _ = write!(
                svg,
                "<text x=\"{:.1}\" y=\"{}\" class=\"{anchor}\">{name}</text>",
                axes.x(at as f64),
                AREA[3] + 16.0
            );
        }),
        None => ticks(axes.x, 6.0).into_iter().for_each(|at| {
            let _ = write!(
                svg,
                "<text x=\"{:.1}\" y=\"{}\" class=\"mid\">{}</text>",
                axes.x(at),
                AREA[3] + 16.0,
                short(at)
            );
        }),
    }
    for curve in &relative {
        let _ = write!(svg, "<path class=\"thin\" d=\"{}\"/>", line(&axes, curve));
    }
    let median: Vec<f64> = (0..longest)
        .map(|at| statistics::quantile(&sorted(relative.iter().filter_map(|curve| curve.get(at).copied())), 0.5))
        .collect();
    let _ = write!(svg, "<path class=\"strong\" d=\"{}\"/></svg>", line(&axes, &median));
    format!("{svg}<figcaption>{summary}. The thick line is the median.</figcaption>")
}

fn sorted(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values
}

fn line(axes: &Axes, shares: &[f64]) -> String {
    let mut path = String::new();
    for (at, share) in shares.iter().enumerate() {
        let letter = if at == 0 { 'M' } else { 'L' };
        let _ = write!(path, "{letter}{:.1} {:.1}", axes.x(at as f64), axes.y(cosfly_frames::real::ln(*share)));
    }
    path
}

/// The class of a share of visibility, 0 (lost) to 4 (seen).
pub fn class_of(visible: f32) -> usize {
    ((visible * 5.0) as usize).min(4)
}

/// Names of the classes of [`class_of`].
pub const CLASSES: [&str; 5] = ["under 20 %", "20 to 40 %", "40 to 60 %", "60 to 80 %", "over 80 %"];

/// Visibility over time as a strip of colours, as wide as `longest` frames would fill the page.
pub fn strip(visible: &[f32], longest: usize, name: &str) -> String {
    let mut svg = format!(
        "<svg class=\"strip\" viewBox=\"0 0 {longest} 10\" preserveAspectRatio=\"none\" role=\"img\" aria-label=\"{}\">",
        escaped(name)
    );
    let mut start = 0;
    while start < visible.len() {
        let class = class_of(visible[start]);
        let end = (start..visible.len()).find(|at| class_of(visible[*at]) != class).unwrap_or(visible.len());
        let _ = write!(svg, "<path class=\"f{class}\" d=\"M{start} 0H{end}V10H{start}Z\"/>");
        start = end;
    }
    svg.push_str("</svg>");
    svg
}
