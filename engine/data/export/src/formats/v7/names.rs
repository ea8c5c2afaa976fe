//! Towns, pairs and traces as folders, the same ones whichever flights are chosen.

use crate::source::Source;
use cosfly_diagnose::{Diagnostic, Fault, Result, counted};
use cosfly_fingerprint::Digest;
use cosfly_read::PublishedFlight;
use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};

/// CARLA's towns of the release; each may carry `_Opt`.
pub const TOWNS: [&str; 8] = ["Town01", "Town02", "Town03", "Town04", "Town05", "Town06", "Town07", "Town10HD"];

/// First number of a trajectory folder: ten digits, like the release's.
const FIRST_ID: u64 = 1_000_000_000;

/// Frames of a trace at most, since each is a folder.
pub const PART_FRAMES: usize = crate::media::FOLDER_LIMIT;

/// Whether readers of the release take `name` for a town.
pub fn is_town(name: &str) -> bool {
    TOWNS.contains(&name.strip_suffix("_Opt").unwrap_or(name))
}

/// A name of CARLA for a town of another name, `TOWN=NAME` as text.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(try_from = "String")]
#[schemars(with = "String")]
pub struct TownName {
    /// Name in the dataset.
    pub town: String,
    /// CARLA's name.
    pub name: String,
}

impl TryFrom<String> for TownName {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        match text.split_once('=').filter(|(town, name)| !town.is_empty() && !name.is_empty()) {
            Some((town, name)) => Ok(Self { town: town.to_owned(), name: name.to_owned() }),
            None => Err(format!("`{text}` is not a town of the dataset and a name for it, such as downtown=Town01")),
        }
    }
}

/// Place of a flight in the layout.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// Folder of the town.
    pub town: String,
    /// Numbers of the pairs that the flight becomes: one for each [`PART_FRAMES`] frames.
    pub ids: Vec<u64>,
    /// Index in `ids` of the pair that this place is in.
    pub part: usize,
    /// 0 for the expert, 1 and more for its twins.
    pub aug_index: usize,
    /// Number of the pedestrian in the town.
    pub path_index: usize,
}

impl Place {
    /// The place of the `part`-th stretch of the flight's frames.
    pub fn of_part(&self, part: usize) -> Self {
        Self { part, ..self.clone() }
    }

    /// Folder of the trace below that of the pair.
    pub fn trace(&self) -> String {
        if self.aug_index == 0 { "ORI".into() } else { format!("aug_{:03}", self.aug_index) }
    }

    /// The whole folder.
    pub fn folder(&self) -> String {
        format!("{}/trajectory_{}/{}", self.town, self.ids[self.part], self.trace())
    }
}

/// The places of all flights that are exported.
#[derive(Clone, Debug, Default)]
pub struct Names {
    /// Town of the dataset -> folder.
    towns: BTreeMap<String, String>,
    places: BTreeMap<String, Place>,
    alone: usize,
    cut: usize,
}

impl Names {
    /// Places for the chosen flights of `source`, with the names `asked` for its towns.
    ///
    /// # Errors
    /// `export-towns` when there are more towns than names, `export-town` for a name that readers do not know,
    /// `export-pairs` when no chosen flight has its twin.
    pub fn of(source: &Source<'_>, asked: &[TownName]) -> Result<Self> {
        let flights = source.dataset.flights();
        let all: BTreeSet<&str> = flights.iter().map(|flight| &*flight.town).collect();
        let mut names = Self { towns: town_names(&all, asked)?, ..Self::default() };
        let (ids, paths) = (pair_ids(flights), path_indices(flights));
        let mut twins: BTreeMap<&str, Vec<&PublishedFlight>> = BTreeMap::new();
        let chosen: BTreeMap<&str, &PublishedFlight> = source.flights().map(|it| (&*it.trajectory_id, it)).collect();
        for flight in source.flights() {
            let twin_of = flight.expert_id.as_deref().and_then(|id| chosen.get(id));
            if let Some(expert) = twin_of.filter(|expert| expert.frames == flight.frames) {
                twins.entry(&expert.trajectory_id).or_default().push(flight);
            }
        }
        for (id, twins) in &twins {
            let family = chosen.get(id).into_iter().chain(twins);
            for (aug_index, flight) in family.enumerate() {
                let place = Place {
                    town: names.towns[&flight.town].clone(),
                    ids: ids[*id].clone(),
                    part: 0,
                    aug_index,
                    path_index: paths[&(flight.town.as_str(), flight.pedestrian_id.as_str())],
                };
                names.places.insert(flight.trajectory_id.clone(), place);
            }
        }
        names.cut = names.places.values().filter(|place| place.ids.len() > 1).count();
        names.alone = chosen.len() - names.places.len();
        if names.places.is_empty() {
            let message = "v7 holds pairs of an expert's flight and its perturbed twin; none was chosen";
            return Err(Diagnostic::new("export-pairs", Fault::Recipe, message)
                .hint("choose both flights, or give the recipe a `perturb` stage and make the dataset again"));
        }
        let used: BTreeSet<&str> = twins.keys().map(|id| &*chosen[id].town).collect();
        names.towns.retain(|town, _| used.contains(town.as_str()));
        Ok(names)
    }

    /// The place of a flight; none when it is left out.
    pub fn place(&self, trajectory_id: &str) -> Option<&Place> {
        self.places.get(trajectory_id)
    }

    /// Folder and name of every town.
    pub fn towns(&self) -> impl Iterator<Item = (&str, &str)> {
        self.towns.iter().map(|(town, folder)| (folder.as_str(), town.as_str()))
    }

    /// Remarks for the user.
    pub fn remarks(&self) -> Vec<String> {
        let renamed = self.towns.iter().filter(|(town, folder)| town != folder);
        let mut remarks: Vec<String> = renamed
            .map(|(town, folder)| {
                format!("town `{town}` is called `{folder}` here, since readers look for CARLA's towns; `--town {town}=NAME` gives it another name")
            })
            .collect();
        if self.cut > 0 {
            remarks.push(format!(
                "{} of more than {PART_FRAMES} frames cut into several trajectories: hosts of datasets refuse larger folders",
                flights(self.cut)
            ));
        }
        if self.alone > 0 {
            remarks.push(format!(
                "{} without a chosen twin of the same length left out: v7 holds pairs",
                flights(self.alone)
            ));
        }
        remarks
    }
}

fn flights(count: usize) -> String {
    format!("{count} flight{}", if count == 1 { "" } else { "s" })
}

/// Folders of all towns: what was asked for, CARLA's own names, then names that are free, in order.
fn town_names(towns: &BTreeSet<&str>, asked: &[TownName]) -> Result<BTreeMap<String, String>> {
    let mut names: BTreeMap<String, String> = BTreeMap::new();
    for TownName { town, name } in asked {
        let message = match (towns.contains(town.as_str()), is_town(name)) {
            (false, _) => format!("the dataset has no town `{town}`"),
            (true, false) => format!("`{name}` is not the name of a CARLA town"),
            (true, true) if names.values().any(|taken| taken == name) => format!("two towns cannot both be `{name}`"),
            (true, true) => {
                names.insert(town.clone(), name.clone());
                continue;
            }
        };
        let listed: Vec<_> = towns.iter().map(|town| format!("`{town}`")).collect();
        return Err(Diagnostic::new("export-town", Fault::Recipe, message)
            .hint(format!("its towns are {}", listed.join(", ")))
            .hint(format!("readers of v7 know {}, each with or without `_Opt`", TOWNS.join(", "))));
    }
    let is_free = |names: &BTreeMap<String, String>, name: &str| !names.values().any(|taken| taken == name);
    for town in towns.iter().filter(|town| is_town(town)) {
        if !names.contains_key(*town) && is_free(&names, town) {
            names.insert((*town).to_owned(), (*town).to_owned());
        }
    }
    let family = |name: &str| name.strip_suffix("_Opt").unwrap_or(name).to_owned();
    for town in towns {
        if names.contains_key(*town) {
            continue;
        }
        let free = TOWNS.iter().find(|name| names.values().all(|taken| family(taken) != **name));
        let Some(free) = free else {
            let message =
                format!("the dataset has {}; v7 has {} names for them", counted(towns.len(), "town"), TOWNS.len());
            return Err(Diagnostic::new("export-towns", Fault::Recipe, message)
                .hint("give them names with `--town NAME=Town01_Opt` and the like, or export in another format"));
        };
        names.insert((*town).to_owned(), (*free).to_owned());
    }
    Ok(names)
}

/// Numbers of ten digits for every expert, from its name and town: one per part.
fn pair_ids(flights: &[PublishedFlight]) -> BTreeMap<String, Vec<u64>> {
    let mut taken = BTreeSet::new();
    let mut ids = BTreeMap::new();
    for expert in flights.iter().filter(|flight| flight.expert_id.is_none()) {
        let mut id_of = |part: usize| {
            let part = if part == 0 { String::new() } else { format!("/{part}") };
            let digest = Digest::of(format!("{}/{}{part}", expert.town, expert.trajectory_id).as_bytes()).0;
            let mut id = FIRST_ID + u64::from(u32::from_le_bytes([digest[0], digest[1], digest[2], digest[3]]));
            while !taken.insert(id) {
                id += 1;
            }
            id
        };
        let parts = expert.frames.div_ceil(PART_FRAMES).max(1);
        ids.insert(expert.trajectory_id.clone(), (0..parts).map(&mut id_of).collect());
    }
    ids
}

/// Numbers of the pedestrians of every town, by their names.
fn path_indices(flights: &[PublishedFlight]) -> BTreeMap<(&str, &str), usize> {
    let people: BTreeSet<(&str, &str)> = flights.iter().map(|it| (&*it.town, &*it.pedestrian_id)).collect();
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    people
        .into_iter()
        .map(|person| {
            let count = counts.entry(person.0).or_default();
            *count += 1;
            (person, *count - 1)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(towns: &[&str], asked: &[(&str, &str)]) -> Result<Vec<String>> {
        let named = |(town, name): &(&str, &str)| TownName { town: (*town).into(), name: (*name).into() };
        let asked: Vec<_> = asked.iter().map(named).collect();
        town_names(&towns.iter().copied().collect(), &asked).map(|names| names.into_values().collect())
    }

    #[test]
    fn carla_towns_keep_their_names_and_others_get_free_ones() {
        assert_eq!(named(&["Town01", "downtown", "suburb"], &[]).unwrap(), ["Town01", "Town02", "Town03"]);
        assert_eq!(named(&["Town01_Opt", "downtown"], &[]).unwrap(), ["Town01_Opt", "Town02"]);
        assert_eq!(named(&["a", "b"], &[("b", "Town01")]).unwrap(), ["Town02", "Town01"]);
    }

    #[test]
    fn names_that_readers_would_not_find_are_refused() {
        assert_eq!(named(&["a"], &[("a", "Paris")]).unwrap_err().code, "export-town");
        assert_eq!(named(&["a"], &[("c", "Town01")]).unwrap_err().code, "export-town");
        assert_eq!(named(&["a", "b"], &[("a", "Town01"), ("b", "Town01")]).unwrap_err().code, "export-town");
        assert_eq!(named(&["1", "2", "3", "4", "5", "6", "7", "8", "9"], &[]).unwrap_err().code, "export-towns");
    }
}
