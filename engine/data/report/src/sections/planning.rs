//! Costs of planning, and limits.

use crate::model::{FlightSketch, Report};
use crate::moments::spread;
use cosfly_plot::convergence::convergence as chart;
use cosfly_plot::text::{escaped, percent};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Number of curves in the picture.
const MOST_CURVES: usize = 80;
/// Steps of planning whose costs are kept.
const STOPS: [&str; 3] = ["lattice", "refined", "published"];

/// The section.
pub fn section(report: &Report) -> String {
    let parts = [convergence(&report.flights), terms(&report.flights), limits(&report.flights)];
    let cards: Vec<&String> = parts.iter().filter(|part| !part.is_empty()).collect();
    let cards: String = cards.into_iter().map(|part| format!("<figure class=\"card\">{part}</figure>")).collect();
    if cards.is_empty() { cards } else { format!("<div class=\"grid\">{cards}</div>") }
}

fn convergence(flights: &[FlightSketch]) -> String {
    let usable = |flight: &&FlightSketch| {
        flight.convergence.len() > 1 && flight.convergence.iter().all(|cost| cost.is_finite() && *cost > 0.0)
    };
    let curves: Vec<&[f64]> = flights.iter().filter(usable).map(|flight| flight.convergence.as_slice()).collect();
    if curves.is_empty() {
        return String::new();
    }
    let drawn: Vec<&[f64]> = spread(curves.len(), MOST_CURVES).into_iter().map(|at| curves[at]).collect();
    let are_stops = curves.iter().all(|curve| curve.len() == STOPS.len());
    let explained = if are_stops {
        "Total cost of the lattice's way, after its refinement, and of the flight as published, which is made safe last and \
         may cost more for it."
    } else {
        "Total cost iteration by iteration and of the flight as published."
    };
    let picture = chart(&drawn, are_stops.then_some(&STOPS[..]));
    format!("<h3>Cost convergence</h3>{picture}<p class=\"note\">{explained}</p>")
}

fn terms(flights: &[FlightSketch]) -> String {
    let mut sums: BTreeMap<&str, f64> = BTreeMap::new();
    for (name, cost) in flights.iter().flat_map(|flight| &flight.term_costs) {
        *sums.entry(name).or_default() += cost;
    }
    let total: f64 = sums.values().sum();
    let mut order: Vec<(&str, f64)> = sums.into_iter().collect();
    order.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(b.0)));
    if order.is_empty() || total.is_nan() || total <= 0.0 {
        return String::new();
    }
    let mut text = String::from(
        "<h3>What the cost is made of</h3><table class=\"bars\"><thead><tr><th scope=\"col\">term</th>\
         <th scope=\"col\">share</th><th scope=\"col\"><span class=\"hidden\">bar</span></th></tr></thead><tbody>",
    );
    for (name, cost) in order {
        let share = cost / total;
        let _ = write!(
            text,
            "<tr><th scope=\"row\">{}</th><td>{}</td><td class=\"bar-cell\"><i style=\"width:{:.1}%\"></i></td></tr>",
            escaped(name),
            percent(share),
            100.0 * share.max(0.0)
        );
    }
    text.push_str("</tbody></table><p class=\"note\">Weighted costs of all published experts together.</p>");
    text
}

fn limits(flights: &[FlightSketch]) -> String {
    let checked: Vec<&FlightSketch> = flights.iter().filter(|flight| !flight.is_perturbed).collect();
    if checked.is_empty() {
        return String::new();
    }
    let sound = checked.iter().filter(|flight| flight.holds).count();
    let nearest = checked.iter().flat_map(|flight| &flight.clearance_m).copied().fold(f32::INFINITY, f32::min);
    let fastest = checked.iter().flat_map(|flight| flight.speeds_mps()).fold(0.0, f32::max);
    let jerk = checked.iter().map(|flight| flight.max_jerk_mps3).fold(0.0, f64::max);
    let mut text = format!(
        "<h3>Limits</h3><p class=\"big\">{sound} of {}</p><p>experts keep all limits of clearance, speed, acceleration and jerk.</p>\
         <ul><li>nearest obstacle: {nearest:.2} m</li><li>fastest: {fastest:.1} m/s</li><li>largest jerk: {jerk:.1} m/s³</li></ul>",
        checked.len()
    );
    let broken: Vec<String> = checked
        .iter()
        .flat_map(|flight| flight.violations.iter().map(|it| format!("{}: {it}", flight.id)))
        .take(5)
        .collect();
    if !broken.is_empty() {
        let items: String = broken.iter().map(|it| format!("<li>{}</li>", escaped(it))).collect();
        let _ = write!(text, "<p>Not kept:</p><ul>{items}</ul>");
    }
    text
}
