//! Costs of flights while they are planned, on a logarithmic scale.

use crate::axes::{Axes, open, ticks};
use crate::statistics;
use crate::text::{percent, short};
use std::fmt::Write;

/// A chart of costs by iteration, each curve divided by its first value; `stops` are names of the iterations where there are few.
/// HTML: the chart and its caption.
pub fn convergence(curves: &[&[f64]], stops: Option<&[&str]>) -> String {
    let longest = curves.iter().map(|curve| curve.len()).max().unwrap_or(0);
    let share = |share: f64| if share.is_nan() { 1.0 } else { share.clamp(1e-3, 1e3) };
    let of_first = |curve: &&[f64]| curve.iter().map(|cost| share(cost / curve[0])).collect();
    let relative: Vec<Vec<f64>> = curves.iter().map(of_first).collect();
    let logs: Vec<f64> = relative.iter().flatten().map(|share| cosfly_frames::real::ln(*share)).collect();
    let (low, high) = logs.iter().fold((0.0_f64, 0.0_f64), |(low, high), it| (low.min(*it), high.max(*it)));
    let axes = Axes { x: (0.0, longest.saturating_sub(1) as f64), y: (low - 0.05, high + 0.05) };
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
            axes.grid_line(&mut svg, y, &format!("{:.0} %", 100.0 * share));
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
            axes.x_label(&mut svg, at as f64, anchor, name);
        }),
        None => ticks(axes.x, 6.0).into_iter().for_each(|at| axes.x_label(&mut svg, at, "mid", &short(at))),
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
