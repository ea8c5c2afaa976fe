//! Signs that give the target away: the middle of the picture, size, and looks.

use crate::model::Report;
use cosfly_diagnose::counted;
use cosfly_metrics::shortcuts::{Probe, ShortcutFigures};
use cosfly_plot::text::{escaped, grouped, percent};
use std::fmt::Write;

/// The section; empty where no frame shows a target.
pub fn section(report: &Report) -> String {
    let Some(figures) = report.shortcuts.filter(|figures| figures.frames > 0) else { return String::new() };
    let mut text = String::from("<dl class=\"tiles\">");
    for (name, value, note) in rows(&figures) {
        let _ = write!(
            text,
            "<div class=\"tile\"><dt>{name}</dt><dd><b>{}</b><small>{}</small></dd></div>",
            escaped(&value),
            escaped(&note)
        );
    }
    text.push_str("</dl>");
    text.push_str(
        "<p class=\"note\">A model that takes the person or vehicle in the middle, or the tallest one, for the target needs no instruction and no \
         memory. An AUC is the probability that a target has more of a sign than somebody else: 0.5 tells nothing. Who is followed is \
         near the camera and in view; in the same place are people as far away and as far from the middle, seen from feet to head.</p>",
    );
    text
}

/// Name, value and remark.
fn rows(figures: &ShortcutFigures) -> Vec<(&'static str, String, String)> {
    let mut rows = vec![];
    if let Some(share) = figures.target_nearest_the_centre {
        let frames = format!("of {} expert frames that show it", grouped(figures.frames));
        rows.push(("Of its kind, the target is nearest to the centre", percent(share), frames));
    }
    if let Some(nearer) = figures.mean_people_nearer {
        rows.push((
            "Others of its kind nearer to the centre",
            format!("{nearer:.2}"),
            "mean over these frames".to_owned(),
        ));
    }
    for (name, probe, against) in [
        ("Place, AUC", figures.place, "others in the same frame"),
        ("Height in pixels, AUC", figures.height, "others in the same frame"),
        ("Height in the same place, AUC", figures.height_in_the_same_place, "people in the same place"),
    ] {
        if let Some(Probe { auc, standard_error, flights, .. }) = probe {
            let note = format!("against {against}; {}", error_of(standard_error, flights));
            rows.push((name, format!("{auc:.2}"), note));
        }
    }
    let Some(looks) = figures.looks else { return rows };
    let people = format!("{}, {}", counted(figures.targets, "target"), counted(figures.others, "bystander"));
    for (name, auc) in [
        ("Colourfulness of tops, AUC", looks.colourfulness),
        ("Brightness of tops, AUC", looks.brightness),
        ("Body height, AUC", looks.height),
        ("Bags, AUC", looks.bag),
        ("Build, AUC", looks.build),
        ("Steps, AUC", looks.steps),
    ] {
        let note = format!("{people}; 0.50 \u{b1} {:.2} by chance{}", looks.standard_error, few(looks.standard_error));
        rows.push((name, format!("{auc:.2}"), note));
    }
    rows
}

/// The error of a figure in words.
fn error_of(standard_error: Option<f64>, flights: u64) -> String {
    match standard_error {
        Some(error) => format!("\u{b1} {error:.2} over {}{}", counted(grouped(flights), "flight"), few(error)),
        None => "of one flight: too few to tell".to_owned(),
    }
}

/// A warning where a figure is of too few targets.
fn few(standard_error: f64) -> &'static str {
    if ShortcutFigures::is_telling(standard_error) { "" } else { ": too few to tell" }
}
