//! [`or_advice`]: no refusal of a file without a way out.

use cosfly_town::MapError;

/// The result; an error without advice gets this one.
pub fn or_advice<T>(result: Result<T, MapError>, advice: &str) -> Result<T, MapError> {
    result.map_err(|error| if error.hints.is_empty() { error.hint(advice) } else { error })
}
