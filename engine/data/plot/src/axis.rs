//! Round marks of an axis that begins at 0.

use crate::statistics::round_step;

/// Smallest distance between marks.
const LEAST_STEP: f64 = 0.01;
/// Marks of an axis at most, without the first.
const MOST_MARKS: f64 = 6.0;
/// Largest end of an axis, in medians of its values, so that one large value does not flatten all others.
const MOST_MEDIANS: f64 = 2.5;

/// An axis from 0 to a round end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    /// Distance between marks.
    pub step: f64,
    /// End of the axis, a multiple of `step`.
    pub end: f64,
    /// True where some values are beyond the end.
    pub is_cut: bool,
}

impl Axis {
    /// The axis that reaches `highest`.
    pub fn to(highest: f64) -> Self {
        let step = round_step((highest / MOST_MARKS).max(LEAST_STEP));
        Self { step, end: step * (highest / step).ceil().max(1.0), is_cut: false }
    }

    /// The axis of some values. It is cut where few values are much larger than the others, but never below the first.
    pub fn of(values: &[f64]) -> Self {
        let (highest, is_cut) = end(values);
        Self { is_cut, ..Self::to(highest) }
    }

    /// Share of the axis at a value, at most 1.
    pub fn share(&self, value: f64) -> f64 {
        (value / self.end).min(1.0)
    }

    /// Values of the marks.
    pub fn marks(self) -> impl Iterator<Item = f64> {
        (0..=(self.end / self.step).round() as u32).map(move |number| f64::from(number) * self.step)
    }
}

/// The number of a mark as text.
pub fn label(mark: f64) -> String {
    let text = format!("{mark:.2}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn end(values: &[f64]) -> (f64, bool) {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let (Some(longest), Some(first)) = (sorted.last(), values.first()) else { return (0.0, false) };
    let most = (MOST_MEDIANS * sorted[sorted.len() / 2]).max(*first);
    // A cut that hides little is not worth it.
    if *longest <= 1.5 * most { (*longest, false) } else { (most, true) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_have_a_few_round_marks() {
        for (highest, step, end) in
            [(0.0, 0.01, 0.01), (0.045, 0.01, 0.05), (0.55, 0.1, 0.6), (4.9, 1.0, 5.0), (37.0, 10.0, 40.0)]
        {
            let axis = Axis::to(highest);
            assert!((axis.step - step).abs() < 1e-9 && (axis.end - end).abs() < 1e-9, "{highest} {axis:?}");
        }
        assert!(Axis::to(1e30).end.is_finite());
        assert_eq!([2.0, 0.5, 0.02, 10.0].map(label), ["2", "0.5", "0.02", "10"]);
    }

    #[test]
    fn an_axis_is_cut_for_outliers_but_never_below_its_first_value() {
        assert_eq!(end(&[4.0, 5.0, 6.0]), (6.0, false));
        assert_eq!(end(&[4.0, 5.0, 80.0]), (12.5, true));
        assert_eq!(end(&[80.0, 5.0, 4.0]), (80.0, false));
        assert_eq!(end(&[]), (0.0, false));
    }
}
