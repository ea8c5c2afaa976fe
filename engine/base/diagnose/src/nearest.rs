//! The known name most similar to a mistyped one.

/// Shortest prefix that is considered, bytes; shorter ones match too many names.
const SHORTEST_PREFIX: usize = 3;

/// Name in `known` that is most similar to `given`: a few letters apart, or else the only one that begins with `given`
/// (a forgotten unit, such as `speed` for `speed_mps`). `None` where no name is similar.
pub fn nearest_name<'a>(given: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    // The cost of an edit distance grows with the product of the lengths, and a name of a thousand letters is no typing
    // error.
    if given.len() > 200 {
        return None;
    }
    let known: Vec<&str> = known.into_iter().collect();
    let most = |name: &str| (name.len().max(given.len()) / 3).max(1);
    let letters = given.chars().count();
    let nearest = known
        .iter()
        // The difference of the lengths is a lower bound of the edit distance, and far cheaper.
        .filter(|name| name.chars().count().abs_diff(letters) <= most(name))
        .map(|name| (strsim::damerau_levenshtein(given, name), *name))
        .filter(|(distance, name)| *distance <= most(name))
        .min();
    if let Some((_, name)) = nearest {
        return Some(name);
    }
    let mut longer = known.iter().filter(|name| given.len() >= SHORTEST_PREFIX && name.starts_with(given));
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
