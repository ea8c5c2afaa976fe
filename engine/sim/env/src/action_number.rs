//! [`ActionNumber`]: the numbers that actions are made of.

/// A number of an action: `f32` or `f64`.
pub trait ActionNumber: Copy + Into<f64> + Sync {
    /// Whether the absolute values of all numbers are at most `largest`: false where one is no number. Environments ask at every step.
    fn are_within(numbers: &[Self], largest: f64) -> bool;
}

// One for each type: this crate is compiled for speed, those that ask are compiled for size. Without branches several numbers are seen at once.
impl ActionNumber for f32 {
    fn are_within(numbers: &[Self], largest: f64) -> bool {
        let largest = largest as Self;
        numbers.iter().fold(1, |sound, number| sound & u32::from(number.abs() <= largest)) == 1
    }
}

impl ActionNumber for f64 {
    fn are_within(numbers: &[Self], largest: f64) -> bool {
        numbers.iter().fold(1, |sound, number| sound & u64::from(number.abs() <= largest)) == 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_wrong_number_among_many_is_found() {
        for wrong in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 7.5, -7.5] {
            for place in [0, 5, 63, 64, 98] {
                let mut doubles = [-7.0; 99];
                assert!(f64::are_within(&doubles, 7.0) && f32::are_within(&doubles.map(|it| it as f32), 7.0));
                doubles[place] = wrong;
                assert!(!f64::are_within(&doubles, 7.0) && !f32::are_within(&doubles.map(|it| it as f32), 7.0));
            }
        }
    }
}
