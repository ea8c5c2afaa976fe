//! Decides which split, which file and which folder every trajectory goes to.

use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_schema::LogRecord;
use cosfly_schema::Split;
use cosfly_schema::config::DatasetConfig;
use cosfly_splits::Assignment;
use std::collections::{BTreeMap, BTreeSet};

/// Logs in one folder; hosts of datasets refuse folders with many thousand files.
const LOGS_PER_FOLDER: usize = 1_000;

/// Where everything goes; computed from the log records alone.
#[derive(Clone, Debug)]
pub struct DatasetPlan {
    /// Split of each trajectory.
    pub splits: Vec<Split>,
    /// Path of each trajectory's log.
    pub mcap_paths: Vec<String>,
    frames: Vec<u64>,
    frames_per_file: u64,
}

impl DatasetPlan {
    /// Plans a dataset of the trajectories of `logs`, in their order.
    pub fn new(config: &DatasetConfig, logs: &[&LogRecord], assignment: &Assignment) -> Result<Self> {
        let mut seen = BTreeSet::new();
        let mut per_town: BTreeMap<&str, usize> = BTreeMap::new();
        let mut mcap_paths = vec![];
        for log in logs {
            if !seen.insert(&log.trajectory_id) {
                let message = format!("two trajectories are called `{}`", log.trajectory_id);
                return Err(Diagnostic::new("dataset-duplicate", Fault::Recipe, message)
                    .hint("ids begin with the stage that a flight comes from: give every chain stages of its own"));
            }
            let number = per_town.entry(&log.town).or_default();
            let folder = *number / LOGS_PER_FOLDER;
            *number += 1;
            mcap_paths.push(format!("mcap/{}/{folder:03}/{}.mcap", log.town, log.trajectory_id));
        }
        Ok(Self {
            splits: assignment.splits.clone(),
            mcap_paths,
            frames: logs.iter().map(|log| log.frames).collect(),
            frames_per_file: u64::from(config.frames_per_file.max(1)),
        })
    }

    /// The splits that have trajectories.
    pub fn used_splits(&self) -> Vec<Split> {
        Split::ALL.into_iter().filter(|split| self.splits.contains(split)).collect()
    }

    /// The files of a table: split, path, and the trajectories whose rows it holds.
    pub fn files(&self, table: &str, per_frame: bool) -> Vec<(Split, String, Vec<usize>)> {
        let mut files = vec![];
        for split in self.used_splits() {
            let members: Vec<usize> = (0..self.splits.len()).filter(|i| self.splits[*i] == split).collect();
            let shards = if per_frame { self.shards(&members) } else { vec![members] };
            let count = shards.len();
            files.extend(shards.into_iter().enumerate().map(|(number, shard)| {
                (split, format!("data/{table}/{}-{number:05}-of-{count:05}.parquet", split.name()), shard)
            }));
        }
        files
    }

    /// Consecutive trajectories with about `frames_per_file` frames together.
    fn shards(&self, members: &[usize]) -> Vec<Vec<usize>> {
        let mut shards: Vec<Vec<usize>> = vec![vec![]];
        let mut frames = 0;
        for member in members {
            if frames > 0 && frames + self.frames[*member] > self.frames_per_file {
                shards.push(vec![]);
                frames = 0;
            }
            frames += self.frames[*member];
            shards.last_mut().expect("there is always one shard").push(*member);
        }
        shards
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_frames::Seed;
    use cosfly_schema::Role;
    use cosfly_schema::config::SplitShares;

    fn log(id: usize, pedestrian: usize) -> LogRecord {
        LogRecord {
            trajectory_id: format!("t{id}"),
            role: Role::Expert,
            pedestrian_id: format!("p{pedestrian:05}"),
            town: "town".into(),
            frames: 200,
            messages: 0,
            bytes: 0,
            sha256: String::new(),
        }
    }

    fn drawn(logs: &[LogRecord]) -> Assignment {
        let shares = SplitShares::default();
        let draw = |log: &LogRecord| Seed::of_item(0, "split", &log.pedestrian_id).stream("split").unit();
        Assignment {
            splits: logs.iter().map(|log| shares.split_of(draw(log))).collect(),
            groups: vec![],
            subset_ranks: vec![],
        }
    }

    #[test]
    fn splits_have_about_their_shares_and_files_a_bounded_size() {
        let logs: Vec<LogRecord> = (0..4000).map(|i| log(i, i / 2)).collect();
        let assignment = drawn(&logs);
        let plan = DatasetPlan::new(&DatasetConfig::default(), &logs.iter().collect::<Vec<_>>(), &assignment).unwrap();
        let train = plan.splits.iter().filter(|split| **split == Split::Train).count();
        assert!((3100..3300).contains(&train), "{train}");
        let files = plan.files("frames", true);
        assert!(files.iter().all(|(_, _, members)| (1..=100).contains(&members.len())));
        assert_eq!(files.iter().map(|file| file.2.len()).sum::<usize>(), 4000);
        assert_eq!(plan.mcap_paths[3999], "mcap/town/003/t3999.mcap");
    }

    #[test]
    fn a_share_of_zero_gets_nothing() {
        let shares = SplitShares { train: 0.5, val: 0.0, test: 0.5, ..SplitShares::default() };
        assert!((0..500).all(|i| shares.split_of(f64::from(i) / 500.0) != Split::Val));
        let shares = SplitShares { train: 1.0, val: 0.0, test: 0.0, ..SplitShares::default() };
        assert!((0..500).all(|i| shares.split_of(f64::from(i) / 500.0) == Split::Train));
    }

    #[test]
    fn two_trajectories_of_one_name_are_refused() {
        let (a, b) = (log(1, 1), log(1, 2));
        let assignment = drawn(&[a.clone(), b.clone()]);
        let error = DatasetPlan::new(&DatasetConfig::default(), &[&a, &b], &assignment).unwrap_err();
        assert!(error.message.contains("`t1`"));
    }
}
