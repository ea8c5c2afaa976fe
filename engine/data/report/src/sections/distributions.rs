//! Histograms: visibility, distance, height, speed, clearance, size in the image, losses.

use crate::model::{FlightSketch, Report};
use cosfly_plot::histogram::Histogram;

/// The section.
pub fn section(report: &Report) -> String {
    let of = |perturbed: bool, numbers: &dyn Fn(&FlightSketch) -> Vec<f32>| -> Vec<f32> {
        report.flights.iter().filter(|flight| flight.is_perturbed == perturbed).flat_map(numbers).collect()
    };
    let step_s = report.flights.first().map_or(0.0, |flight| flight.dt_s);
    let draw = |title: &str,
                axis: &str,
                range: Option<(f64, f64)>,
                least_step: f64,
                numbers: &dyn Fn(&FlightSketch) -> Vec<f32>| {
        Histogram { title, axis, experts: of(false, numbers), perturbed: of(true, numbers), range, least_step }.draw()
    };
    let heights = |flight: &FlightSketch| flight.drone_m.iter().zip(&flight.feet_m).map(|(a, b)| a[2] - b[2]).collect();
    let sizes = |flight: &FlightSketch| (0..flight.len()).map(|frame| flight.box_height_px(frame)).collect();
    let losses =
        |flight: &FlightSketch| flight.occlusions().into_iter().map(|it| (it.1 as f64 * flight.dt_s) as f32).collect();
    let longest = report.flights.iter().flat_map(&losses).fold(0.0, f32::max);
    let charts = [
        draw("Visibility", "share of the body, per frame", Some((0.0, 1.0)), 0.0, &|it| it.visible.clone()),
        draw(
            "Length of losses",
            "seconds with less than half visible",
            Some((0.0, f64::from(longest))),
            step_s,
            &losses,
        ),
        draw("Distance to the target", "metres, per frame", None, 0.0, &FlightSketch::distances_m),
        draw("Height above the target", "metres, per frame", None, 0.0, &heights),
        draw("Clearance", "metres to the nearest obstacle", None, 0.0, &|it| it.clearance_m.clone()),
        draw("Speed of the drone", "m/s", None, 0.0, &FlightSketch::speeds_mps),
        draw("Speed of the target", "m/s", None, 0.0, &FlightSketch::target_speeds_mps),
        draw("Target in the image", "height of its box, pixels", None, 0.0, &sizes),
    ];
    let key = "<p class=\"legend\"><span><i class=\"k-expert\"></i>experts</span><span><i class=\"k-perturbed\"></i>perturbed\
               </span><span>Heights are shares of all frames of the kind.</span></p>";
    format!("{key}<div class=\"grid\">{}</div>", charts.concat())
}
