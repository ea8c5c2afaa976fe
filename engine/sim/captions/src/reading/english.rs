//! Reads English texts: words and numbers, clause by clause.

use super::english_clothes::{clothes_claim, colour};
use super::english_idioms::{is_of_the_drone, is_right_of_no_turn, number_follows, without_idioms};
use super::english_numbers::fold_numbers;
use super::english_words::{
    DOWN_STEMS, DURATION_WORDS, GOES_ON, LUGGAGE, MOTION, NEGATIONS, STANDS, STOP_STEMS, STOP_WORDS, STRONG_ALTITUDE,
    STRONG_DISTANCE, STRONG_WAY, TURN_NOUNS, TURN_STEMS, UNPAUSED, UNTURNED, UP_STEMS,
};
use super::{Claim, count, sentences, stands_for};
use crate::compass::Compass;
use crate::turns::TurnKind;

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Token {
    Word(String),
    Number(f64),
}

/// Everything that the text claims, in order.
pub fn read(text: &str) -> Vec<Claim> {
    let sentence = |sentence: &str| {
        let mut after_stop = false;
        let parts = clauses(sentence);
        // `Right, here is the shot`: a word of its own that begins a sentence is no side.
        let begins = |clause: &[Token]| matches!(clause, [Token::Word(word)] if word == "right");
        let is_call = parts.first().is_some_and(|it| begins(it))
            && parts
                .get(1)
                .and_then(|it| it.first())
                .is_some_and(|it| !["then", "left", "right", "and", "next"].contains(&word_of(it)));
        let read = |clause: Vec<Token>| {
            let tokens = fold_numbers(clause);
            let claims = read_clause(&tokens, after_stop);
            after_stop = tokens.iter().any(|token| is_stop(word_of(token)));
            claims
        };
        parts.into_iter().skip(usize::from(is_call)).flat_map(read).collect::<Vec<_>>()
    };
    sentences(text).into_iter().flat_map(sentence).collect()
}

/// Lower-case tokens, parted at punctuation.
pub(crate) fn clauses(text: &str) -> Vec<Vec<Token>> {
    let chars: Vec<char> = text.to_lowercase().chars().collect();
    let mut clauses = vec![vec![]];
    let mut i = 0;
    while i < chars.len() {
        let start = i;
        let clause = clauses.last_mut().expect("there is always one clause");
        if chars[i].is_ascii_digit() {
            while i < chars.len() && (chars[i].is_ascii_digit() || decimal_point(&chars, i)) {
                i += 1;
            }
            let digits: String = chars[start..i].iter().collect();
            let negative =
                start > 0 && matches!(chars[start - 1], '-' | '\u{2212}') && (start < 2 || chars[start - 2] == ' ');
            let value: f64 = digits.parse().unwrap_or(f64::NAN);
            clause.push(Token::Number(if negative { -value } else { value }));
        } else if chars[i].is_alphabetic() {
            // A slash joins units (m/s), a hyphen compass words (north-east).
            while i < chars.len()
                && (chars[i].is_alphabetic() || (matches!(chars[i], '/' | '-') && letter(&chars, i + 1)))
            {
                i += 1;
            }
            let word: String = chars[start..i].iter().filter(|c| **c != '-').collect();
            clause.push(Token::Word(word));
        } else {
            match chars[i] {
                '°' => clause.push(Token::Word("degrees".into())),
                '%' => clause.push(Token::Word("percent".into())),
                // `Length: 130 m` is one statement.
                ':' if number_follows(&chars, i + 1) => {}
                // `coat: red`
                ':' if colour_follows(&chars, i + 1) => clause.push(Token::Word("is".into())),
                ',' | ';' | ':' | '.' | '!' | '?' | '(' | ')' | '\n' => clauses.push(vec![]),
                _ => {}
            }
            i += 1;
        }
    }
    clauses
}

fn colour_follows(chars: &[char], from: usize) -> bool {
    let word: String = chars[from..].iter().skip_while(|c| **c == ' ').take_while(|c| c.is_alphabetic()).collect();
    colour(&word).is_some()
}

fn decimal_point(chars: &[char], at: usize) -> bool {
    chars[at] == '.' && chars.get(at + 1).is_some_and(char::is_ascii_digit)
}

fn letter(chars: &[char], at: usize) -> bool {
    chars.get(at).is_some_and(|c| c.is_alphabetic())
}

fn read_clause(tokens: &[Token], after_stop: bool) -> Vec<Claim> {
    let words = seen_from(without_idioms(tokens.iter().map(word_of).collect()));
    let drone_lingers =
        words.iter().any(|it| ["aircraft", "drone", "craft", "quadcopter", "uav", "copter", "you"].contains(it))
            && !words.iter().any(|it| it.starts_with("second") || ["times", "once", "twice"].contains(it));
    let about_stops = !drone_lingers && words.iter().any(|word| is_stop(word)) || stands_repeatedly(&words);
    // `They pause once, for about 3 seconds`: the time belongs to the stop.
    let sums = || {
        words.iter().any(|word| ["altogether", "together", "total", "all", "told", "standing", "sum"].contains(word))
    };
    let goes_on = after_stop
        && !about_stops
        && (words.first().is_some_and(|word| GOES_ON.contains(word)) || sums() || is_time_alone(&words));
    let mut claims = vec![];
    let mut turns: Vec<(usize, TurnKind)> = vec![];
    for (i, token) in tokens.iter().enumerate() {
        let next = words.get(i + 1).copied().unwrap_or_default();
        match token {
            Token::Number(value) => claims.extend(quantity(*value, i, &words, about_stops || goes_on)),
            Token::Word(word) => {
                if let Some(value) = number_word(word).filter(|_| is_unit(next)) {
                    claims.extend(quantity(value, i, &words, about_stops || goes_on));
                    continue;
                }
                let counted = i > 0 && matches!(&tokens[i - 1], Token::Number(_));
                let claim = clothes_claim(i, &words).or_else(|| word_claim(i, &words, counted, about_stops));
                let is_again = claim == Some(Claim::Turn(TurnKind::Around))
                    && turns.last().is_some_and(|it| it.1 == TurnKind::Around);
                if is_again {
                    // A turn around in two words is one.
                } else if let Some(Claim::Turn(kind)) = claim {
                    let times = repetitions(&tokens[i + 1..]);
                    turns.push((i, kind));
                    claims.extend(core::iter::repeat_n(Claim::Turn(kind), times));
                } else {
                    claims.extend(claim);
                }
            }
        }
    }
    if goes_on {
        claims.retain(|claim| *claim != Claim::Stays);
    } else if !about_stops && denies_motion(&words) {
        claims.push(Claim::Stays);
    }
    // `turns left after turning right` says the later turn first.
    if let [(first, one), (second, other)] = turns[..]
        && (words[first..second].contains(&"after")
            || words[first..second].windows(2).any(|it| it[0].starts_with("preced") && it[1] == "by"))
    {
        let listed = |claim: &Claim| matches!(claim, Claim::Turn(_));
        let places: Vec<usize> = (0..claims.len()).filter(|at| listed(&claims[*at])).collect();
        if let [a, b] = places[..] {
            (claims[a], claims[b]) = (Claim::Turn(other), Claim::Turn(one));
        }
    }
    claims.extend(order_of_stop_and_turn(&words, &turns));
    pauses_denied(&words, about_stops, &mut claims);
    if denied(&words, is_turning) || words.iter().any(|word| UNTURNED.contains(word)) {
        claims.retain(|claim| !matches!(claim, Claim::Turn(_) | Claim::Turns(_) | Claim::TurnsOf(..)));
        claims.push(Claim::NoTurns);
    } else if keeps_direction(&words) {
        claims.push(Claim::Straight);
    }
    stands_for(claims)
}

/// No pauses, or some.
fn pauses_denied(words: &[&str], about_stops: bool, claims: &mut Vec<Claim>) {
    // `keeps moving throughout`, `in one go`
    let has = |run: &[&str]| words.windows(run.len()).any(|it| it == run);
    let goes_on = UNPAUSED.iter().any(|it| words.contains(it))
        || [["one", "go"], ["without", "letup"], ["without", "cease"], ["all", "go"], ["single", "go"]]
            .iter()
            .any(|it| has(it))
        || (words.windows(2).any(|it| it[0].starts_with("keep") && ["moving", "walking", "going"].contains(&it[1]))
            && words.iter().any(|it| ["throughout", "whole", "entire", "always", "constantly", "all"].contains(it)));
    let rests = |word: &str| is_stop(word) || word == "rest";
    if goes_on || denied(words, rests) && !has(&["the", "rest"]) {
        claims.retain(|claim| !matches!(claim, Claim::Stops(_)));
        claims.push(Claim::Stops(0));
    } else if about_stops && !claims.iter().any(|claim| matches!(claim, Claim::Stops(_))) {
        claims.push(Claim::SomeStops);
    }
}

/// `does not move`, `without taking a step`, `goes nowhere`; a drone that shall not go nearer is none of that.
fn denies_motion(words: &[&str]) -> bool {
    let is_of_place =
        || words.iter().any(|it| ["spot", "place", "anywhere", "position", "muscle", "foot"].contains(it));
    let of = |word: &str| match word {
        "leave" | "leaves" | "leaving" | "go" | "goes" | "going" | "shift" => is_of_place(),
        word => MOTION.contains(&word) || ["mov", "stir", "budg"].iter().any(|stem| word.starts_with(stem)),
    };
    let near = |at: usize| if words[at].starts_with("walk") { 2 } else { 5 };
    let is_denied = |at: &usize| {
        let before = &words[at.saturating_sub(near(*at))..*at];
        before.iter().rposition(|it| NEGATIONS.contains(it)).is_some_and(|from| !is_parted(&before[from..]))
    };
    let nowhere = words.contains(&"nowhere") && words.iter().any(|it| MOTION.contains(it));
    nowhere || !is_of_the_drone(words) && (0..words.len()).filter(|at| of(words[*at])).any(|at| is_denied(&at))
}

/// `holds the same heading`, `straight on`: a direction that does not change.
fn keeps_direction(words: &[&str]) -> bool {
    let same =
        ["same", "one", "single", "constant", "fixed", "unchanged", "unchanging", "consistent", "steady", "unaltered"];
    let way = ["direction", "heading", "course", "bearing", "line"];
    let is_same = || words.iter().any(|it| same.contains(it));
    !is_of_the_drone(words) && words.iter().any(|it| way.contains(it)) && is_same()
        || denied(words, |word| matches!(word, "direction" | "course" | "heading"))
            && words
                .iter()
                .any(|it| ["change", "changes", "changing", "alter", "alters", "altering", "switch"].contains(it))
}

/// Whether a word speaks of leaving a straight line.
fn is_turning(word: &str) -> bool {
    TURN_STEMS.iter().any(|stem| word.starts_with(stem)) && !["turned", "cornered"].contains(&word)
        || ["uturn", "uturns", "aboutturn"].contains(&word)
}

/// Whether a word speaks of pauses, turns or motion.
pub(crate) fn is_of_a_walk(word: &str) -> bool {
    is_stop(word) || is_turning(word) || MOTION.contains(&word)
}

/// Whether a denial ends before the word behind these words: `does not stop before it turns`.
fn is_parted(between: &[&str]) -> bool {
    between.iter().any(|it| ["before", "until", "till", "but", "then", "after", "when", "just"].contains(it))
        || between.iter().any(|word| LUGGAGE.contains(word))
}

/// A camera that looks from above looks down.
fn seen_from(mut words: Vec<&str>) -> Vec<&str> {
    for at in 1..words.len() {
        match (words[at - 1], words[at]) {
            ("from", "above" | "overhead") => words[at] = "downward",
            ("from", "below" | "beneath") => words[at] = "upward",
            _ => {}
        }
    }
    words
}

/// `one pause, about 3 seconds long`: a time in a clause of its own.
fn is_time_alone(words: &[&str]) -> bool {
    let is_time = |word: &&str| word.starts_with("second");
    words.len() <= 5 && words.iter().any(is_time) && !words.iter().any(|word| DURATION_WORDS.contains(word))
}

/// `stands still twice`: two stops.
fn stands_repeatedly(words: &[&str]) -> bool {
    let is_stand = |word: &&str| ["stand", "stands", "standing", "still", "stood"].contains(word);
    let is_count = |word: &&str| ["once", "twice", "thrice", "times"].contains(word);
    (0..words.len()).any(|at| is_stand(&words[at]) && words[at + 1..].iter().take(3).any(is_count))
}

/// Whether a negation comes a few words before such a word.
fn denied(words: &[&str], is_such: impl Fn(&str) -> bool) -> bool {
    (0..words.len()).filter(|at| is_such(words[*at])).any(|at| {
        // `never once does the walker stop`: what is denied ends the clause.
        let is_inverted = words[..at].iter().any(|it| ["does", "do", "did"].contains(it));
        let before = &words[at.saturating_sub(if is_inverted { 9 } else { 4 })..at];
        let negation = before.iter().rposition(|word| NEGATIONS.contains(word));
        negation.is_some_and(|from| !is_parted(&before[from..]))
    })
}

/// Numbers have no word.
pub fn word_of(token: &Token) -> &str {
    match token {
        Token::Word(word) => word,
        Token::Number(_) => "",
    }
}

/// `stops before turning left`, `turns left after a stop`.
fn order_of_stop_and_turn(words: &[&str], turns: &[(usize, TurnKind)]) -> Option<Claim> {
    let stop = words.iter().position(|word| is_stop(word))?;
    let (turn, _) = *turns.first()?;
    let between = &words[stop.min(turn)..stop.max(turn)];
    let stop_first = match () {
        () if between.contains(&"before") => stop < turn,
        () if between.contains(&"after") => stop > turn,
        () if between.contains(&"then") => stop < turn,
        () => return None,
    };
    Some(Claim::StopFirst(stop_first))
}

/// The list of beginnings that has the word nearest to place `at`, by its number; of equally near ones the word behind counts.
fn nearest(words: &[&str], at: usize, lists: &[&[&str]]) -> Option<usize> {
    let places = (0..words.len()).filter(|place| *place != at);
    let of = |word: &str| lists.iter().position(|list| list.iter().any(|stem| word.starts_with(stem)));
    let found = places.filter_map(|place| Some((place.abs_diff(at), place < at, of(words[place])?)));
    found.min().map(|(_, _, list)| list)
}

/// How often the turn before these tokens is made: `twice`, `three times`, or once.
fn repetitions(after: &[Token]) -> usize {
    match after {
        [Token::Word(word), ..] if word == "twice" => 2,
        [Token::Word(turn), Token::Word(word), ..] if turn.starts_with("turn") && word == "twice" => 2,
        [Token::Word(number), Token::Word(times), ..] if times == "times" => {
            number_word(number).map_or(1, |number| number as usize)
        }
        [Token::Number(number), Token::Word(times), ..] if times == "times" => *number as usize,
        _ => 1,
    }
}

/// The claim of a number at a place, with the word after it, in its clause.
fn quantity(value: f64, at: usize, words: &[&str], about_stops: bool) -> Option<Claim> {
    // `two short stops`, `3 different times`: the unit may stand behind an adjective or two.
    let units = (at + 1..words.len()).take(3).take_while(|it| !words[*it].is_empty());
    let is_known =
        |it: &usize| is_unit(words[*it]) || ["s", "sec", "secs", "deg", "km/h", "kmh", "kph"].contains(&words[*it]);
    let skipped = units.into_iter().find(is_known).map_or(0, |it| it - at - 1);
    let at = at + skipped;
    let unit = words.get(at + 1).copied().unwrap_or_default();
    let after = |offset: usize| words.get(at + offset).copied().unwrap_or_default();
    let is_metres = matches!(unit, "m" | "metre" | "metres" | "meter" | "meters");
    if unit == "m/s"
        || (is_metres && ["per", "a", "each", "every"].contains(&after(2)) && after(3).starts_with("second"))
    {
        return Some(Claim::Speed(value));
    }
    Some(match unit {
        _ if is_metres && value < 0.0 => Claim::Unknown(format!("{value} {unit}")),
        _ if is_metres => length(value, at, words),
        "km/h" | "kmh" | "kph" => Claim::Speed((value / 0.36).round() / 10.0),
        "degree" | "degrees" | "deg" => match nearest(words, at, &[&UP_STEMS, &DOWN_STEMS]) {
            Some(0) => Claim::Pitch(-value),
            None => Claim::Tilt(value),
            _ => Claim::Pitch(value),
        },
        "s" | "sec" | "secs" | "second" | "seconds" => {
            let walks = words.iter().any(|word| DURATION_WORDS.contains(word));
            let stops = words.iter().any(|word| is_stop(word));
            match (stops, walks) {
                (true, false) => Claim::Standing(value),
                (false, true) if !about_stops => Claim::Duration(value),
                _ => Claim::Seconds(value),
            }
        }
        "time" | "times" | "occasion" | "occasions" if about_stops => count(value, unit, Claim::Stops),
        // Repetitions of a turn, which the turn's own claims contain.
        "time" | "times" if words.iter().any(|word| turn_word(word).is_some()) => return None,
        "time" | "times" | "occasion" | "occasions" if words.iter().any(|word| is_turning(word)) => {
            count(value, unit, Claim::Turns)
        }
        "time" | "times" | "occasion" | "occasions" => count(value, unit, Claim::Times),
        turns if TURN_NOUNS.contains(&turns) && !SIDES.contains(&after(2)) => count(value, unit, Claim::Turns),
        stop if is_stop(stop) => count(value, unit, Claim::Stops),
        side => match turn_word(side) {
            Some(kind) => count(value, unit, |count| Claim::TurnsOf(kind, count)),
            None => Claim::Unknown(format!("{value} {unit}").trim_end().to_owned()),
        },
    })
}

/// The claim of a length: of one place where a word beyond doubt is near and none of another place is in the clause.
fn length(value: f64, at: usize, words: &[&str]) -> Claim {
    if value.fract() != 0.0 && words.contains(&"second") {
        return Claim::Speed(value);
    }
    // With a time or a pace beside it, a length may be the way, whatever else is near.
    if words.iter().any(|it| ["m/s", "seconds", "secs", "s"].contains(it))
        && !words.iter().any(|it| STRONG_WAY.contains(it))
    {
        return Claim::Metres(value);
    }
    let lists: [&[&str]; 3] = [&STRONG_ALTITUDE, &STRONG_WAY, &STRONG_DISTANCE];
    let near =
        |list: &&[&str]| (0..words.len()).filter(|it| list.contains(&words[*it])).map(|it| it.abs_diff(at)).min();
    let [altitude, way, distance] = [near(&lists[0]), near(&lists[1]), near(&lists[2])];
    let is_near = |cue: Option<usize>| cue.is_some_and(|far| far <= STRONG_REACH);
    match (altitude, way, distance) {
        (Some(_), None, None) if is_near(altitude) => Claim::Altitude(value),
        (None, Some(_), None) if is_near(way) => Claim::Way(value),
        (None, None, Some(_)) if is_near(distance) => Claim::Distance(value),
        _ => Claim::Metres(value),
    }
}

/// Words between a length and a word that says beyond doubt what it is.
const STRONG_REACH: usize = 7;
/// Words of sides, behind which `turn` counts none.
const SIDES: [&str; 4] = ["left", "right", "around", "round"];

fn word_claim(at: usize, words: &[&str], counted: bool, about_stops: bool) -> Option<Claim> {
    let (word, next) = (words[at], words.get(at + 1).copied().unwrap_or_default());
    let before = at.checked_sub(1).map_or("", |before| words[before]);
    // `right behind`, `around 25 m` are no turns.
    let is_idiom = match word {
        "right" => is_right_of_no_turn(at, words),
        "around" | "round" => {
            let is_amount =
                words.get(at + 1) == Some(&"") && !words.get(at + 2).is_some_and(|it| it.starts_with("time"));
            let turns = [
                "turns", "turn", "turning", "turned", "then", "", "wheels", "spins", "swings", "next", "later",
                "finally",
            ];
            is_amount || !turns.contains(&before)
        }
        "left" => ["is", "are", "has", "be", "have", "had", "they", "them", "nothing"].contains(&before),
        _ => false,
    };
    // `turning neither left nor right`
    if matches!(word, "left" | "right")
        && (["neither", "nor", "not"].contains(&before) || at > 1 && before == "or" && words.contains(&"neither"))
    {
        return Some(Claim::NoTurns);
    }
    let turn = turn_word(word).filter(|_| !counted && !is_idiom).map(Claim::Turn);
    let back = turns_back(at, words)
        || matches!(
            word,
            "reverses"
                | "backtracks"
                | "backtrack"
                | "backtracking"
                | "aboutturn"
                | "aboutface"
                | "aboutturns"
                | "volteface"
                | "turnaround"
                | "turnabout"
                | "retraces"
                | "retracing"
                | "reversal"
                | "oneeighty"
        );
    turn.or_else(|| back.then_some(Claim::Turn(TurnKind::Around)))
        .or_else(|| compass_word(word).map(Claim::Direction))
        .or(match word {
            "straight" if !STRAIGHT_AT.contains(&next) => Some(Claim::Straight),
            "still" if !["walks", "walking", "keeps", "keep", "moving"].contains(&next) && !about_stops => {
                Some(Claim::Stays)
            }
            "stand" if is_of_the_drone(words) => None,
            "stand" | "stands" | "standing" | "stood" if !["out", "off", "back"].contains(&next) && !about_stops => {
                Some(Claim::Stays)
            }
            standing if STANDS.contains(&standing) && !about_stops => Some(Claim::Stays),
            "stays" | "stay" | "remains" | "remain" | "staying" | "remaining" | "keeps" | "stayed" | "remained"
            | "glued" | "fixed" | "stuck" | "pinned" | "nailed" | "frozen"
                if !is_of_the_drone(words)
                    && (["put", "where"].contains(&next)
                        || (["in", "on", "at", "to"].contains(&next)
                            && ["place", "spot", "position", "rooted"].iter().any(|it| words.contains(it)))) =>
            {
                Some(Claim::Stays)
            }
            "once" if about_stops => Some(Claim::Stops(1)),
            "single" if is_stop(next) => Some(Claim::Stops(1)),
            "once" if is_turning(before) => Some(Claim::Turns(1)),
            "twice" if is_turning(before) => Some(Claim::Turns(2)),
            "thrice" if is_turning(before) => Some(Claim::Turns(3)),
            "twice" if about_stops && turn_word(before).is_none() => Some(Claim::Stops(2)),
            "thrice" if about_stops => Some(Claim::Stops(3)),
            _ => None,
        })
}

/// Words behind which `straight` is no way of walking.
const STRAIGHT_AT: [&str; 14] =
    ["down", "at", "above", "up", "away", "behind", "after", "back", "from", "into", "to", "answer", "legs", "face"];

/// `turns tail`, `doubles back`, `head back the other way`
fn turns_back(at: usize, words: &[&str]) -> bool {
    let before = at.checked_sub(1).map_or("", |before| words[before]);
    let next = words.get(at + 1).copied().unwrap_or_default();
    let is_of = |stems: &[&str]| stems.iter().any(|stem| before.starts_with(stem));
    match words[at] {
        "round" | "tail" => is_of(&["turn", "spin", "wheel", "swing", "swivel"]),
        "back"
            if is_of(&[
                "turn", "doubl", "head", "go", "goes", "walk", "com", "track", "trek", "start", "set", "circl", "loop",
            ]) =>
        {
            let is_way = || words[at..].iter().any(|it| ["way", "came", "themselves"].contains(it));
            !["to", "left", "right", "from", "of", "at"].contains(&next) && (next != "the" || is_way())
        }
        "way" => before == "other" && !words[..at].contains(&"back"),
        _ => false,
    }
}

fn compass_word(word: &str) -> Option<Compass> {
    let stem = ["wards", "ward", "bound", "facing", "erly", "ern"]
        .iter()
        .find_map(|ending| word.strip_suffix(ending))
        .unwrap_or(word);
    Some(match stem {
        "east" => Compass::East,
        "southeast" => Compass::Southeast,
        "south" => Compass::South,
        "southwest" => Compass::Southwest,
        "west" => Compass::West,
        "northwest" => Compass::Northwest,
        "north" => Compass::North,
        "northeast" => Compass::Northeast,
        _ => return None,
    })
}

fn turn_word(word: &str) -> Option<TurnKind> {
    match word {
        "left" | "leftward" | "leftwards" | "lefts" | "lefthand" => Some(TurnKind::Left),
        "right" | "rightward" | "rightwards" | "rights" | "righthand" => Some(TurnKind::Right),
        "around" | "uturn" | "uturns" => Some(TurnKind::Around),
        _ => None,
    }
}

/// A pause, as verb or noun, and what keeps somebody from walking on.
fn is_stop(word: &str) -> bool {
    (STOP_STEMS.iter().any(|stem| word.starts_with(stem)) && !["tarred", "stopwatch"].contains(&word))
        || STOP_WORDS.contains(&word)
}

pub fn is_unit(word: &str) -> bool {
    let units = [
        "m",
        "m/s",
        "metre",
        "metres",
        "meter",
        "meters",
        "degree",
        "degrees",
        "second",
        "seconds",
        "time",
        "times",
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

pub(crate) fn number_word(word: &str) -> Option<f64> {
    let words = ["zero", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten"];
    words.iter().position(|known| *known == word).map(|value| value as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_render::Colour;

    #[test]
    fn sentences_in_other_words_are_read() {
        for (text, expected) in [
            (
                "Please pursue the northbound walker, 25 metres behind and 45° down.",
                vec![Claim::Direction(Compass::North), Claim::Distance(25.0), Claim::Pitch(45.0)],
            ),
            ("It pauses twice, never turns.", vec![Claim::Stops(2), Claim::NoTurns]),
            ("No stops; two turns", vec![Claim::Stops(0), Claim::Turns(2)]),
            ("They stop three times", vec![Claim::Stops(3)]),
            ("They stop", vec![Claim::SomeStops]),
            ("Go south-east at 1.4 m/s.", vec![Claim::Direction(Compass::Southeast), Claim::Speed(1.4)]),
            ("turns left, then right", vec![Claim::Turn(TurnKind::Left), Claim::Turn(TurnKind::Right)]),
            (
                "turns right twice, then left",
                [vec![Claim::Turn(TurnKind::Right); 2], vec![Claim::Turn(TurnKind::Left)]].concat(),
            ),
            ("turns left three times", vec![Claim::Turn(TurnKind::Left); 3]),
            (
                "a person with a backpack in a red shirt and blue trousers",
                vec![Claim::Backpack, Claim::Top(Colour::Red), Claim::Trousers(Colour::Blue)],
            ),
            ("7 bananas", vec![Claim::Unknown("7 bananas".into())]),
            ("2.5 turns -3 m", vec![Claim::Unknown("2.5 turns".into()), Claim::Unknown("-3 m".into())]),
        ] {
            assert_eq!(read(text), expected, "{text}");
        }
    }
}
