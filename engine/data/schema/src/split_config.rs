//! Parameters of splits: the unit that goes to one split as a whole, areas, shares.

use crate::split::Split;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Unit that goes to one split as a whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SplitBy {
    /// All flights behind one pedestrian, and behind all others whose walks overlap with theirs.
    Pedestrian,
    /// All flights in one town, whatever its name: a dataset of several towns then has unseen ones.
    Town,
    /// All flights in all towns of one kind: those whose names differ in a number at the end only, such as `village_1` and
    /// `village_2`. A dataset of several kinds of places then has unseen ones.
    Kind,
    /// All flights in one area: each town's map is cut by straight lines, with a guard band along each. Flights whose
    /// walk enters a band are left out, with a row in table `rejected`.
    Area,
}

/// Directions in which one walk repeats another one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum OverlapDirection {
    /// The same ground in the same direction: the way back is another walk.
    #[default]
    Same,
    /// The same ground in the same or in the opposite direction: there and back are one walk.
    Either,
}

/// Axis across which a town's map is cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CutAxis {
    /// Lines from north to south.
    X,
    /// Lines from west to east.
    Y,
}

/// Areas of a town's map, separated by straight lines. Coordinates: metres, x east, y south, the world frame plus
/// `town_offset_m` of table `trajectories`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AreaCut {
    /// Axis whose coordinate the lines fix: `x` or `y`.
    pub axis: CutAxis,
    /// Splits of the areas, in ascending order of the coordinate.
    pub splits: Vec<Split>,
    /// Coordinates of the lines between successive areas, ascending, metres.
    pub at_m: Vec<f64>,
}

/// Shares of the splits. The split is a draw from the id of the pedestrian (the first of those whose walks overlap) or
/// from the town's ground plan, so that twins stay together and adding pedestrians moves old ones only where a new walk
/// joins two groups.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SplitShares {
    /// Share of training pedestrians; the shares are divided by their sum.
    #[schemars(range(min = 0, max = 1))]
    pub train: f64,
    /// Share of validation pedestrians.
    #[schemars(range(min = 0, max = 1))]
    pub val: f64,
    /// Share of test pedestrians.
    #[schemars(range(min = 0, max = 1))]
    pub test: f64,
    /// Seed of the assignment.
    pub seed: u64,
    /// Unit that goes to one split as a whole: `pedestrian`, `town`, `kind` (of town) or `area`.
    pub by: SplitBy,
    /// Width of the guard band along each line between areas, metres (`by = "area"` only): walks of two splits are at
    /// least this far apart.
    #[serde(skip_serializing_if = "is_default_guard")]
    #[schemars(range(min = 0, max = 1_000))]
    pub guard_m: f64,
    /// Areas by the town's name (`by = "area"` only), such as `{ uptown = { axis = "x", splits = ["train", "test"], at_m =
    /// [120.0] } }`. Other towns are cut so that the shares are met; `splits.json` names the lines. Named areas stay where
    /// they are when flights are added.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub areas: BTreeMap<String, AreaCut>,
    /// Largest difference between the share of a split and the share of flights that it gets; publishing fails where it is
    /// larger. With `1.0`, differences are only reported.
    #[serde(skip_serializing_if = "is_one")]
    #[schemars(range(min = 0, max = 1))]
    pub max_share_error: f64,
    /// Largest share of a walk that another one in another split may repeat: the same ground within 4 m in the directions of
    /// `overlap_direction`. Walks with a larger overlap stay together; publishing fails where splits violate it.
    #[schemars(range(min = 0, max = 1))]
    pub max_route_overlap: f64,
    /// Directions in which a walk repeats another one: `same`, or `either` for the opposite one, too. With `same`, the way back
    /// along a street may be in another split; `cosfly dataset lint` counts such pairs.
    #[serde(skip_serializing_if = "is_same_direction")]
    pub overlap_direction: OverlapDirection,
    /// Splits that towns go to as a whole, by the town's name: `{ uptown = "test" }` keeps `uptown` unseen. Towns with
    /// the same ground plan go to the same split.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub towns: BTreeMap<String, Split>,
}

/// Default width of guard bands, metres.
const GUARD_M: f64 = 20.0;

fn is_default_guard(guard_m: &f64) -> bool {
    *guard_m == GUARD_M
}

fn is_same_direction(direction: &OverlapDirection) -> bool {
    *direction == OverlapDirection::Same
}

fn is_one(share: &f64) -> bool {
    *share == 1.0
}

impl SplitShares {
    /// Shares of train, val and test, with a sum of 1.
    pub fn asked(&self) -> [f64; 3] {
        let total = self.train + self.val + self.test;
        [self.train, self.val, self.test].map(|share| share / total)
    }

    /// Whether a guard band is asked for where no line separates areas.
    pub(crate) fn has_idle_guard(&self) -> bool {
        self.by != SplitBy::Area && !is_default_guard(&self.guard_m)
    }

    /// Problem of an area, in words, and the name of its town.
    pub(crate) fn area_problem(&self) -> Option<(&String, String)> {
        self.areas.iter().find_map(|(town, cut)| {
            let is_ascending =
                cut.at_m.windows(2).all(|pair| pair[0] < pair[1]) && cut.at_m.iter().all(|it| it.is_finite());
            let problem = if cut.splits.len() != cut.at_m.len() + 1 {
                format!("{} lines separate {} areas, not {}", cut.at_m.len(), cut.at_m.len() + 1, cut.splits.len())
            } else if !is_ascending {
                format!("the lines {:?} are not in ascending order", cut.at_m)
            } else if self.by != SplitBy::Area {
                "areas have a meaning with `by = \"area\"` only".to_owned()
            } else {
                return None;
            };
            Some((town, problem))
        })
    }

    /// The split of a draw from 0..1.
    pub fn split_of(&self, draw: f64) -> Split {
        let total = self.train + self.val + self.test;
        if draw * total < self.train {
            Split::Train
        } else if draw * total < self.train + self.val || self.test <= 0.0 {
            if self.val > 0.0 { Split::Val } else { Split::Train }
        } else {
            Split::Test
        }
    }
}

impl Default for SplitShares {
    fn default() -> Self {
        Self {
            train: 0.8,
            val: 0.1,
            test: 0.1,
            seed: 0,
            by: SplitBy::Pedestrian,
            guard_m: GUARD_M,
            areas: BTreeMap::new(),
            max_share_error: 1.0,
            max_route_overlap: 0.5,
            overlap_direction: OverlapDirection::Same,
            towns: BTreeMap::new(),
        }
    }
}
