//! English units, by which numbers in words are told.

use super::pauses::is_stop;
use super::turns::turn_word;
use super::words::TURN_NOUNS;

pub(crate) fn is_unit(word: &str) -> bool {
    let units = [
        "m",
        "m/s",
        "metre",
        "metres",
        "meter",
        "meters",
        "deg",
        "degree",
        "degrees",
        "second",
        "seconds",
        "time",
        "times",
        "x",
        "bends",
        "corners",
        "occasions",
    ];
    units.contains(&word)
        || TURN_NOUNS.contains(&word)
        || word.starts_with("turn")
        || is_stop(word)
        || turn_word(word).is_some()
}
