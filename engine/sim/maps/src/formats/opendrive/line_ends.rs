//! [`LineFree`]: ground around crossings where no lane line is painted.

use cosfly_frames::DVec2;
use cosfly_town::polygons::PolygonIndex;

/// Distance of the places along a line that are looked at, and the accuracy of the line's ends, metres.
const STEP_M: f64 = 0.25;
const MOST_STEPS: f64 = 4000.0;
const ACCURACY_M: f64 = 0.01;
/// Shorter pieces of lines are left out, metres.
const SHORTEST_M: f64 = 0.5;

/// Outlines in plan within which there are no lane lines.
#[derive(Debug)]
pub(super) struct LineFree {
    outlines: PolygonIndex,
}

impl Default for LineFree {
    fn default() -> Self {
        Self::within(vec![])
    }
}

impl LineFree {
    pub(super) fn within(outlines: Vec<Vec<DVec2>>) -> Self {
        Self { outlines: PolygonIndex::new(outlines) }
    }

    /// The pieces of a painted stretch that are free; `at` gives the place in plan of a station.
    pub(super) fn pieces(&self, [from_s_m, to_s_m]: [f64; 2], at: impl Fn(f64) -> DVec2) -> Vec<[f64; 2]> {
        if self.outlines.outlines().is_empty() {
            return vec![[from_s_m, to_s_m]];
        }
        let is_free = |s_m: f64| self.outlines.at(at(s_m)).next().is_none();
        let steps = ((to_s_m - from_s_m) / STEP_M).ceil().clamp(1.0, MOST_STEPS) as usize;
        let station = |step: usize| from_s_m + (to_s_m - from_s_m) * (step as f64 / steps as f64);
        let (mut pieces, mut start) = (vec![], is_free(from_s_m).then_some(from_s_m));
        for step in 1..=steps {
            match (start, is_free(station(step))) {
                (Some(begin), false) => {
                    pieces.push([begin, change(station(step - 1), station(step), &is_free)]);
                    start = None;
                }
                (None, true) => start = Some(change(station(step), station(step - 1), &is_free)),
                (Some(_), true) | (None, false) => {}
            }
        }
        pieces.extend(start.map(|begin| [begin, to_s_m]));
        let is_whole = pieces == [[from_s_m, to_s_m]];
        pieces.retain(|[begin, end]| is_whole || end - begin >= SHORTEST_M);
        pieces
    }
}

/// The last free station from a free one towards one that is not.
fn change(mut free_s_m: f64, mut taken_s_m: f64, is_free: &impl Fn(f64) -> bool) -> f64 {
    while (free_s_m - taken_s_m).abs() > ACCURACY_M {
        let middle_s_m = 0.5 * (free_s_m + taken_s_m);
        *(if is_free(middle_s_m) { &mut free_s_m } else { &mut taken_s_m }) = middle_s_m;
    }
    free_s_m
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_ends_before_a_crossing_and_goes_on_behind_it() {
        let outline = [[10.0, -3.0], [14.0, -3.0], [14.0, 3.0], [10.0, 3.0]].map(DVec2::from).to_vec();
        let free = LineFree::within(vec![outline]);
        let pieces = |from: f64, to: f64, y: f64| free.pieces([from, to], |s_m| DVec2::new(s_m, y));
        let [before, behind] = pieces(2.0, 20.0, 1.0)[..] else { panic!("two pieces") };
        assert!(before[0] == 2.0 && (before[1] - 10.0).abs() < 0.02, "{before:?}");
        assert!((behind[0] - 14.0).abs() < 0.02 && behind[1] == 20.0, "{behind:?}");
        assert_eq!(pieces(2.0, 20.0, 4.0), [[2.0, 20.0]], "beside the crossing");
        assert!(pieces(9.8, 13.0, 0.0).is_empty(), "a rest of 0.2 m is no line");
    }
}
