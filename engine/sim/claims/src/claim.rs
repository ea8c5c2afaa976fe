//! Claims that a text can make of a flight.

use crate::compass::Compass;
use crate::turn::TurnKind;
use cosfly_domain::Colour;

/// One claim of a text.
#[derive(Clone, Debug, PartialEq)]
pub enum Claim {
    /// Way that the target goes or faces.
    Direction(Compass),
    /// Distance between drone and target, metres.
    Distance(f64),
    /// Height of the drone above the target, metres.
    Altitude(f64),
    /// Angle of the camera below the horizon, degrees; negative when it looks up.
    Pitch(f64),
    /// Way that the target walks, metres.
    Way(f64),
    /// Time of the whole flight, seconds.
    Duration(f64),
    /// Speed of the target, m/s.
    Speed(f64),
    /// Number of stops.
    Stops(usize),
    /// Stops, without a number.
    SomeStops,
    /// Time of all stops together, seconds.
    Standing(f64),
    /// The next turn of a list.
    Turn(TurnKind),
    /// Number of turns.
    Turns(usize),
    /// Number of turns to a side.
    TurnsOf(TurnKind, usize),
    /// No turns.
    NoTurns,
    /// Straight way.
    Straight,
    /// First turn soon after the start.
    TurnsSoon,
    /// First turn only after a good while.
    TurnsLate,
    /// Colour of the target's top.
    Top(Colour),
    /// Colour of the target's trousers.
    Trousers(Colour),
    /// Whether the target wears a backpack.
    Backpack(bool),
    /// The target stays where it is.
    Stays,
    /// The target walks.
    Walks,
    /// The target runs.
    Runs,
    /// A number that this reader cannot place.
    Unknown(String),
}
