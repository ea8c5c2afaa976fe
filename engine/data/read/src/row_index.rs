//! Where the rows of each trajectory are in a table: a few bytes per trajectory, for reading some of them.

use super::dataset::PublishedDataset;
use super::rows::{Rows, TableFile};
use cosfly_diagnose::Result;
use cosfly_schema::tables::Frames;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

/// Files and row groups of the trajectories, by numbers that the caller gives to ids.
#[derive(Clone, Debug, Default)]
pub struct RowIndex {
    files: Vec<PathBuf>,
    /// File, first and last row group.
    places: Vec<Option<(u32, u32, u32)>>,
    /// Numbers of the trajectories in each file: from one offset to the next.
    numbers: Vec<u32>,
    offsets: Vec<usize>,
}

impl PublishedDataset {
    /// Places of the rows of all trajectories in a table, by their places in [`Self::flights`].
    ///
    /// # Errors
    /// Damage of the table.
    pub fn row_index(&self, table: &str) -> Result<RowIndex> {
        let mut index = RowIndex::default();
        for (_, path) in self.files(table)? {
            index.add(path, &|id| self.place(id))?;
        }
        Ok(index)
    }
}

impl RowIndex {
    /// Adds a file of the table; reads the column `trajectory_id` only. Of a trajectory in several files the first counts.
    /// Returns the ids that have no number.
    ///
    /// # Errors
    /// Damage of the file.
    pub fn add(&mut self, path: PathBuf, number_of: &dyn Fn(&str) -> Option<usize>) -> Result<BTreeSet<String>> {
        let number_of_file = self.files.len() as u32;
        if self.offsets.is_empty() {
            self.offsets.push(0);
        }
        let mut found: BTreeMap<usize, (u32, u32)> = BTreeMap::new();
        let mut unknown = BTreeSet::new();
        let file = TableFile::open(&path)?;
        for group in 0..file.groups() {
            let rows = file.group(group)?;
            let ids = rows.values(Frames::trajectory_id)?;
            let mut last = None;
            for row in 0..rows.len() {
                let id = ids.text(row);
                if last != Some(id) {
                    last = Some(id);
                    match number_of(id) {
                        Some(number) => found.entry(number).or_insert((group as u32, 0)).1 = group as u32,
                        None => drop(unknown.insert(id.to_owned())),
                    }
                }
            }
        }
        drop(file);
        for (number, (first, last)) in found {
            if self.places.len() <= number {
                self.places.resize(number + 1, None);
            }
            self.places[number].get_or_insert((number_of_file, first, last));
            self.numbers.push(number as u32);
        }
        self.offsets.push(self.numbers.len());
        self.files.push(path);
        Ok(unknown)
    }

    /// Files, in the order in which they were added.
    pub fn files(&self) -> &[PathBuf] {
        &self.files
    }

    /// Numbers of the trajectories in a file.
    pub fn numbers_in(&self, file: usize) -> &[u32] {
        self.offsets.get(file..=file + 1).map_or(&[], |ends| &self.numbers[ends[0]..ends[1]])
    }

    /// The trajectories whose rows begin and end in the same row groups as those of `number`.
    pub fn beside(&self, number: usize) -> BTreeSet<usize> {
        let Some(place) = self.places.get(number).copied().flatten() else { return BTreeSet::new() };
        let numbers = self.numbers_in(place.0 as usize).iter().map(|it| *it as usize);
        numbers.filter(|it| self.places[*it] == Some(place)).collect()
    }

    /// Whether the table has rows of a trajectory.
    pub fn has(&self, number: usize) -> bool {
        self.places.get(number).is_some_and(Option::is_some)
    }

    /// Calls `visit` with each row group that holds a wanted trajectory, in the order of files and groups.
    ///
    /// # Errors
    /// Damage of a file, or an error of `visit`.
    pub fn visit(&self, wanted: &BTreeSet<usize>, visit: &mut dyn FnMut(&Rows<'_>, &Path) -> Result<()>) -> Result<()> {
        let mut groups: BTreeMap<u32, BTreeSet<u32>> = BTreeMap::new();
        for number in wanted {
            if let Some((file, first, last)) = self.places.get(*number).copied().flatten() {
                groups.entry(file).or_default().extend(RangeInclusive::new(first, last));
            }
        }
        for (file, groups) in groups {
            let path = &self.files[file as usize];
            let file = TableFile::open(path)?;
            groups.into_iter().try_for_each(|group| visit(&file.group(group as usize)?, path))?;
        }
        Ok(())
    }
}
