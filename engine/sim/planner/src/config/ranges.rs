//! Checks of parameters: within a range, and in order.

/// Path of a parameter, its value, and the lowest and highest value that it may have.
pub(super) type Range = (&'static str, f64, f64, f64);

/// Path of a parameter, and the rule that it breaks.
pub type RangeRefusal = (String, String);

/// Refuses a value out of range, or one that is not a number.
///
/// # Errors
/// The path, and the rule that it breaks.
pub fn in_range(path: &str, value: f64, low: f64, high: f64) -> Result<(), RangeRefusal> {
    if value >= low && value <= high {
        return Ok(());
    }
    Err((path.to_owned(), format!("`{path}` is {value}; it must be between {low} and {high}")))
}

/// Refuses a lower end (path and value) that is above the upper end.
pub(super) fn ordered(low: (&str, f64), high: (&str, f64)) -> Result<(), RangeRefusal> {
    if low.1 <= high.1 {
        return Ok(());
    }
    let rule = format!("`{}` is {}; it must not be above `{}`, which is {}", low.0, low.1, high.0, high.1);
    Err((low.0.to_owned(), rule))
}
