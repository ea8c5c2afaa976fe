//! Clothes and luggage in English texts: colours, their shades, and the garment that each belongs to.

use super::garments::{SHADES, TOPS, TROUSERS};
use super::words::{LUGGAGE, NEGATIONS};
use crate::Claim;
use cosfly_domain::Colour;

const CARRIES: [&str; 7] = ["wearing", "carrying", "toting", "bearing", "clad", "laden", "wearer"];
/// Words between a colour and its garment: `a red long-sleeved cotton shirt`.
const REACH: usize = 3;
/// Words that end the reach of a colour.
const ENDS: [&str; 16] = [
    "", "and", "with", "over", "above", "below", "under", "plus", "on", "in", "or", "but", "while", "whose", "who", "-",
];

/// Clothes and luggage at a place of a clause.
pub(super) fn clothes_claim(at: usize, words: &[&str]) -> Option<Claim> {
    let (word, next) = (words[at], words.get(at + 1).copied().unwrap_or_default());
    if is_luggage(at, words) {
        let before = &words[at.saturating_sub(4)..at];
        let lacks = ["absent", "missing", "none", "nil", "nope"];
        let is_lacking = next == "off" || words[at + 1..].iter().take(3).any(|word| lacks.contains(word));
        return match is_lacking || before.iter().any(|word| NEGATIONS.contains(word) || *word == "any") {
            true => Some(Claim::NoBackpack),
            // Whether luggage of another kind is there, nobody knows.
            false => (!["luggage", "baggage"].contains(&word)).then_some(Claim::Backpack),
        };
    }
    // `a rucksack-wearing walker`
    if LUGGAGE.iter().any(|it| word.strip_prefix(it).is_some_and(|rest| CARRIES.contains(&rest))) {
        return Some(Claim::Backpack);
    }
    if word == "emptyhanded" || word == "unladen" {
        return Some(Claim::NoBackpack);
    }
    for (ending, claim) in [
        ("shirted", Claim::Top as fn(Colour) -> Claim),
        ("topped", Claim::Top),
        ("trousered", Claim::Trousers),
        ("jacketed", Claim::Top),
    ] {
        if let Some(colour) = word.strip_suffix(ending).and_then(colour) {
            return Some(claim(colour));
        }
    }
    // `the gray-shirt, brown-pants walker`
    let joined =
        TOPS.iter().chain(&TROUSERS).find_map(|it| word.strip_suffix(it).and_then(colour).zip(garment(Some(it))));
    if let Some((found, claim)) = joined {
        return Some(claim(found));
    }
    match colour(word) {
        Some(found) => Some(coloured(found, at, words, next)),
        None => shade(at, words),
    }
}

/// `top and trousers are both yellow`: the colour of both garments, where a clause names one colour.
pub(super) fn both_garments(words: &[&str], claims: &mut Vec<Claim>) {
    let is_both = words.iter().any(|word| ["both", "matching", "alike", "all"].contains(word))
        || words.windows(3).any(|it| ["head", "to", "toe"] == it);
    let has = |garments: &[&str]| words.iter().any(|word| garments.contains(word));
    let mut found = words.iter().filter_map(|word| colour(word));
    if let (true, Some(one), None) = (is_both && has(&TOPS) && has(&TROUSERS), found.next(), found.next()) {
        claims.retain(|claim| !matches!(claim, Claim::Top(_) | Claim::Trousers(_) | Claim::Wears(_)));
        claims.extend([Claim::Top(one), Claim::Trousers(one)]);
    }
}

/// A bag on the back; a `pack` is one only as a noun.
fn is_luggage(at: usize, words: &[&str]) -> bool {
    let before = at.checked_sub(1).map_or("", |before| words[before]);
    LUGGAGE.contains(&words[at])
        || words[at] == "pack" && ["on", "off"].contains(&words.get(at + 1).copied().unwrap_or_default())
        || words[at] == "pack" && ["a", "the", "no", "any", "with", "without", "their"].contains(&before)
}

/// A colour with the garment that it belongs to.
fn coloured(found: Colour, at: usize, words: &[&str], next: &str) -> Claim {
    let word = words[at];
    // `dressed in red and red`: both garments.
    if at >= 2 && words[at - 1] == "and" && words[at - 2] == word && garment(Some(&next)).is_none() {
        return Claim::Trousers(found);
    }
    if next == "and" && words.get(at + 2) == Some(&word) && garment(words.get(at + 3)).is_none() {
        return Claim::Top(found);
    }
    if next == "and"
        && let Some(other) =
            words.get(at + 2).and_then(|word| colour(word)).filter(|_| garment(words.get(at + 3)).is_some())
        && other != found
    {
        // `a black and white top`, which no garment here is.
        return Claim::Unknown(format!("{word} and {}", words[at + 2]));
    }
    match garment_of(at, words) {
        Some(claim) => claim(found),
        None => Claim::Wears(found),
    }
}

/// The garment that a colour belongs to: the next one behind it, or the one that it is said of.
fn garment_of(at: usize, words: &[&str]) -> Option<fn(Colour) -> Claim> {
    let behind = &words[(at + 1).min(words.len())..];
    let is_open = |word: &&&str| (!ENDS.contains(*word) && colour(word).is_none()) || **word == "of";
    let direct = behind.iter().take_while(is_open).take(REACH + 1).find_map(|word| garment(Some(word)));
    if direct.is_some() {
        return direct;
    }
    // `red on top, black below`
    match behind {
        ["on", "top", ..] | ["up", "top", ..] | ["above", ..] | ["upstairs", ..] => return Some(Claim::Top),
        ["below", ..] | ["underneath", ..] | ["beneath", ..] | ["downstairs", ..] | ["down", "below", ..] => {
            return Some(Claim::Trousers);
        }
        _ => {}
    }
    // `a top that is red`, `trousers in black`
    let before = words[at.saturating_sub(5)..at].iter().rev().find_map(|word| garment(Some(word)));
    let links = ["is", "are", "in", "of", "coloured", "colored", "being", "was", "were"];
    before.filter(|_| words[at.saturating_sub(3)..at].iter().any(|word| links.contains(word)))
}

/// A shade before a garment, or said of one: `navy trousers`, `a jacket in teal`.
fn shade(at: usize, words: &[&str]) -> Option<Claim> {
    let (_, colours) = SHADES.iter().find(|(name, _)| *name == words[at])?;
    // `navy blue`, `olive green` are said by the colour.
    let is_named = words.get(at + 1).is_some_and(|next| colour(next).is_some());
    let claim = garment_of(at, words).filter(|_| !is_named)?;
    let is_top = claim(colours[0]) == Claim::Top(colours[0]);
    Some(Claim::Shade { is_top, name: words[at].to_owned(), colours: colours.to_vec() })
}

/// A colour by its name, also as `reddish` or `redcoloured`.
pub fn colour(word: &str) -> Option<Colour> {
    let word =
        ["coloured", "colored", "hued", "ish"].iter().find_map(|ending| word.strip_suffix(ending)).unwrap_or(word);
    match word {
        "gray" => Some(Colour::Grey),
        "redd" => Some(Colour::Red),
        "violet" => Some(Colour::Purple),
        word => Colour::ALL.into_iter().find(|colour| colour.name() == word),
    }
}

/// A colour before a garment, and luggage.
pub fn garment_claim(word: &str, next: &str) -> Option<Claim> {
    if word == "backpack" {
        return Some(Claim::Backpack);
    }
    let colour = Colour::ALL.into_iter().find(|colour| colour.name() == word)?;
    match next {
        "top" | "shirt" | "jacket" | "coat" => Some(Claim::Top(colour)),
        "trousers" | "pants" | "jeans" => Some(Claim::Trousers(colour)),
        _ => None,
    }
}

/// Whether a word names a top or trousers.
pub(crate) fn is_garment(word: &str) -> bool {
    garment(Some(&word)).is_some()
}

fn garment(word: Option<&&str>) -> Option<fn(Colour) -> Claim> {
    match word {
        Some(word) if TOPS.contains(word) => Some(Claim::Top),
        Some(word) if TROUSERS.contains(word) => Some(Claim::Trousers),
        _ => None,
    }
}
