//! Texts of the card with names for facts of the finished dataset, so that they stay true whatever a recipe sets.

use std::collections::BTreeMap;

/// Names that a title or a description may have in braces, with their meanings.
pub const FACTS: [(&str, &str); 6] = [
    ("towns", "names of the towns"),
    ("targets", "number of those who are followed: people, vehicles, points"),
    ("pedestrians", "the same number, where all of them are pedestrians"),
    ("flights", "number of flights"),
    ("frames", "number of frames"),
    ("minutes", "time flown, minutes"),
];

/// The first name in braces in `text` that is none of [`FACTS`].
pub fn unknown_fact(text: &str) -> Option<&str> {
    names(text).find(|name| FACTS.iter().all(|(known, _)| known != name))
}

/// `text` with `facts` instead of their names in braces.
pub fn filled(text: &str, facts: &BTreeMap<&str, String>) -> String {
    facts.iter().fold(text.to_owned(), |text, (name, fact)| text.replace(&format!("{{{name}}}"), fact))
}

/// Lower-case words in braces.
fn names(text: &str) -> impl Iterator<Item = &str> {
    let open = text.split('{').skip(1).filter_map(|rest| rest.split_once('}').map(|(name, _)| name));
    open.filter(|name| !name.is_empty() && name.bytes().all(|byte| byte.is_ascii_lowercase() || byte == b'_'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn facts_stand_where_their_names_were() {
        let facts = BTreeMap::from([("towns", "Town02".to_owned()), ("flights", "8 flights".to_owned())]);
        assert_eq!(filled("{flights} in {towns}, {towns} {x}", &facts), "8 flights in Town02, Town02 {x}");
        assert_eq!((unknown_fact("{towns} {Ab} {} {flight} {pets}"), unknown_fact("{ {")), (Some("flight"), None));
    }
}
