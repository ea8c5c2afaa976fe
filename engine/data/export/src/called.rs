//! Flights by their ids, or by patterns such as `*-front_left`: all flights that a camera filmed.

use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_read::{PublishedDataset, PublishedFlight};
use std::collections::BTreeSet;

/// The flights that are called so, each once, in the order of the names and then of the dataset. In a name, `*` stands for any letters.
///
/// # Errors
/// `dataset-no-flight`: a name that no flight has.
pub fn flights_called<'a>(dataset: &'a PublishedDataset, names: &[String]) -> Result<Vec<&'a PublishedFlight>> {
    let (mut found, mut known): (Vec<&PublishedFlight>, BTreeSet<&str>) = Default::default();
    for name in names {
        let called: Vec<&PublishedFlight> = match name.contains('*') {
            false => vec![dataset.flight(name)?],
            true => dataset.flights().iter().filter(|flight| is_like(&flight.trajectory_id, name)).collect(),
        };
        if called.is_empty() {
            let message = format!("no trajectory is like `{name}`");
            let first =
                dataset.flights().iter().take(1).map(|it| format!("; the first trajectory is `{}`", it.trajectory_id));
            let hint = format!("`*` stands for any letters{}", first.collect::<String>());
            return Err(Diagnostic::new("dataset-no-flight", Fault::Recipe, message).hint(hint));
        }
        found.extend(called.into_iter().filter(|flight| known.insert(flight.trajectory_id.as_str())));
    }
    Ok(found)
}

/// Whether a name has the parts of a pattern between its `*`, one after the other.
fn is_like(name: &str, pattern: &str) -> bool {
    let mut parts = pattern.split('*');
    let Some(mut rest) = parts.next().and_then(|first| name.strip_prefix(first)) else { return false };
    let Some(last) = parts.next_back() else { return rest.is_empty() };
    for part in parts {
        let Some(at) = rest.find(part) else { return false };
        rest = &rest[at + part.len()..];
    }
    rest.ends_with(last)
}

#[cfg(test)]
mod tests {
    use super::is_like;

    #[test]
    fn stars_stand_for_any_letters() {
        for pattern in ["*", "expert-*", "*-left", "expert-p00000-left", "e*p*left", "expert-p*", "**"] {
            assert!(is_like("expert-p00000-left", pattern), "{pattern}");
        }
        for pattern in ["", "expert", "*-right", "left*", "expert-p00000-left-*left", "e*x*x*left"] {
            assert!(!is_like("expert-p00000-left", pattern), "{pattern}");
        }
        assert!(!is_like("ab", "ab*b") && is_like("abb", "ab*b"));
    }
}
