//! Claims of texts about a flight in Chinese and English, whoever wrote them: numbers, directions, turns, stops, clothes.
//!
//! [`english::read`] and [`chinese::read`] list them; [`foreign_things`] names what no facts of a flight have. The words of the
//! templates are in `cosfly-captions`, which this crate does not know: a text that is read back proves them.

pub mod chinese;
mod compass;
pub mod english;
mod foreign;
mod language;
mod lists;
mod time_of_turn;
mod turn;

pub use compass::Compass;
pub use foreign::foreign_things;
pub use language::Language;
pub use lists::without_marks;
pub use time_of_turn::time_of_first_turn;
pub use turn::TurnKind;

pub(crate) use english::words::LUGGAGE;

use cosfly_domain::Colour;

/// One claim of a text.
#[derive(Clone, Debug, PartialEq)]
pub enum Claim {
    /// The target goes (or faces) this way.
    Direction(Compass),
    /// Metres between drone and target.
    Distance(f64),
    /// Metres above the target.
    Altitude(f64),
    /// Degrees below the horizon.
    Pitch(f64),
    /// Degrees of tilt, without a word for up or down.
    Tilt(f64),
    /// Metres walked.
    Way(f64),
    /// Metres of the distance, the height or the way.
    Metres(f64),
    /// Seconds in all.
    Duration(f64),
    /// Seconds in all, or of standing.
    Seconds(f64),
    /// Seconds for which the target stands: all the time, or in its stops.
    StandsFor(f64),
    /// Metres per second.
    Speed(f64),
    /// So many stops.
    Stops(usize),
    /// Stops, without a number.
    SomeStops,
    /// Seconds of standing.
    Standing(f64),
    /// The next turn.
    Turn(TurnKind),
    /// A word that may be a turn, or say the turn before it again.
    PerhapsTurn(TurnKind),
    /// So many times something was done: stops or turns.
    Times(usize),
    /// So many turns.
    Turns(usize),
    /// So many turns to this side.
    TurnsOf(TurnKind, usize),
    /// No turns.
    NoTurns,
    /// Straight on, before a turn or all the way.
    Straight,
    /// The target wears a top of this colour.
    Top(Colour),
    /// The target wears trousers of this colour.
    Trousers(Colour),
    /// The target wears a backpack.
    Backpack,
    /// The target wears no backpack.
    NoBackpack,
    /// Something that the target wears has this colour.
    Wears(Colour),
    /// A garment has one of these colours.
    Shade {
        /// Whether it is the top, not the trousers.
        is_top: bool,
        /// The shade in the text.
        name: String,
        /// Colours that it may be taken for.
        colours: Vec<Colour>,
    },
    /// The target stays where it is.
    Stays,
    /// The target walks.
    Walks,
    /// The only stop comes before the only turn, or after it.
    StopFirst(bool),
    /// The first turn comes soon after the start.
    TurnsSoon,
    /// The first turn comes only after a good while.
    TurnsLate,
    /// A number that says nothing this reader knows.
    Unknown(String),
}

/// Sentences of a text in either language; a point between digits ends none, nor does a question, whose answer belongs to it.
fn sentences(text: &str) -> Vec<&str> {
    let mut sentences = vec![];
    let mut start = 0;
    for (at, c) in text.char_indices() {
        let end = at + c.len_utf8();
        let is_decimal = c == '.' && text[end..].starts_with(|next: char| next.is_ascii_digit());
        if "。！!\n".contains(c) || (c == '.' && !is_decimal) {
            sentences.push(&text[start..end]);
            start = end;
        }
    }
    sentences.push(&text[start..]);
    sentences
}

/// A whole number of things, from a parsed number.
fn count(value: f64, otherwise: &str, claim: impl Fn(usize) -> Claim) -> Claim {
    if value.fract() == 0.0 && (0.0..1e6).contains(&value) {
        claim(value as usize)
    } else {
        Claim::Unknown(format!("{value} {otherwise}"))
    }
}

/// The claims of a text, in which a camera without any angle looks level, if the text says so.
fn with_level_view(mut claims: Vec<Claim>, is_level: bool) -> Vec<Claim> {
    let has_angle = claims.iter().any(|claim| matches!(claim, Claim::Pitch(_) | Claim::Tilt(_)));
    claims.extend((is_level && !has_angle).then_some(Claim::Pitch(0.0)));
    claims
}

/// Standing with a time is a stop, or the whole flight of a target that stands.
fn stands_for(claims: Vec<Claim>) -> Vec<Claim> {
    if !claims.contains(&Claim::Stays) {
        return claims;
    }
    let has_time =
        claims.iter().any(|claim| matches!(claim, Claim::Seconds(_) | Claim::Duration(_) | Claim::Standing(_)));
    let timed = |claim: Claim| match claim {
        Claim::Seconds(value) | Claim::Duration(value) | Claim::Standing(value) => Some(Claim::StandsFor(value)),
        Claim::Stays if has_time => None,
        other => Some(other),
    };
    claims.into_iter().filter_map(timed).collect()
}
