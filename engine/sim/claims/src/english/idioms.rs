//! English words that look like a place and are none, and clauses about the drone.

use super::clothes::colour;

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

/// Whether a clause speaks of the drone, its camera or how near it may come.
pub fn is_of_the_drone(words: &[&str]) -> bool {
    const WORDS: [&str; 24] = [
        "camera", "lens", "gimbal", "drone", "you", "your", "yourself", "closer", "nearer", "nearest", "closest",
        "farther", "further", "beyond", "within", "gap", "m", "metre", "metres", "meter", "meters", "aircraft",
        "degrees", "pilot",
    ];
    words.iter().any(|word| WORDS.contains(word))
}

/// `let the camera look straight ahead`
pub fn is_of_a_view(words: &[&str]) -> bool {
    let has = |such: &[&str]| words.iter().any(|word| such.contains(word));
    has(&["camera", "lens", "gimbal"]) && has(&["look", "looks", "looking", "looked", "stare", "stares", "staring"])
}

/// Whether a clause speaks of the pilot or of the room between drone and target: `do not deviate from a distance of 28 m`.
pub fn is_of_the_gap(words: &[&str]) -> bool {
    let of_the_gap = ["distance", "gap", "spacing", "pilot", "drone", "camera", "you", "separation"];
    words.iter().any(|word| of_the_gap.contains(word))
}

/// Whether `right` at a place is no side: `the right distance`, `right behind them`, `all right`.
pub fn is_right_of_no_turn(at: usize, words: &[&str]) -> bool {
    let before = at.checked_sub(1).map_or("", |before| words[before]);
    let next = words.get(at + 1).copied().unwrap_or_default();
    let is_side =
        ["turn", "turning", "hand", "bend", "corner", "swing", "one", "", "then", "and", "turns", "hander", "angle"];
    let is_place = [
        "behind", "above", "after", "away", "there", "on", "up", "over", "across", "beside", "at", "in", "from",
        "through", "to", "now", "where", "along", "about", "down", "before", "next", "off", "under", "below", "here",
        "until", "into", "with", "as", "when", "so", "if",
    ];
    match before {
        "all" | "is" | "looks" | "get" | "just" => true,
        // `a swing to the right is made`
        "the" if at > 1 && words[at - 2] == "to" => next == "of",
        "the" | "at" => !is_side.contains(&next),
        before if before.starts_with("turn") || SURE.contains(&before) => false,
        "" => is_place.contains(&next),
        before => is_place.contains(&next) || NO_SIDE_BEHIND.contains(&before) && !is_side.contains(&next),
    }
}

/// Words behind which `right` is no side.
const NO_SIDE_BEHIND: [&str; 20] = [
    "s", "are", "be", "was", "do", "doing", "got", "feels", "about", "not", "exactly", "quite", "its", "your", "that",
    "it", "them", "alright", "stay", "keep",
];

/// Words behind which `right` is a side, whatever follows.
const SURE: [&str; 14] = [
    "hang", "hangs", "bear", "bears", "veer", "veers", "veering", "bearing", "hanging", "takes", "swings", "hooks",
    "peels", "swerves",
];

/// Whether the next character that is no space is a digit.
pub fn number_follows(chars: &[char], from: usize) -> bool {
    chars[from..].iter().find(|c| !c.is_whitespace()).is_some_and(char::is_ascii_digit)
}
