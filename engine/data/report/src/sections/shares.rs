//! Shares of splits, towns and weathers, and rejected items.

use crate::figures::Group;
use crate::model::Report;
use cosfly_plot::text::{escaped, grouped, percent};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Number of reasons that are listed.
const MOST_REASONS: usize = 20;

/// The section.
pub fn section(report: &Report) -> String {
    let [splits, towns, weathers] = &report.figures.groups;
    let cards = [
        table("Splits", "split", splits),
        table("Towns", "town", towns),
        table("Weather", "weather", weathers),
        rejected(report),
    ];
    format!("<div class=\"grid small\">{}</div>", cards.concat())
}

fn table(title: &str, heading: &str, groups: &BTreeMap<String, Group>) -> String {
    let mut text = format!(
        "<section class=\"card\"><h3>{title}</h3><div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"{title}\"><table>\
         <thead><tr><th scope=\"col\">{heading}</th><th scope=\"col\">flights</th><th scope=\"col\">frames</th><th scope=\"col\">\
         visible, expert</th><th scope=\"col\">visible, perturbed</th></tr></thead><tbody>"
    );
    for (name, group) in groups {
        let flights: u64 = group.flights.iter().sum();
        let [expert, perturbed] = group.mean_visible().map(|mean| mean.map_or_else(String::new, percent));
        let _ = write!(
            text,
            "<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{expert}</td><td>{perturbed}</td></tr>",
            escaped(name),
            grouped(flights),
            grouped(group.frames)
        );
    }
    text.push_str("</tbody></table></div></section>");
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
