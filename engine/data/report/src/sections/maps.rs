//! Maps of the flights.

use crate::map;
use crate::model::Report;
use crate::sample::TOWNS;
use cosfly_plot::strip::CLASSES;
use std::fmt::Write;

/// The section.
pub fn section(report: &Report) -> String {
    let drawn = report.figures.drawn();
    let maps: String = report
        .towns
        .iter()
        .take(TOWNS)
        .map(|town| {
            let flights: Vec<_> = drawn.iter().filter(|flight| flight.town == town.name).copied().collect();
            let [experts, perturbed] = report.figures.groups[1].get(&town.name).map_or([0; 2], |group| group.flights);
            map::draw(town, &flights, if experts > 0 { experts } else { perturbed })
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
