//! Characters of foreign text, made harmless for a terminal.

/// `character`, or a visible replacement where it would control the terminal: control characters and marks that reverse
/// the direction of writing.
pub(crate) fn visible(character: char) -> char {
    match character {
        '\t' => ' ',
        '\u{0}'..='\u{1f}' => char::from_u32(0x2400 + character as u32).unwrap_or('\u{fffd}'),
        '\u{7f}'..='\u{9f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => '\u{fffd}',
        _ => character,
    }
}

/// `text` without anything that would control the terminal: what does becomes visible. For foreign text where it enters.
pub fn visible_text(text: &str) -> String {
    text.chars().map(|it| if it == '\n' { it } else { visible(it) }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_become_visible() {
        let shown: String = "a\u{1b}[31mb\u{7}\u{202e}".chars().map(visible).collect();
        assert_eq!(shown, "a\u{241b}[31mb\u{2407}\u{fffd}");
        assert_eq!(visible_text("a\u{1b}[2J\nb"), "a\u{241b}[2J\nb");
    }
}
