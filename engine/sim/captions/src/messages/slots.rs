//! Slots of a text: `{name}`.

/// A text with its slots filled; a slot without a value waits for a later call.
pub(crate) fn fill(text: &str, values: &[(&str, &str)]) -> String {
    let mut filled = String::with_capacity(2 * text.len());
    let mut rest = text;
    while let Some((before, behind)) = rest.split_once('{') {
        filled += before;
        let value = behind
            .split_once('}')
            .and_then(|(slot, after)| values.iter().find(|(name, _)| *name == slot).map(|(_, value)| (*value, after)));
        match value {
            Some((value, after)) => {
                filled += value;
                rest = after;
            }
            None => {
                filled.push('{');
                rest = behind;
            }
        }
    }
    filled + rest
}

/// The text with a capital first letter.
pub(crate) fn capital(text: &str) -> String {
    let mut chars = text.chars();
    chars.next().map_or_else(String::new, |first| first.to_uppercase().chain(chars).collect())
}
