//! English words that look like a place and are none, and lengths that are travelled.

use super::english::colour;

/// The words without those that look like places of the drone and are none: `a shirt above blue jeans`, `it is over`, `130 m are
/// behind them`.
pub fn without_idioms(mut words: Vec<&str>) -> Vec<&str> {
    for at in 0..words.len() {
        let before = at.checked_sub(1).map_or("", |before| words[before]);
        let after = words[at + 1..].iter().take(3).any(|word| colour(word).is_some());
        let is_idiom = match words[at] {
            "above" | "over" | "under" | "below" if after => true,
            "over" => ["is", "was"].contains(&before),
            "behind" => ["are", "is"].contains(&before) && words.get(at + 1) == Some(&"them"),
            _ => false,
        };
        if is_idiom {
            words[at] = "-";
        }
    }
    words
}

/// Whether a clause has a time or a pace.
pub fn is_travelled(words: &[&str]) -> bool {
    words.iter().any(|word| ["m/s", "seconds", "second", "secs", "s"].contains(word))
}

/// Whether the next character that is no space is a digit.
pub fn number_follows(chars: &[char], from: usize) -> bool {
    chars[from..].iter().find(|c| !c.is_whitespace()).is_some_and(char::is_ascii_digit)
}
