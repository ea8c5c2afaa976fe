//! [`PedestrianError`]: broken rules and ground that cannot be walked on, each with advice.

use std::fmt;

/// A rule between config values that is broken.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PedestrianConfigRule {
    /// Keys from the config's table to the value.
    pub path: Vec<&'static str>,
    /// The value and the rule.
    pub message: String,
}

impl PedestrianConfigRule {
    /// Rule for the config within a table.
    pub fn within_table(mut self, table: &'static str) -> Self {
        self.path.insert(0, table);
        self
    }

    /// Holds when `value` is a number within `min` and `max`.
    pub(crate) fn within(path: &'static [&'static str], value: f64, min: f64, max: f64) -> Result<(), Self> {
        let name = path.last().copied().unwrap_or_default();
        if (min..=max).contains(&value) {
            return Ok(());
        }
        Err(Self {
            path: path.to_vec(),
            message: format!("`{name}` is `{value}`; it must be within `{min}` and `{max}`"),
        })
    }

    /// Holds when `value` is not more than its upper limit.
    pub(crate) fn in_order(path: &'static [&'static str], value: f64, limit: &str, at_most: f64) -> Result<(), Self> {
        let name = path.last().copied().unwrap_or_default();
        if value <= at_most {
            return Ok(());
        }
        let message = format!("`{name}` is `{value}`; it must not be more than `{limit}`, which is `{at_most}`");
        Err(Self { path: path.to_vec(), message })
    }
}

/// Reason why a town has no place for pedestrians, or why a config cannot be used.
#[derive(Clone, Debug, PartialEq)]
pub enum PedestrianError {
    /// A config rule is broken.
    Config(PedestrianConfigRule),
    /// A corner of a walkable polygon is not a finite number.
    BrokenPolygon {
        /// Index in the town's list.
        polygon: usize,
        /// Index of the corner.
        corner: usize,
    },
    /// An obstacle's box is not finite.
    BrokenObstacle {
        /// Index in the town's list.
        obstacle: usize,
    },
    /// The town lists no walkable ground at all.
    NoGround,
    /// No ground is free of obstacles and wide enough for a cell.
    NothingFree {
        /// Walkable polygons in the town.
        polygons: usize,
        /// Cells that lie on walkable ground.
        ground_cells: usize,
        /// Cell size, metres.
        grid_m: f64,
    },
    /// Every connected piece of ground is too small.
    NoRoom {
        /// Extent of the largest piece, metres.
        largest_m: f64,
        /// Asked extent, metres.
        min_route_m: f64,
    },
    /// No piece of ground that is large enough has a weight above 0.
    NoWeight,
    /// The picture of an area lies where no ground is.
    PictureOff {
        /// Index of the area.
        area: usize,
        /// Smallest and largest x and y of the picture, metres.
        picture_m: [[f64; 2]; 2],
        /// Smallest and largest x and y of the ground, metres.
        ground_m: [[f64; 2]; 2],
    },
    /// The people of a crowd do not all find a place to begin at.
    TooCrowded {
        /// People who found one.
        placed: usize,
        /// Asked number of people.
        count: u32,
    },
    /// The ground spans more than walks are planned over.
    TooWide {
        /// Extent of the ground, square metres.
        extent_m2: f64,
        /// Extent allowed, square metres.
        limit_m2: f64,
        /// The parameter `bounds_m` of the part with the most ground.
        part: String,
    },
    /// The grid would not fit into memory.
    TooLarge {
        /// Cells it would take.
        cells: f64,
        /// Cells allowed.
        limit: usize,
        /// Cell size, metres.
        grid_m: f64,
    },
}

impl PedestrianError {
    /// Advice for the user.
    pub fn hint(&self) -> String {
        match self {
            Self::Config(_) => "change the value in the recipe".into(),
            Self::BrokenPolygon { .. } | Self::BrokenObstacle { .. } => {
                "the map has a value there that is not a number; repair the map file".into()
            }
            Self::NoGround => "choose a map with pavements or streets; check `bounds_m` and `more` of the stage `map`".into(),
            Self::NothingFree { .. } => {
                "make `grid_m` or `radius.max_m` smaller, close less of the ground with `areas`, or fill in fewer buildings and trees in the `map` stage"
                    .into()
            }
            Self::NoRoom { largest_m, .. } => {
                format!(
                    "set `min_route_m` to {:.0} or less, or choose a map whose pavements are connected",
                    largest_m.floor().max(1.0)
                )
            }
            Self::NoWeight => {
                "give an area over walkable ground a `weight` above 0; corners are in the world: x, y, metres".into()
            }
            Self::PictureOff { .. } => {
                "give `min_m` and `max_m` as places of the world, x and y in metres; `cosfly map inspect MAP --area '{ picture = \"FILE\", min_m = [..], max_m = [..] }'` shows the picture over the town".into()
            }
            Self::TooCrowded { placed, .. } => {
                format!("set `count` to {} or less, or choose a map with more walkable ground", placed * 4 / 5)
            }
            Self::TooWide { part, .. } => {
                format!("cut the town in the stage `map`: `{part}` keeps the part with the most ground")
            }
            Self::TooLarge { .. } => {
                "make `grid_m` larger, at most 2, or cut the town to the part you need with `bounds_m` of the stage `map`".into()
            }
        }
    }
}

impl fmt::Display for PedestrianError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Config(rule) => f.write_str(&rule.message),
            Self::BrokenPolygon { polygon, corner } => {
                write!(f, "corner {corner} of walkable polygon {polygon} is not a finite number")
            }
            Self::BrokenObstacle { obstacle } => write!(f, "the box of obstacle {obstacle} is not finite"),
            Self::NoGround => f.write_str("the town has no walkable ground"),
            Self::NothingFree { polygons, ground_cells, grid_m } => write!(
                f,
                "none of the town's {polygons} walkable polygons leaves room for a pedestrian: {ground_cells} cells of \
                 {grid_m} m lie on walkable ground, but none of them is free and connected to another"
            ),
            Self::NoRoom { largest_m, min_route_m } => write!(
                f,
                "the largest connected piece of walkable ground is {largest_m:.1} m across; `min_route_m` asks for \
                 {min_route_m} m"
            ),
            Self::NoWeight => f.write_str("`areas` give all walkable ground the weight 0, so no walk can begin"),
            Self::PictureOff { area, picture_m: [from, to], ground_m: [low, high] } => write!(
                f,
                "the picture of area {area} lies beside the walkable ground: it reaches from {from:.1?} to {to:.1?}, the ground \
                 from {low:.1?} to {high:.1?}"
            ),
            Self::TooCrowded { placed, count } => {
                write!(f, "only {placed} of {count} people find a place to begin at on the walkable ground")
            }
            Self::TooWide { extent_m2, limit_m2, .. } => write!(
                f,
                "the walkable ground spans {:.0} square kilometres; walks need one of at most {:.0}",
                1e-6 * extent_m2,
                1e-6 * limit_m2
            ),
            Self::TooLarge { cells, limit, grid_m } => write!(
                f,
                "the walkable ground needs {cells:.0} cells at `grid_m` of {grid_m} m; at most {limit} are supported"
            ),
        }
    }
}

impl std::error::Error for PedestrianError {}

impl From<PedestrianConfigRule> for PedestrianError {
    fn from(rule: PedestrianConfigRule) -> Self {
        Self::Config(rule)
    }
}
