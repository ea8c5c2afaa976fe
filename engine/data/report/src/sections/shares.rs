//! Shares of splits, towns and weathers, and rejected items.

use crate::model::{FlightSketch, Report};
use cosfly_plot::text::{escaped, grouped, percent};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Number of reasons that are listed.
const MOST_REASONS: usize = 20;

/// The section.
pub fn section(report: &Report) -> String {
    let cards = [
        table("Splits", "split", report, &|flight| &flight.split),
        table("Towns", "town", report, &|flight| &flight.town),
        table("Weather", "weather", report, &|flight| &flight.weather),
        rejected(report),
    ];
    format!("<div class=\"grid small\">{}</div>", cards.concat())
}

fn table(title: &str, heading: &str, report: &Report, of: &dyn Fn(&FlightSketch) -> &str) -> String {
    let mut groups: BTreeMap<&str, (u64, u64, f64)> = BTreeMap::new();
    for flight in &report.flights {
        let (flights, frames, visible) = groups.entry(of(flight)).or_default();
        *flights += 1;
        *frames += flight.len() as u64;
        *visible += flight.mean_visible();
    }
    let mut text = format!(
        "<section class=\"card\"><h3>{title}</h3><table><thead><tr><th scope=\"col\">{heading}</th><th scope=\"col\">flights\
         </th><th scope=\"col\">frames</th><th scope=\"col\">visible</th></tr></thead><tbody>"
    );
    for (name, (flights, frames, visible)) in groups {
        let _ = write!(
            text,
            "<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td></tr>",
            escaped(name),
            grouped(flights),
            grouped(frames),
            percent(visible / flights.max(1) as f64)
        );
    }
    text.push_str("</tbody></table></section>");
    text
}

fn rejected(report: &Report) -> String {
    let mut reasons: BTreeMap<(&str, &str), u64> = BTreeMap::new();
    for it in &report.rejections {
        *reasons.entry((&it.stage, &it.reason)).or_default() += 1;
    }
    let mut text = format!(
        "<section class=\"card whole-row\"><h3>Left out</h3><p class=\"big\">{}</p><p>items gave no flight{}</p>",
        grouped(report.rejections.len() as u64),
        if reasons.is_empty() { "." } else { ":" }
    );
    if !reasons.is_empty() {
        text.push_str("<ul>");
        for ((stage, reason), count) in reasons.into_iter().take(MOST_REASONS) {
            let _ = write!(text, "<li>{count} in <code>{}</code>: {}</li>", escaped(stage), escaped(reason));
        }
        text.push_str("</ul>");
    }
    text.push_str("</section>");
    text
}
