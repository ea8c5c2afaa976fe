//! The rule for numbers that come from outside: finite, and of a size that a metre, second or degree can have.

use std::fmt;

/// The largest magnitude of a number from outside, in its own unit (metres, metres per second, seconds, degrees): 1e9.
///
/// Every door has this rule: recipes, tables, predictions, actions, tracks, maps, plugins. A door may be narrower.
pub const LARGEST_MAGNITUDE: f64 = 1e9;

/// The fault of a number that no measurement can have. Displays as the end of a sentence: "is not a number".
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Implausible {
    /// NaN.
    NotANumber,
    /// Positive or negative infinity.
    Infinite,
    /// Finite, and larger in magnitude than [`LARGEST_MAGNITUDE`].
    TooLarge,
}

impl fmt::Display for Implausible {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NotANumber => "is not a number",
            Self::Infinite => "is infinite",
            Self::TooLarge => "is larger than 1e9 in magnitude",
        })
    }
}

/// `value` when it is plausible, else its fault.
pub fn plausible(value: f64) -> Result<f64, Implausible> {
    match value.abs() {
        magnitude if magnitude <= LARGEST_MAGNITUDE => Ok(value),
        magnitude if magnitude.is_nan() => Err(Implausible::NotANumber),
        magnitude if magnitude.is_infinite() => Err(Implausible::Infinite),
        _ => Err(Implausible::TooLarge),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_beyond_any_measurement_are_faults() {
        for value in [0.0, -0.0, 1e-300, LARGEST_MAGNITUDE, -LARGEST_MAGNITUDE] {
            assert_eq!(plausible(value), Ok(value));
        }
        assert_eq!(plausible(f64::NAN), Err(Implausible::NotANumber));
        assert_eq!(plausible(f64::NEG_INFINITY), Err(Implausible::Infinite));
        for value in [1e23, -1e10, f64::MAX] {
            assert_eq!(plausible(value), Err(Implausible::TooLarge), "{value}");
        }
        assert_eq!(plausible(1e23).unwrap_err().to_string(), "is larger than 1e9 in magnitude");
    }
}
