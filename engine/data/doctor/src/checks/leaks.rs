//! Leaks between splits.

use cosfly_episodes::{ExaminedEpisode, Flag};
use cosfly_frames::DVec3;
use std::collections::BTreeMap;

/// Largest distance between points of two walks that count as the same walk, metres.
const SAME_M: f64 = 1.0;
/// Number of points of a walk that are compared.
const POINTS: usize = 16;
/// Number of earlier walks that a walk is compared with before it is noted.
const RECENT: usize = 64;
/// Number of pairs that are named.
const NAMED: usize = 5;

/// Traces of an episode that show leaks.
pub struct Trace {
    id: String,
    split: Option<String>,
    group: String,
    place: String,
    /// Name of the town; empty where it is unknown.
    town: String,
    /// Some points of the target's walk, metres.
    way: Vec<[f32; 3]>,
}

impl Trace {
    /// The trace of an episode.
    pub fn of(episode: &ExaminedEpisode) -> Self {
        Self {
            id: episode.id.clone(),
            split: episode.split.clone(),
            group: episode.group.clone(),
            place: episode.place.clone(),
            town: episode.town.clone(),
            way: way(episode).into_iter().map(|point| point.as_vec3().to_array()).collect(),
        }
    }

    /// Name of the town; empty where it is unknown.
    pub fn town(&self) -> &str {
        &self.town
    }

    /// Some places of the target's walk: x and y, metres.
    pub fn places(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        self.way.iter().map(|[x, y, _]| [f64::from(*x), f64::from(*y)])
    }

    /// Name of the episode.
    pub fn id(&self) -> &str {
        &self.id
    }
}

/// Finds episodes, pedestrians and walks that are in more than one split.
pub fn of_all(episodes: &[Trace]) -> Vec<Flag> {
    let mut flags = vec![];
    shared(episodes, "episode", &|it| it.id.clone(), &mut flags);
    shared(episodes, "pedestrian or scenario", &|it| format!("{}/{}", it.place, it.group), &mut flags);
    same_ways(episodes, &mut flags);
    flags
}

fn shared(episodes: &[Trace], what: &str, key: &dyn Fn(&Trace) -> String, flags: &mut Vec<Flag>) {
    let mut first: BTreeMap<String, &Trace> = BTreeMap::new();
    let mut leaks: BTreeMap<String, (&str, &str)> = BTreeMap::new();
    for episode in episodes {
        let Some(split) = &episode.split else { continue };
        let seen = first.entry(key(episode)).or_insert(episode);
        if let Some(other) = seen.split.as_ref().filter(|other| *other != split) {
            leaks.entry(key(episode)).or_insert((other, split));
        }
    }
    for (key, (a, b)) in leaks.iter().take(NAMED) {
        flags.push(Flag::damage("split-leak", key, format!("this {what} is in `{a}` and in `{b}`")));
    }
    if leaks.len() > NAMED {
        let message = format!("{} more of them are in several splits ({what})", leaks.len() - NAMED);
        flags.push(Flag::damage("split-leak", "splits", message));
    }
}

/// Finds equal walks in one place under two names, walked the same way or back.
fn same_ways(episodes: &[Trace], flags: &mut Vec<Flag>) {
    let mut starts: BTreeMap<(&str, i64, i64), Vec<usize>> = BTreeMap::new();
    let mut named = 0;
    for (at, episode) in episodes.iter().enumerate() {
        let Some(start) = episode.way.first() else { continue };
        if named == NAMED {
            break;
        }
        let back: Vec<[f32; 3]> = episode.way.iter().rev().copied().collect();
        let twin = [(&episode.way, ""), (&back, " back")].into_iter().find_map(|(way, direction)| {
            let (x, y) = cell_of(way.first()?);
            let near = (-1..=1).flat_map(|i| (-1..=1).map(move |j| (x + i, y + j)));
            let mut near = near.filter_map(|(x, y)| starts.get(&(episode.place.as_str(), x, y))).flatten();
            let is_twin = |other: &&usize| {
                let other = &episodes[**other];
                let split_differs = episode.split.is_some() && other.split != episode.split;
                split_differs && other.group != episode.group && is_same(way, &other.way)
            };
            near.find(is_twin).map(|other| (*other, direction))
        });
        if let Some((other, direction)) = twin {
            named += 1;
            let (a, b) = (&episodes[other], episode);
            let message = format!(
                "its target walks the way of `{}`{direction}, which is in `{}`; this one is in `{}`",
                a.id,
                a.split.as_deref().unwrap_or_default(),
                b.split.as_deref().unwrap_or_default()
            );
            flags.push(Flag::damage("split-leak", &b.id, message));
        }
        // Flights of one split behind one walk are alike: the first stands for all.
        let (x, y) = cell_of(start);
        let others = starts.entry((episode.place.as_str(), x, y)).or_default();
        let is_known = |other: &usize| {
            let other = &episodes[*other];
            (&other.split, &other.group) == (&episode.split, &episode.group) && other.way == episode.way
        };
        if !others.iter().rev().take(RECENT).any(is_known) {
            others.push(at);
        }
    }
}

fn cell_of(point: &[f32; 3]) -> (i64, i64) {
    let [x, y] = [point[0], point[1]].map(|it| (f64::from(it) / SAME_M).floor() as i64);
    (x, y)
}

fn way(episode: &ExaminedEpisode) -> Vec<DVec3> {
    let count = episode.moments.len();
    let points = (0..POINTS).map(|at| at * count.saturating_sub(1) / (POINTS - 1));
    points.filter_map(|at| episode.moments.get(at)?.target_in_world).collect()
}

fn is_same(a: &[[f32; 3]], b: &[[f32; 3]]) -> bool {
    let vector = |point: &[f32; 3]| DVec3::from_array(point.map(f64::from));
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| vector(a).distance(vector(b)) <= SAME_M)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trace(id: &str, split: &str, way: Vec<[f32; 3]>) -> Trace {
        let (id, group) = (id.to_owned(), id.to_owned());
        Trace { id, split: Some(split.to_owned()), group, place: "town".to_owned(), town: String::new(), way }
    }

    #[test]
    fn a_walk_in_two_splits_is_found_in_both_directions_and_beside_it_none_is() {
        let way = |from: f32, to: f32, y: f32| -> Vec<[f32; 3]> {
            (0..POINTS).map(|at| [from + (to - from) * at as f32 / (POINTS - 1) as f32, y, 0.0]).collect()
        };
        let found = |other: Vec<[f32; 3]>, split: &str| {
            let flags = of_all(&[trace("a", "train", way(3.0, 60.0, 5.0)), trace("b", split, other)]);
            flags.into_iter().map(|flag| flag.message).collect::<Vec<String>>()
        };
        assert!(found(way(3.4, 60.4, 5.5), "test")[0].starts_with("its target walks the way of `a`, which"));
        assert!(found(way(60.4, 3.4, 5.5), "test")[0].starts_with("its target walks the way of `a` back, which"));
        assert!(found(way(60.4, 3.4, 5.5), "train").is_empty());
        assert!(found(way(3.0, 60.0, 7.0), "test").is_empty());
        assert!(found(way(60.0, 3.0, 7.0), "test").is_empty());
    }
}
