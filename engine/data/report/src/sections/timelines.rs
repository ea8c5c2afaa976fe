//! Visibility over time: a strip of colours per flight.

use super::maps::legend;
use crate::model::Report;
use crate::moments::spread;
use crate::sketch::FlightSketch;
use cosfly_diagnose::counted;
use cosfly_plot::strip::strip;
use cosfly_plot::text::{escaped, percent, short};
use std::fmt::Write;

/// Number of rows of the table.
const MOST_ROWS: usize = 40;

/// The section.
pub fn section(report: &Report) -> String {
    let longest = report.figures.longest.max(1);
    let mut text = legend();
    text.push_str(
        "<div class=\"scroll card\" tabindex=\"0\" role=\"region\" aria-label=\"Visibility over time\"><table class=\"strips\">\
         <thead><tr><th scope=\"col\">flight</th><th scope=\"col\">visible</th><th scope=\"col\">lost, longest</th>\
         <th scope=\"col\">over time</th></tr></thead><tbody>",
    );
    let mut order: Vec<&FlightSketch> = report.figures.drawn();
    order.sort_by(|a, b| {
        let key = |it: &FlightSketch| (it.town.clone(), it.pedestrian.clone(), it.is_perturbed, it.id.clone());
        key(a).cmp(&key(b))
    });
    let rows = spread(order.len(), MOST_ROWS);
    for flight in rows.iter().map(|at| order[*at]) {
        let lost_s = flight.occlusions().into_iter().map(|it| it.1).max().unwrap_or(0) as f64 * flight.dt_s;
        let name = format!("{}: visibility over {} s", flight.id, short(flight.duration_s()));
        let _ = write!(
            text,
            "<tr><th scope=\"row\">{}</th><td>{}</td><td>{} s</td><td>{}</td></tr>",
            escaped(&flight.id),
            percent(flight.mean_visible()),
            short(lost_s),
            strip(&flight.visible, longest, &name)
        );
    }
    text.push_str("</tbody></table></div>");
    let all = report.figures.all();
    if (rows.len() as u64) < all {
        let _ = write!(text, "<p class=\"note\">{} of {}.</p>", rows.len(), counted(all, "flight"));
    }
    text
}
