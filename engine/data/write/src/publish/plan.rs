//! Where every flight of a group goes: split, files of tables, place of its log.

use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_schema::tables::Membership;
use cosfly_schema::{Rejection, Split, TownLayout};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

/// Logs in one folder; hosts of datasets refuse folders with many thousand files.
const LOGS_PER_FOLDER: usize = 1_000;

/// A flight of a group.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FlightPlan {
    /// Trajectory id.
    pub trajectory_id: String,
    /// Name of the town.
    pub town: String,
    /// Path of the log.
    pub mcap_path: String,
    /// Split, split group and subset.
    pub membership: Membership,
}

/// Name of a group of walks.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct GroupName {
    /// Stage that the walks come from, where walks come from several.
    pub stage: Option<String>,
    /// Number of the group among those of the stage.
    pub number: u64,
}

impl GroupName {
    /// The name within names of files: `00003`, `walkers_uptown-00003`.
    pub(crate) fn label(&self) -> String {
        match &self.stage {
            None => format!("{:05}", self.number),
            Some(stage) => format!("{stage}-{:05}", self.number),
        }
    }

    /// Number of flight number `index` of the group among all flights; another group changes none.
    pub(crate) fn place(&self, index: usize) -> u64 {
        let hash = |stage: &String| u64::from(crc32fast::hash(stage.as_bytes()) >> 12);
        let stage = self.stage.as_ref().map_or(0, hash);
        (stage << 44) + (self.number << 24) + index as u64
    }
}

/// The flights of a group of walks, whose tables are written together.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct GroupPlan {
    /// Name of the group.
    pub name: GroupName,
    /// The flights that are published, in the order of the group.
    pub flights: Vec<FlightPlan>,
    /// Flights that the splits leave out.
    pub left_out: Vec<Rejection>,
    /// Ground plans of their towns, by name.
    pub layouts: BTreeMap<String, TownLayout>,
}

/// A file of tables: the split, the number of the part within the group, and the flights whose rows it holds.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Part {
    pub(crate) number: usize,
    pub(crate) members: Vec<usize>,
}

impl GroupPlan {
    /// Flights of a split, in parts with about `frames_per_file` frames; `frames` are those of each flight.
    pub(crate) fn parts(&self, split: Split, frames: &[u64], frames_per_file: u32) -> Vec<Part> {
        let limit = u64::from(frames_per_file.max(1));
        let members = (0..self.flights.len()).filter(|index| self.flights[*index].membership.split == split);
        let mut parts: Vec<Part> = vec![];
        let mut sum = 0;
        for member in members {
            if parts.is_empty() || (sum > 0 && sum + frames[member] > limit) {
                parts.push(Part { number: parts.len(), members: vec![] });
                sum = 0;
            }
            sum += frames[member];
            parts.last_mut().expect("there is a part").members.push(member);
        }
        parts
    }
}

/// Path of a file of a table with a row per frame: part `part` of group `group`.
pub(crate) fn path_of_part(table: &str, split: Split, group: &GroupName, part: usize) -> String {
    format!("data/{table}/{}-{}-{part:03}.parquet", split.name(), group.label())
}

/// Path of the file of another table for group `group`.
pub(crate) fn path_of_group(table: &str, split: Split, group: &GroupName) -> String {
    format!("data/{table}/{}-{}.parquet", split.name(), group.label())
}

/// Path of the only file of a table without splits.
pub(crate) fn path_of_table(table: &str) -> String {
    format!("data/{table}/{table}-00000.parquet")
}

/// Gives out the paths of logs, folder by folder.
#[derive(Default)]
pub(crate) struct LogPaths {
    ids: BTreeSet<String>,
    per_town: BTreeMap<String, usize>,
}

impl LogPaths {
    /// Path of the log of the next flight.
    pub(crate) fn next(&mut self, town: &str, trajectory_id: &str) -> Result<String> {
        if !self.ids.insert(trajectory_id.to_owned()) {
            let message = format!("two trajectories are called `{trajectory_id}`");
            return Err(Diagnostic::new("dataset-duplicate", Fault::Recipe, message)
                .hint("ids begin with the stage that a flight comes from: give every chain stages of its own"));
        }
        let number = self.per_town.entry(town.to_owned()).or_default();
        let folder = *number / LOGS_PER_FOLDER;
        *number += 1;
        Ok(format!("mcap/{town}/{folder:03}/{trajectory_id}.mcap"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_frames::Seed;
    use cosfly_schema::config::SplitShares;

    fn group(count: usize) -> GroupPlan {
        let shares = SplitShares::default();
        let flight = |number: usize| {
            let walk = format!("p{:05}", number / 2);
            let split = shares.split_of(Seed::of_item(0, "split", &walk).stream("split").unit());
            FlightPlan {
                trajectory_id: format!("t{number}"),
                town: "town".into(),
                mcap_path: String::new(),
                membership: Membership { split, split_group: walk, is_seen: true, subset_rank: 0.0 },
            }
        };
        GroupPlan { flights: (0..count).map(flight).collect(), ..GroupPlan::default() }
    }

    #[test]
    fn files_have_a_bounded_size_and_hold_every_flight_once() {
        let plan = group(4000);
        let mut all = vec![];
        for split in Split::ALL {
            let parts = plan.parts(split, &[200; 4000], 20_000);
            assert!(parts.iter().all(|part| (1..=100).contains(&part.members.len())));
            assert!(parts.iter().enumerate().all(|(number, part)| part.number == number));
            all.extend(parts.into_iter().flat_map(|part| part.members));
        }
        all.sort_unstable();
        assert!(all.into_iter().eq(0..4000));
        // A flight with more frames than a file may have is alone.
        assert_eq!(group(2).parts(plan.flights[0].membership.split, &[500, 500], 100).len(), 2);
    }

    #[test]
    fn a_share_of_zero_gets_nothing() {
        let shares = SplitShares { train: 0.5, val: 0.0, test: 0.5, ..SplitShares::default() };
        assert!((0..500).all(|i| shares.split_of(f64::from(i) / 500.0) != Split::Val));
        let shares = SplitShares { train: 1.0, val: 0.0, test: 0.0, ..SplitShares::default() };
        assert!((0..500).all(|i| shares.split_of(f64::from(i) / 500.0) == Split::Train));
    }

    #[test]
    fn logs_lie_in_folders_of_a_thousand_and_two_of_one_name_are_refused() {
        let mut paths = LogPaths::default();
        let given: Vec<String> = (0..1001).map(|number| paths.next("town", &format!("t{number}")).unwrap()).collect();
        assert_eq!([&given[999], &given[1000]], ["mcap/town/000/t999.mcap", "mcap/town/001/t1000.mcap"]);
        assert!(paths.next("town", "t1").unwrap_err().message.contains("`t1`"));
    }
}
