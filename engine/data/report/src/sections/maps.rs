//! Maps of the flights.

use crate::map;
use crate::model::Report;
use cosfly_plot::strip::CLASSES;
use std::fmt::Write;

/// Number of towns that are drawn.
const MOST_TOWNS: usize = 20;

/// The section.
pub fn section(report: &Report) -> String {
    let maps: String = report
        .towns
        .iter()
        .take(MOST_TOWNS)
        .map(|town| {
            let flights: Vec<_> = report.flights.iter().filter(|flight| flight.town == town.name).collect();
            map::draw(town, &flights)
        })
        .collect();
    if maps.is_empty() { String::new() } else { legend() + &maps }
}

/// Legend of the colours of visibility.
pub fn legend() -> String {
    let mut text = String::from("<p class=\"legend\"><span>Share of the target that is visible:</span>");
    for (class, name) in CLASSES.iter().enumerate().rev() {
        let _ = write!(text, "<span><i class=\"b{class}\"></i>{name}</span>");
    }
    text.push_str("</p>");
    text
}
