//! Histograms: visibility, distance, height, speed, clearance, size in the image, losses.

use crate::figures::DrawnQuantity;
use crate::model::Report;
use cosfly_plot::histogram::Histogram;

/// The section.
pub fn section(report: &Report) -> String {
    let figures = &report.figures;
    let draw = |title: &str, axis: &str, range: Option<(f64, f64)>, least_step: f64, quantity: DrawnQuantity| {
        let [experts, perturbed] = figures.numbers(quantity);
        Histogram { title, axis, experts, perturbed, range, least_step }.draw()
    };
    let longest =
        figures.numbers(DrawnQuantity::Losses).map(|losses| losses.quantile(1.0)).into_iter().fold(0.0, f64::max);
    let losses = "seconds with less than half visible";
    let charts = [
        draw("Visibility", "share of the body, per frame", Some((0.0, 1.0)), 0.0, DrawnQuantity::Visible),
        draw("Length of losses", losses, Some((0.0, longest)), figures.dt_s, DrawnQuantity::Losses),
        draw("Distance to the target", "metres, per frame", None, 0.0, DrawnQuantity::Distance),
        draw("Height above the target", "metres, per frame", None, 0.0, DrawnQuantity::Height),
        draw("Clearance", "metres to the nearest obstacle", None, 0.0, DrawnQuantity::Clearance),
        draw("Speed of the drone", "m/s", None, 0.0, DrawnQuantity::Speed),
        draw("Speed of the target", "m/s", None, 0.0, DrawnQuantity::TargetSpeed),
        draw("Target in the image", "height of its box, pixels", None, 0.0, DrawnQuantity::BoxHeight),
    ];
    let key = "<p class=\"legend\"><span><i class=\"k-expert\"></i>experts</span><span><i class=\"k-perturbed\"></i>perturbed\
               </span><span>Heights are shares of all frames of the kind.</span></p>";
    format!("{key}<div class=\"grid\">{}</div>", charts.concat())
}
