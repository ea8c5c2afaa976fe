//! English words by what they tell about a number or a garment.

pub const ALTITUDE_WORDS: [&str; 9] =
    ["above", "high", "higher", "height", "altitude", "overhead", "over", "up", "aloft"];
pub const WAY_WORDS: [&str; 24] = [
    "travel",
    "travelling",
    "covers",
    "cover",
    "covered",
    "covering",
    "route",
    "path",
    "long",
    "length",
    "walked",
    "walk",
    "walks",
    "travels",
    "travelled",
    "traveled",
    "journey",
    "stroll",
    "trip",
    "way",
    "total",
    "strolls",
    "course",
    "stretch",
];
pub const DISTANCE_WORDS: [&str; 18] = [
    "away",
    "distance",
    "from",
    "behind",
    "apart",
    "range",
    "back",
    "gap",
    "off",
    "between",
    "separation",
    "spacing",
    "clear",
    "standoff",
    "clearance",
    "berth",
    "room",
    "space",
];
/// Words that make a distance one that was walked.
pub const WALKED: [&str; 10] =
    ["travel", "covers", "cover", "covered", "covering", "travels", "travelled", "traveled", "walked", "total"];
pub const UP_WORDS: [&str; 10] =
    ["up", "upward", "upwards", "skyward", "raised", "upturned", "above", "sky", "skywards", "heavens"];
pub const DOWN_WORDS: [&str; 9] =
    ["down", "downward", "downwards", "below", "lowered", "dipped", "ground", "under", "beneath"];
/// Pauses, beside those that begin with `stop`, `paus` and `halt`.
pub const STOP_WORDS: [&str; 22] = [
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
    "rests",
    "rested",
    "resting",
    "standstill",
    "standstills",
    "delay",
    "delays",
];
pub const DURATION_WORDS: [&str; 17] = [
    "travel", "walk", "walks", "walked", "takes", "take", "taking", "covers", "covered", "route", "journey", "flight",
    "stroll", "m/s", "time", "pace", "speed",
];
/// First words of a clause that goes on about the stop before.
pub const GOES_ON: [&str; 11] =
    ["for", "about", "each", "lasting", "totalling", "totaling", "which", "altogether", "in", "together", "standing"];
/// Of `doesn't` and its like the part behind the apostrophe is a word of its own.
pub const NEGATIONS: [&str; 12] =
    ["no", "not", "never", "without", "nowhere", "nothing", "none", "nobody", "cannot", "neither", "nor", "t"];
pub const TOPS: [&str; 19] = [
    "top",
    "shirt",
    "tshirt",
    "jacket",
    "coat",
    "sweater",
    "jumper",
    "hoodie",
    "blouse",
    "pullover",
    "tee",
    "jersey",
    "cardigan",
    "sweatshirt",
    "polo",
    "vest",
    "parka",
    "anorak",
    "fleece",
];
pub const TROUSERS: [&str; 13] = [
    "trousers", "pants", "jeans", "slacks", "leggings", "bottoms", "chinos", "joggers", "denims", "shorts", "tights",
    "cords", "legs",
];
pub const LUGGAGE: [&str; 4] = ["backpack", "rucksack", "knapsack", "bag"];
/// Colours that no garment here has a name for; a text that names one cannot be compared.
pub const OTHER_COLOURS: [&str; 20] = [
    "navy",
    "teal",
    "turquoise",
    "cyan",
    "maroon",
    "gold",
    "golden",
    "silver",
    "khaki",
    "magenta",
    "crimson",
    "scarlet",
    "violet",
    "lilac",
    "olive",
    "tan",
    "cream",
    "burgundy",
    "indigo",
    "ochre",
];
