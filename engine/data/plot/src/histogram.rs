//! Histograms of experts' and perturbed flights as figures, with a table of their numbers.

use crate::axes::{Axes, open};
use crate::distribution::Distribution;
use crate::statistics;
use crate::text::{escaped, percent, short, told_apart};
use std::fmt::Write;

/// Values of experts' and of perturbed flights.
pub struct Histogram<'a> {
    /// Heading of the figure.
    pub title: &'a str,
    /// Quantity with its unit, below the axis.
    pub axis: &'a str,
    /// Values of experts' flights.
    pub experts: &'a Distribution,
    /// Values of perturbed flights.
    pub perturbed: &'a Distribution,
    /// Least and greatest value on the axis; from the values where it is absent.
    pub range: Option<(f64, f64)>,
    /// Smallest width of a bin.
    pub least_step: f64,
}

impl Histogram<'_> {
    /// The figure, HTML; empty without values.
    pub fn draw(&self) -> String {
        let mut all = self.experts.clone();
        all.merge(self.perturbed);
        if all.is_empty() {
            return String::new();
        }
        let (low, high) = self.range.unwrap_or_else(|| (all.quantile(0.0), all.quantile(0.995)));
        let wanted = ((high - low) / self.least_step.max(1e-9) + 1.0).clamp(1.0, 16.0);
        let edges = statistics::edges(low, high, wanted as usize);
        let series = [("expert", self.experts), ("perturbed", self.perturbed)];
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
        let of = |name: &str, numbers: &Distribution| {
            let [p5, p50, p95] = [0.05, 0.5, 0.95].map(|at| short(numbers.quantile(at)));
            (!numbers.is_empty()).then(|| format!("{name}: median {p50}, 5 to 95 %: {p5} to {p95}"))
        };
        let parts = [of("experts", self.experts), of("perturbed", self.perturbed)];
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
    let labels = told_apart(edges);
    for bin in 0..edges.len() - 1 {
        let _ = write!(table, "<tr><td>{}</td><td>{}</td>", labels[bin], labels[bin + 1]);
        series.iter().for_each(|(_, shares)| {
            let _ = write!(table, "<td>{}</td>", percent(shares[bin]));
        });
        table.push_str("</tr>");
    }
    table.push_str("</tbody></table></details>");
    table
}
