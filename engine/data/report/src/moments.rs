//! Choice of the flights and frames that the page shows.

use crate::sample::Worst;
use crate::sketch::FlightSketch;

/// Mean visibility from which a flight is not a bad case.
const FULLY: f64 = 0.9995;

/// A reason to look at a flight, and the frames that show it.
pub struct Case<'a> {
    /// The flight.
    pub flight: &'a FlightSketch,
    /// Property in which the flight is the worst.
    pub what: &'static str,
    /// The value as text.
    pub figure: String,
    /// Frames to show, each with a description.
    pub frames: Vec<(usize, &'static str)>,
}

/// Pictures in the heading: `count` moments spread over the flights, those that show their target large; fewer when there
/// are not enough frames. Few flights are shown at several of their moments.
pub fn gallery<'a>(flights: &[&'a FlightSketch], count: usize) -> Vec<(&'a FlightSketch, usize)> {
    let experts: Vec<&FlightSketch> = flights.iter().filter(|it| !it.is_perturbed).copied().collect();
    let chosen: Vec<&FlightSketch> = if experts.is_empty() { flights.to_vec() } else { experts };
    let shown = spread(chosen.len(), count);
    let rounds = count.div_ceil(shown.len().max(1));
    let moments = |round: usize| {
        let of_round = shown.iter().map(|at| chosen[*at]).collect::<Vec<&FlightSketch>>().into_iter();
        of_round.filter_map(move |flight| Some((flight, best_frame(flight, round, rounds)?)))
    };
    (0..rounds).flat_map(moments).take(count).collect()
}

/// Up to `count` places of `length`, the same distance apart.
pub fn spread(length: usize, count: usize) -> Vec<usize> {
    let count = count.min(length);
    (0..count).map(|at| (2 * at + 1) * length / (2 * count)).collect()
}

/// The frame that shows the target large and free in one of so many parts of a flight, its ends left out.
fn best_frame(flight: &FlightSketch, part: usize, parts: usize) -> Option<usize> {
    let value = |frame: &usize| flight.visible[*frame] * flight.box_height_px(*frame);
    let (start, end) = (flight.len() / 6, (5 * flight.len()).div_ceil(6));
    let edge = |part: usize| start + (end - start) * part / parts;
    (edge(part)..edge(part + 1)).max_by(|a, b| value(a).total_cmp(&value(b)).then(b.cmp(a)))
}

/// The worst flight of each property.
pub fn worst(flights: &Worst) -> Vec<Case<'_>> {
    let names = ["least visible expert", "second least visible expert", "third least visible expert"];
    let experts = flights.hidden_experts.iter().map(|it| &it.1).zip(names).enumerate();
    // The first is shown whatever it is; others only where something is hidden.
    let mut cases: Vec<Case<'_>> = experts
        .filter(|(rank, (flight, _))| *rank == 0 || flight.mean_visible() < FULLY)
        .map(|(_, (flight, name))| hidden(flight, name))
        .collect();
    cases.extend(flights.hidden_perturbed.iter().map(|(_, flight)| hidden(flight, "least visible perturbed flight")));
    cases.extend(flights.nearest.iter().map(|(_, flight)| {
        let frame = lowest(&flight.clearance_m);
        let nearest_m = flight.clearance_m.get(frame).copied().unwrap_or(f32::INFINITY);
        let figure = format!("{nearest_m:.2} m to the nearest obstacle");
        Case { flight, what: "closest to an obstacle", figure, frames: vec![(frame, "the nearest frame")] }
    }));
    cases.extend(flights.roughest.iter().map(|(_, flight)| {
        let figure = format!("jerk up to {:.1} m/s³", flight.max_jerk_mps3);
        Case { flight, what: "roughest expert", figure, frames: vec![(roughest(flight), "where the jerk peaks")] }
    }));
    cases
}

fn hidden<'a>(flight: &'a FlightSketch, what: &'static str) -> Case<'a> {
    let longest = flight.occlusions().into_iter().max_by(|a, b| a.1.cmp(&b.1).then(b.0.cmp(&a.0)));
    let frames = match longest {
        Some((start, count)) => {
            let mut frames = vec![];
            frames.extend(start.checked_sub(1).map(|before| (before, "just before it is lost")));
            frames.push((start + count / 2, "lost"));
            frames
        }
        None => vec![(lowest(&flight.visible), "least visible")],
    };
    let lost = longest.map_or(String::new(), |(_, count)| format!(", lost for {:.1} s", count as f64 * flight.dt_s));
    Case { flight, what, figure: format!("{:.1} % visible{lost}", 100.0 * flight.mean_visible()), frames }
}

/// Index of the smallest number, the first of equals.
fn lowest(numbers: &[f32]) -> usize {
    let least = |a: &usize, b: &usize| numbers[*a].total_cmp(&numbers[*b]).then(a.cmp(b));
    (0..numbers.len()).min_by(least).unwrap_or(0)
}

/// The frame in the middle of the four whose third difference is the largest.
fn roughest(flight: &FlightSketch) -> usize {
    let places = &flight.drone_m;
    let jerk = |at: usize| {
        let third = |axis: usize| {
            let p = |i: usize| f64::from(places[at + i][axis]);
            p(3) - 3.0 * p(2) + 3.0 * p(1) - p(0)
        };
        [0, 1, 2].map(third).iter().map(|it| it * it).sum::<f64>()
    };
    let count = places.len().saturating_sub(3);
    (0..count).max_by(|a, b| jerk(*a).total_cmp(&jerk(*b)).then(b.cmp(a))).map_or(0, |at| at + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flight(visible: &[f32]) -> FlightSketch {
        FlightSketch {
            dt_s: 0.5,
            drone_m: vec![[0.0; 3]; visible.len()],
            feet_m: vec![[0.0; 3]; visible.len()],
            visible: visible.to_vec(),
            clearance_m: vec![2.0; visible.len()],
            box_px: vec![Some([1.0, 1.0, 4.0, 9.0]); visible.len()],
            ..FlightSketch::default()
        }
    }

    #[test]
    fn the_least_visible_flight_is_shown_where_it_loses_its_target() {
        let mut flights = Worst::default();
        flights.add(&flight(&[1.0; 6]));
        flights.add(&FlightSketch { number: 1, ..flight(&[1.0, 1.0, 0.1, 0.0, 0.2, 1.0]) });
        let cases = worst(&flights);
        assert_eq!(cases[0].flight.number, 1);
        assert_eq!(cases[0].frames, [(1, "just before it is lost"), (3, "lost")]);
        assert!(cases[0].figure.ends_with("lost for 1.5 s"), "{}", cases[0].figure);
    }

    #[test]
    fn nothing_is_shown_of_nothing() {
        assert!(worst(&Worst::default()).is_empty() && gallery(&[], 6).is_empty());
    }

    #[test]
    fn places_are_spread_evenly() {
        assert_eq!(spread(10, 2), [2, 7]);
        assert_eq!(spread(2, 5), [0, 1]);
    }
}
