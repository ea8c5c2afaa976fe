//! Choices of words, and numbers rounded for people.

use cosfly_random::RandomStream;

/// Templates per style and language.
pub(crate) const TEMPLATES: usize = 6;

/// One of several wordings.
pub(crate) fn one_of<'a>(words: &mut RandomStream, choices: &[&'a str]) -> &'a str {
    choices[words.index(choices.len())]
}

/// `value` rounded to a multiple of `step`, without needless decimals.
pub(crate) fn rounded(value: f64, step: f64) -> String {
    let steps = (value / step).round();
    if step < 1.0 { format!("{:.1}", steps * step) } else { format!("{:.0}", steps * step + 0.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_rounded_for_people() {
        for (value, step, expected) in
            [(28.284, 1.0, "28"), (1.3401, 0.1, "1.3"), (99.5, 5.0, "100"), (133.0, 10.0, "130"), (-0.2, 1.0, "0")]
        {
            assert_eq!(rounded(value, step), expected);
        }
    }
}
