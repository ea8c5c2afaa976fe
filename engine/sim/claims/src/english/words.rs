//! English words by what they tell about a number, a walk or a pause.

/// Beginnings of words for a camera that looks up.
pub const UP_STEMS: [&str; 14] = [
    "up", "sky", "rais", "rise", "rising", "rose", "lift", "elevat", "heaven", "above", "overhead", "cloud", "ceiling",
    "ascend",
];

/// Beginnings of words for a camera that looks down.
pub const DOWN_STEMS: [&str; 22] = [
    "down", "below", "low", "dip", "depress", "ground", "earth", "floor", "pavement", "declin", "droop", "bow", "sink",
    "sunk", "descen", "under", "beneath", "drop", "plung", "nosed", "feet", "tarmac",
];

/// Pauses, beside those that begin with `stop`, `paus` and `halt`.
pub const STOP_WORDS: [&str; 37] = [
    "stop",
    "stops",
    "stopped",
    "pause",
    "pauses",
    "paused",
    "halt",
    "halts",
    "waits",
    "wait",
    "waited",
    "waiting",
    "break",
    "breaks",
    "breather",
    "breathers",
    "rests",
    "rested",
    "resting",
    "standstill",
    "standstills",
    "delay",
    "delays",
    "respite",
    "respites",
    "lull",
    "lulls",
    "hiatus",
    "intermission",
    "intermissions",
    "timeout",
    "timeouts",
    "layover",
    "layovers",
    "stoppage",
    "stoppages",
    "letup",
];

pub const DURATION_WORDS: [&str; 50] = [
    "travel",
    "walk",
    "walks",
    "walked",
    "takes",
    "take",
    "taking",
    "covers",
    "covered",
    "route",
    "journey",
    "flight",
    "stroll",
    "m/s",
    "time",
    "pace",
    "speed",
    "footage",
    "clip",
    "recording",
    "film",
    "video",
    "sequence",
    "shot",
    "trek",
    "lasts",
    "runs",
    "run",
    "runtime",
    "duration",
    "trip",
    "outing",
    "start",
    "over",
    "ends",
    "altogether",
    "whole",
    "entire",
    "minute",
    "elapsed",
    "passes",
    "pass",
    "clock",
    "airborne",
    "hike",
    "tour",
    "ramble",
    "movie",
    "reel",
    "take-off",
];

/// First words of a clause that goes on about the stop before.
pub const GOES_ON: [&str; 22] = [
    "for",
    "about",
    "each",
    "lasting",
    "totalling",
    "totaling",
    "which",
    "altogether",
    "in",
    "together",
    "standing",
    "adding",
    "amounting",
    "some",
    "roughly",
    "around",
    "all",
    "making",
    "worth",
    "with",
    "that",
    "and",
];

/// Of `doesn't` and its like the part behind the apostrophe is a word of its own.
pub const NEGATIONS: [&str; 39] = [
    "nope",
    "nah",
    "neither",
    "no",
    "not",
    "never",
    "without",
    "nowhere",
    "nothing",
    "none",
    "nobody",
    "cannot",
    "neither",
    "nor",
    "t",
    "zero",
    "hardly",
    "nought",
    "minus",
    "sans",
    "devoid",
    "lacking",
    "lacks",
    "lack",
    "free",
    "refuses",
    "refuse",
    "refrain",
    "refrains",
    "avoid",
    "avoids",
    "skips",
    "skip",
    "forgoes",
    "absent",
    "nary",
    "nil",
    "unburdened",
    "n't",
];

pub const LUGGAGE: [&str; 17] = [
    "backpack",
    "rucksack",
    "knapsack",
    "bag",
    "daypack",
    "haversack",
    "satchel",
    "schoolbag",
    "daybag",
    "packsack",
    "bookbag",
    "backpacks",
    "rucksacks",
    "bags",
    "knapsacks",
    "luggage",
    "baggage",
];

/// Words that name the place of the drone beyond doubt, where they stand near a length.
pub const STRONG_ALTITUDE: [&str; 8] =
    ["above", "higher", "height", "altitude", "overhead", "aloft", "high", "elevation"];

pub const STRONG_WAY: [&str; 14] = [
    "walks",
    "walked",
    "covers",
    "covered",
    "travels",
    "travelled",
    "traveled",
    "journey",
    "route",
    "long",
    "traverses",
    "traversed",
    "length",
    "trek",
];

pub const STRONG_DISTANCE: [&str; 9] =
    ["away", "behind", "apart", "gap", "separation", "spacing", "clearance", "range", "buffer"];

/// Beginnings of words for a pause.
pub const STOP_STEMS: [&str; 21] = [
    "stop",
    "paus",
    "halt",
    "linger",
    "interrupt",
    "tarr",
    "loiter",
    "dawdl",
    "dall",
    "hesitat",
    "idl",
    "dwell",
    "stall",
    "intermi",
    "falter",
    "stoppag",
    "standstill",
    "tarri",
    "breather",
    "respit",
    "interrup",
];

/// Words that speak of a turn, beside those that begin with a stem.
pub const TURN_NOUNS: [&str; 12] = [
    "turn", "turns", "bend", "bends", "corner", "corners", "curve", "curves", "turning", "turnings", "changes", "kinks",
];

/// Beginnings of words for leaving a straight line.
pub const TURN_STEMS: [&str; 18] = [
    "turn", "veer", "swerv", "deviat", "stray", "detour", "zigzag", "diverg", "divert", "bend", "corner", "sidestep",
    "curv", "twist", "kink", "meander", "waver", "wander",
];

/// Words of motion that, denied, say that the target stays.
pub const MOTION: [&str; 29] = [
    "move",
    "moves",
    "moving",
    "moved",
    "movement",
    "budge",
    "budges",
    "budging",
    "going",
    "go",
    "goes",
    "walk",
    "stir",
    "stirs",
    "stirring",
    "shift",
    "shifts",
    "step",
    "inch",
    "leave",
    "leaves",
    "leaving",
    "motion",
    "walking",
    "steps",
    "displacement",
    "relocate",
    "relocates",
    "left",
];

/// Words of standing, each of which says that the target stays.
pub const STANDS: [&str; 14] = [
    "motionless",
    "stationary",
    "immobile",
    "rooted",
    "static",
    "frozen",
    "unmoving",
    "standstill",
    "stockstill",
    "unmoved",
    "parked",
    "planted",
    "immovable",
    "standingstill",
];

/// Words that say that a walk has no pause.
pub const UNPAUSED: [&str; 12] = [
    "nonstop",
    "uninterrupted",
    "unbroken",
    "ceaselessly",
    "incessantly",
    "unceasing",
    "unceasingly",
    "continuously",
    "uninterruptedly",
    "unpausing",
    "ceaseless",
    "incessant",
];

/// Words that say that a walk has no turn.
pub const UNTURNED: [&str; 14] = [
    "beeline",
    "undeviating",
    "unswerving",
    "unswervingly",
    "arrowstraight",
    "rulerstraight",
    "linear",
    "unerringly",
    "dead-straight",
    "deadstraight",
    "turnless",
    "unbending",
    "straightaway",
    "straightline",
];
/// Words for a camera that looks neither up nor down.
pub const LEVEL: [&str; 10] = [
    "level",
    "deadlevel",
    "levelled",
    "leveled",
    "parallel",
    "horizontal",
    "horizontally",
    "horizon",
    "untilted",
    "flat",
];

/// Verbs that say that the target walks.
pub const WALKS: [&str; 10] =
    ["walks", "walking", "strolls", "strolling", "wanders", "wandering", "strides", "striding", "ambles", "ambling"];
