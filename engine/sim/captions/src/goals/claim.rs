//! Claims of goals: what a goal says of a flight, typed, with the frames in which it holds.

use crate::description::turn_name;
use crate::facts::Wear;
use crate::sight::{LandmarkKind, OnSide};
use cosfly_claims::TurnKind;
use cosfly_domain::{BodyKind, Colour, ObstacleKind};
use std::fmt;
use std::ops::Range;

/// Object or body that hides a target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hider {
    /// An object of the town.
    Object(ObstacleKind),
    /// A person or a vehicle.
    Body(BodyKind),
}

/// Landmarks that a target has passed on one side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Passed {
    /// Kind of the landmarks.
    pub kind: LandmarkKind,
    /// Side of the walker on which they are.
    pub side: OnSide,
    /// Number of the landmarks, 1 to 6.
    pub count: usize,
    /// Whether they are counted from the only crossing of the stretch on.
    pub after_crossing: bool,
}

/// Something that a goal says of the target, in the frames of a stretch.
#[derive(Clone, Debug, PartialEq)]
pub enum Claim {
    /// Colours of top and trousers, and a backpack where one is worn.
    Wears(Wear),
    /// Mean distance from the drone to the feet, metres.
    Distance(u32),
    /// Turns to a side.
    Turns(TurnKind),
    /// Number of turns, where they are not told one by one.
    TurnsInAll(usize),
    /// No turn.
    NoTurn,
    /// Pause, seconds.
    Stops(u32),
    /// Stands all the time.
    Stands,
    /// Passes so many landmarks of a kind on a side, no more and no fewer.
    Passes(Passed),
    /// Crosses the street at a marked crossing.
    Crosses,
    /// Out of sight for some seconds, behind something or outside of the picture; seen again or not.
    Lost {
        /// Object or body that hides the target; `None`: it is outside of the picture.
        behind: Option<Hider>,
        /// Time out of sight, seconds.
        seconds: u32,
        /// Whether the flight sees the target again.
        found: bool,
    },
    /// Partly hidden, less than half of it visible.
    PartlyHidden(Hider),
    /// Walks beside so many others.
    WalksWith(usize),
    /// Somebody in a top of this colour comes towards the target and passes it.
    Meets(Colour),
    /// Walks past somebody in a top of this colour who goes the same way.
    Overtakes(Colour),
    /// A vehicle comes towards the target and passes it.
    MeetsVehicle(BodyKind),
    /// A vehicle comes from behind and passes the target.
    OvertakenBy(BodyKind),
}

/// A claim and its frames.
#[derive(Clone, Debug, PartialEq)]
pub struct Said {
    /// Content.
    pub claim: Claim,
    /// Frames in which it is so; the end is the frame after the last one.
    pub frames: Range<usize>,
}

/// Subject of a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Subject {
    Clothes,
    Distance,
    Turn,
    Stop,
    Landmark,
    Sight,
    People,
    Vehicles,
}

impl Subject {
    /// Name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Clothes => "clothes",
            Self::Distance => "distance",
            Self::Turn => "turn",
            Self::Stop => "stop",
            Self::Landmark => "landmark",
            Self::Sight => "sight",
            Self::People => "people",
            Self::Vehicles => "vehicles",
        }
    }
}

impl Claim {
    /// Subject of the claim.
    pub fn subject(&self) -> Subject {
        match self {
            Self::Wears(_) => Subject::Clothes,
            Self::Distance(_) => Subject::Distance,
            Self::Turns(_) | Self::TurnsInAll(_) | Self::NoTurn => Subject::Turn,
            Self::Stops(_) | Self::Stands => Subject::Stop,
            Self::Passes(_) | Self::Crosses => Subject::Landmark,
            Self::Lost { .. } | Self::PartlyHidden(_) => Subject::Sight,
            Self::WalksWith(_) | Self::Meets(_) | Self::Overtakes(_) => Subject::People,
            Self::MeetsVehicle(_) | Self::OvertakenBy(_) => Subject::Vehicles,
        }
    }
}

/// `passes tree left 2 @ 12..40`: the claim as table `goals` has it.
impl fmt::Display for Said {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.claim {
            Claim::Wears(wear) => {
                write!(formatter, "wears {} {}", wear.top.name(), wear.trousers.name())?;
                if wear.backpack {
                    write!(formatter, " backpack")?;
                }
            }
            Claim::Distance(metres) => write!(formatter, "distance {metres}")?,
            Claim::Turns(kind) => write!(formatter, "turns {}", turn_name(*kind))?,
            Claim::TurnsInAll(count) => write!(formatter, "turns_in_all {count}")?,
            Claim::NoTurn => write!(formatter, "no_turn")?,
            Claim::Stops(seconds) => write!(formatter, "stops {seconds}")?,
            Claim::Stands => write!(formatter, "stands")?,
            Claim::Passes(it) => {
                write!(formatter, "passes {} {} {}", landmark_name(it.kind), side_name(it.side), it.count)?;
                if it.after_crossing {
                    write!(formatter, " after_crossing")?;
                }
            }
            Claim::Crosses => write!(formatter, "crosses")?,
            Claim::Lost { behind, seconds, found } => {
                let behind = behind.map_or("outside", hider_name);
                write!(formatter, "lost {behind} {seconds} {}", if *found { "found" } else { "gone" })?;
            }
            Claim::PartlyHidden(hider) => write!(formatter, "partly_hidden {}", hider_name(*hider))?,
            Claim::WalksWith(count) => write!(formatter, "walks_with {count}")?,
            Claim::Meets(top) => write!(formatter, "meets {}", top.name())?,
            Claim::Overtakes(top) => write!(formatter, "overtakes {}", top.name())?,
            Claim::MeetsVehicle(kind) => write!(formatter, "meets_vehicle {}", kind.name())?,
            Claim::OvertakenBy(kind) => write!(formatter, "overtaken_by {}", kind.name())?,
        }
        write!(formatter, " @ {}..{}", self.frames.start, self.frames.end)
    }
}

pub(crate) fn side_name(side: OnSide) -> &'static str {
    match side {
        OnSide::Left => "left",
        OnSide::Right => "right",
    }
}

pub(crate) fn landmark_name(kind: LandmarkKind) -> &'static str {
    match kind {
        LandmarkKind::TrafficLight => "traffic_light",
        LandmarkKind::Lamp => "lamp",
        LandmarkKind::TrafficSign => "traffic_sign",
        LandmarkKind::Tree => "tree",
        LandmarkKind::Car => "parked_car",
        LandmarkKind::Building => "building",
    }
}

/// Name of what hides a target; the kinds that [`is_named`] lets through.
pub(super) fn hider_name(hider: Hider) -> &'static str {
    match hider {
        Hider::Body(kind) => kind.name(),
        Hider::Object(ObstacleKind::Building) => "building",
        Hider::Object(ObstacleKind::Wall) => "wall",
        Hider::Object(ObstacleKind::Fence) => "fence",
        Hider::Object(ObstacleKind::TreeTrunk | ObstacleKind::TreeCrown) => "tree",
        Hider::Object(ObstacleKind::Bush) => "bush",
        Hider::Object(ObstacleKind::Bridge) => "bridge",
        Hider::Object(ObstacleKind::Car) => "parked_car",
        Hider::Object(_) => "object",
    }
}

/// Whether people have a word for something that hides a target.
pub(super) fn is_named(hider: Hider) -> bool {
    hider_name(hider) != "object"
}
