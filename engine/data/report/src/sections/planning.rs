//! Costs of planning, and limits.

use crate::figures::{Figures, LimitFigures};
use crate::model::Report;
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
    let figures = &report.figures;
    let parts = [convergence(figures), terms(&figures.term_costs), limits(figures)];
    let cards: Vec<&String> = parts.iter().filter(|part| !part.is_empty()).collect();
    let cards: String = cards.into_iter().map(|part| format!("<figure class=\"card\">{part}</figure>")).collect();
    if cards.is_empty() { cards } else { format!("<div class=\"grid\">{cards}</div>") }
}

fn convergence(figures: &Figures) -> String {
    let flights = figures.drawn();
    let curves: Vec<&[f64]> =
        flights.iter().filter(|flight| flight.is_planned()).map(|flight| flight.convergence.as_slice()).collect();
    if curves.is_empty() {
        return String::new();
    }
    let drawn: Vec<&[f64]> = spread(curves.len(), MOST_CURVES).into_iter().map(|at| curves[at]).collect();
    let are_stops = figures.planned[0] == figures.planned[1];
    let explained = if are_stops {
        "Total cost of the lattice's way, after its refinement, and of the flight as published, which is made safe last and \
         may cost more for it."
    } else {
        "Total cost iteration by iteration and of the flight as published."
    };
    let picture = chart(&drawn, are_stops.then_some(&STOPS[..]));
    format!("<h3>Cost convergence</h3>{picture}<p class=\"note\">{explained}</p>")
}

fn terms(sums: &BTreeMap<String, f64>) -> String {
    let total: f64 = sums.values().sum();
    let mut order: Vec<(&str, f64)> = sums.iter().map(|(name, cost)| (name.as_str(), *cost)).collect();
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

fn limits(figures: &Figures) -> String {
    let experts = figures.flights[0];
    if experts == 0 {
        return String::new();
    }
    let LimitFigures { sound, nearest_m, fastest_mps: fastest, jerk_mps3: jerk, broken } = &figures.limits;
    let nearest = nearest_m.unwrap_or(f32::INFINITY);
    let mut text = format!(
        "<h3>Limits</h3><p class=\"big\">{sound} of {}</p><p>experts keep all limits of clearance, speed, acceleration and jerk.</p>\
         <ul><li>nearest obstacle: {nearest:.2} m</li><li>fastest: {fastest:.1} m/s</li><li>largest jerk: {jerk:.1} m/s³</li></ul>",
        experts
    );
    if !broken.is_empty() {
        let items: String = broken.iter().map(|(_, _, it)| format!("<li>{}</li>", escaped(it))).collect();
        let _ = write!(text, "<p>Not kept:</p><ul>{items}</ul>");
    }
    text
}
