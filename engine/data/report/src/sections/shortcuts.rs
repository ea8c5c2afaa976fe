//! Signs that give the target away: the middle of the picture, and the clothes.

use crate::model::Report;
use cosfly_metrics::shortcuts::ShortcutFigures;
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
        "<p class=\"note\">A model that takes the person in the middle, or the one in bright clothes, for the target needs no \
         instruction and no memory. An AUC is the probability that a random target's top is more colourful, or brighter, \
         than a random bystander's: 0.5 tells nothing.</p>",
    );
    text
}

/// Name, value and remark.
fn rows(figures: &ShortcutFigures) -> Vec<(&'static str, String, String)> {
    let mut rows = vec![];
    if let Some(share) = figures.target_nearest_the_centre {
        let frames = format!("of {} expert frames that show it", grouped(figures.frames));
        rows.push(("Target is the person nearest to the centre", percent(share), frames));
    }
    if let Some(nearer) = figures.mean_people_nearer {
        rows.push(("People nearer to the centre", format!("{nearer:.2}"), "mean over these frames".to_owned()));
    }
    for (name, auc) in [("Place, AUC", figures.place_auc), ("Height in pixels, AUC", figures.height_auc)] {
        if let Some(auc) = auc {
            rows.push((name, format!("{auc:.2}"), "against others in the same frame; 0.50 by chance".to_owned()));
        }
    }
    let people = format!("{} targets, {} bystanders", figures.targets, figures.others);
    let error = figures.clothes_auc_standard_error.unwrap_or_default();
    for (name, auc) in [
        ("Clothes, AUC of colourfulness", figures.clothes_auc_colourfulness),
        ("Clothes, AUC of brightness", figures.clothes_auc_brightness),
    ] {
        if let Some(auc) = auc {
            rows.push((name, format!("{auc:.2}"), format!("{people}; 0.50 \u{b1} {error:.2} by chance")));
        }
    }
    rows
}
