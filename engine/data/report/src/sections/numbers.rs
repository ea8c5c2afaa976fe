//! The statistics table of the paper beside the numbers of this dataset.

use crate::model::Report;
use cosfly_plot::text::{escaped, grouped, short};
use std::fmt::Write;

/// RGB, depth, segmentation, drone pose, target state (paper, section on the dataset: five channels per timestep).
const CHANNELS: u64 = 5;

/// The section.
pub fn section(report: &Report) -> String {
    let mut text = String::from("<dl class=\"tiles\">");
    for (name, here, paper) in rows(report) {
        let _ = write!(
            text,
            "<div class=\"tile\"><dt>{name}</dt><dd><b>{}</b><small>paper: {paper}</small></dd></div>",
            escaped(&here)
        );
    }
    text.push_str("</dl>");
    text.push_str(
        "<p class=\"note\">The rows are those of the statistics table of the CosFly-Track paper, whose figures stand below \
         ours. An annotation sample is one of five channels of one timestep: colour, depth, segmentation, drone pose, \
         target state.</p>",
    );
    text
}

/// Name, value of this dataset, value of the paper.
fn rows(report: &Report) -> Vec<(&'static str, String, &'static str)> {
    let figures = &report.figures;
    let [experts, perturbed] = figures.flights;
    let [_, towns, weathers] = figures.groups.each_ref().map(|groups| groups.len() as u64);
    let (frames, seconds) = (figures.frames, figures.duration_s);
    let count = figures.all().max(1) as f64;
    vec![
        ("Unique pedestrian paths", grouped(figures.walks.len() as u64), "~6,000"),
        ("Expert and perturbed trajectories", format!("{experts} + {perturbed}"), "~12,000"),
        ("Timesteps", grouped(frames), "2.4M"),
        ("Annotation samples", grouped(frames * CHANNELS), "~10M"),
        ("Total tracking duration", duration(seconds), "~334 hours"),
        ("Urban scenes", grouped(towns), "16"),
        ("Weather and lighting conditions", grouped(weathers), "8+"),
        (
            "Average trajectory",
            format!("{} steps / {} s", short(frames as f64 / count), short(seconds / count)),
            "~200 steps / 100 s",
        ),
    ]
}

fn duration(seconds: f64) -> String {
    match seconds {
        _ if seconds < 90.0 => format!("{} s", short(seconds)),
        _ if seconds < 5_400.0 => format!("{} min", short(seconds / 60.0)),
        _ => format!("{} hours", short(seconds / 3_600.0)),
    }
}
