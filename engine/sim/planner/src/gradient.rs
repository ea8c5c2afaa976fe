//! The total cost of a flight and its slope: exact where a term knows it, wide differences elsewhere.

use crate::terms::term::{CostTerm, TermContext, WeightedTerm};
use cosfly_frames::DVec3;

/// Sum over frames and terms, weighted (paper, equation 1).
pub fn total_cost(terms: &[WeightedTerm], waypoints: &[DVec3], context: &TermContext<'_>) -> f64 {
    let mut per_frame = vec![0.0; waypoints.len()];
    let mut total = 0.0;
    for weighted in terms.iter().filter(|weighted| weighted.weight > 0.0) {
        weighted.term.cost(waypoints, context, &mut per_frame);
        total += weighted.weight * per_frame.iter().sum::<f64>();
    }
    total
}

/// Gradient of [`total_cost`]; terms without their own take coordinate-wise differences of `step_m`.
pub fn total_gradient(
    terms: &[WeightedTerm],
    waypoints: &[DVec3],
    context: &TermContext<'_>,
    step_m: f64,
) -> Vec<DVec3> {
    let mut gradient = vec![DVec3::ZERO; waypoints.len()];
    for weighted in terms.iter().filter(|weighted| weighted.weight > 0.0) {
        if !weighted.term.add_gradient(waypoints, context, weighted.weight, &mut gradient) {
            difference_gradient(weighted.term.as_ref(), waypoints, context, weighted.weight, step_m, &mut gradient);
        }
    }
    gradient
}

/// Adds `weight` times the central differences of a term's summed cost. Waypoints further apart than twice the
/// term's support are moved together, so one term costs `6 (2 support + 1)` evaluations whatever the length.
pub fn difference_gradient(
    term: &dyn CostTerm,
    waypoints: &[DVec3],
    context: &TermContext<'_>,
    weight: f64,
    step_m: f64,
    gradient: &mut [DVec3],
) {
    let reach = term.support();
    let stride = 2 * reach + 1;
    let mut moved = waypoints.to_vec();
    let (mut above, mut below) = (vec![0.0; waypoints.len()], vec![0.0; waypoints.len()]);
    for first in 0..stride.min(waypoints.len()) {
        for axis in 0..3 {
            for (step, costs) in [(step_m, &mut above), (-step_m, &mut below)] {
                (first..waypoints.len()).step_by(stride).for_each(|i| moved[i][axis] = waypoints[i][axis] + step);
                term.cost(&moved, context, costs);
            }
            for i in (first..waypoints.len()).step_by(stride) {
                moved[i][axis] = waypoints[i][axis];
                let neighbours = i.saturating_sub(reach)..(i + reach + 1).min(waypoints.len());
                let change: f64 = neighbours.map(|n| above[n] - below[n]).sum();
                gradient[i][axis] += weight * change / (2.0 * step_m);
            }
        }
    }
}
