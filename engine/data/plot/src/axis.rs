//! Round marks of an axis that begins at 0.

use crate::statistics::round_step;

/// Smallest distance between marks.
const LEAST_STEP: f64 = 0.01;
/// Marks of an axis at most, without the first.
const MOST_MARKS: f64 = 6.0;
/// Largest number that an axis is made for: beyond any measurement.
const LARGEST: f64 = 1e300;
/// Marks above this are written with an exponent.
const LONG_MARK: f64 = 1e7;
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
        let highest = if highest.is_nan() { 0.0 } else { highest.clamp(0.0, LARGEST) };
        let step = round_step((highest / MOST_MARKS).max(LEAST_STEP));
        Self { step, end: step * (highest / step).ceil().max(1.0), is_cut: false }
    }

    /// The axis of some values. It is cut where few values are much larger than the others, but never below the first.
    pub fn of(values: &[f64]) -> Self {
        let (highest, is_cut) = end(values);
        Self { is_cut, ..Self::to(highest) }
    }

    /// Share of the axis at a value, 0 to 1; 0 for what is not a number.
    pub fn share(&self, value: f64) -> f64 {
        if value.is_nan() { 0.0 } else { (value / self.end).clamp(0.0, 1.0) }
    }

    /// Values of the marks: eight at most.
    pub fn marks(self) -> impl Iterator<Item = f64> {
        let last = (self.end / self.step).round().min(MOST_MARKS + 1.0) as u32;
        (0..=last).map(move |number| f64::from(number) * self.step)
    }
}

/// The number of a mark as text.
pub fn label(mark: f64) -> String {
    if mark.abs() >= LONG_MARK {
        return format!("{mark:.1e}").replace(".0e", "e");
    }
    let text = format!("{mark:.2}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn end(values: &[f64]) -> (f64, bool) {
    let known: Vec<f64> = values.iter().copied().filter(|value| !value.is_nan()).collect();
    let mut sorted = known.clone();
    sorted.sort_by(f64::total_cmp);
    let (Some(longest), Some(first)) = (sorted.last(), known.first()) else { return (0.0, false) };
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
        assert_eq!([2.0, 0.5, 0.02, 10.0, 1.5e7, 2e23].map(label), ["2", "0.5", "0.02", "10", "1.5e7", "2e23"]);
    }

    #[test]
    fn axes_of_absurd_numbers_have_few_marks_too() {
        for highest in [-1.0, 1e9, 1e16, 1e24, 1e30, 1e300, f64::MAX, f64::INFINITY, f64::NEG_INFINITY, f64::NAN] {
            let axis = Axis::of(&[1.0, highest, 2.0]);
            assert!(axis.end.is_finite() && (2..=8).contains(&axis.marks().count()), "{highest}: {axis:?}");
            assert!((0.0..=1.0).contains(&axis.share(highest)), "{highest}");
            assert!(axis.marks().all(|mark| label(mark).len() < 12), "{highest}");
        }
    }

    #[test]
    fn an_axis_is_cut_for_outliers_but_never_below_its_first_value() {
        assert_eq!(end(&[4.0, 5.0, 6.0]), (6.0, false));
        assert_eq!(end(&[4.0, 5.0, 80.0]), (12.5, true));
        assert_eq!(end(&[80.0, 5.0, 4.0]), (80.0, false));
        assert_eq!(end(&[]), (0.0, false));
    }
}
