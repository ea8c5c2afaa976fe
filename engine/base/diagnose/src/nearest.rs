//! The nearest known name to a mistyped one.

/// Shorter beginnings fit too many names.
const SHORTEST_BEGINNING: usize = 3;

/// The name in `known` most like `given`, if any is like it at all: a few letters apart, or else the only one that
/// begins with `given` (a forgotten unit, such as `speed` for `speed_mps`).
pub fn nearest_name<'a>(given: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    // Distances grow with the product of the lengths; nobody mistypes a name of a thousand letters.
    if given.len() > 200 {
        return None;
    }
    let known: Vec<&str> = known.into_iter().collect();
    let nearest = known
        .iter()
        .map(|name| (strsim::damerau_levenshtein(given, name), *name))
        .filter(|(distance, name)| *distance <= (name.len().max(given.len()) / 3).max(1))
        .min();
    if let Some((_, name)) = nearest {
        return Some(name);
    }
    let mut longer = known.iter().filter(|name| given.len() >= SHORTEST_BEGINNING && name.starts_with(given));
    match (longer.next(), longer.next()) {
        (Some(only), None) => Some(only),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_few_letters_apart_is_near() {
        assert_eq!(nearest_name("twon", ["town", "people"]), Some("town"));
        assert_eq!(nearest_name("gps", ["town", "people"]), None);
    }

    #[test]
    fn a_forgotten_unit_is_near_when_only_one_name_begins_so() {
        assert_eq!(nearest_name("max", ["max_speed_mps", "min_speed_mps"]), Some("max_speed_mps"));
        assert_eq!(nearest_name("max", ["max_speed_mps", "max_height_m"]), None);
    }
}
