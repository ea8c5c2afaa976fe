//! Leaks between splits.

use crate::{Episode, Flag};
use cosfly_frames::DVec3;
use std::collections::BTreeMap;

/// Largest distance between points of two walks that count as the same walk, metres.
const SAME_M: f64 = 1.0;
/// Number of points of a walk that are compared.
const POINTS: usize = 16;
/// Number of pairs that are named.
const NAMED: usize = 5;

/// Finds episodes, pedestrians and walks that are in more than one split.
pub fn of_all(episodes: &[Episode]) -> Vec<Flag> {
    let mut flags = vec![];
    shared(episodes, "episode", &|it| it.id.clone(), &mut flags);
    shared(episodes, "pedestrian or scenario", &|it| format!("{}/{}", it.place, it.group), &mut flags);
    same_ways(episodes, &mut flags);
    flags
}

fn shared(episodes: &[Episode], what: &str, key: &dyn Fn(&Episode) -> String, flags: &mut Vec<Flag>) {
    let mut first: BTreeMap<String, &Episode> = BTreeMap::new();
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

/// Finds equal walks in one place under two names.
fn same_ways(episodes: &[Episode], flags: &mut Vec<Flag>) {
    let mut starts: BTreeMap<(&str, i64, i64), Vec<usize>> = BTreeMap::new();
    let ways: Vec<Vec<DVec3>> = episodes.iter().map(way).collect();
    let mut named = 0;
    for (at, episode) in episodes.iter().enumerate() {
        let Some(start) = ways[at].first() else { continue };
        let [x, y] = [start.x, start.y].map(|it| (it / SAME_M).floor() as i64);
        let near = (-1..=1).flat_map(|i| (-1..=1).map(move |j| (x + i, y + j)));
        let near = near.filter_map(|(x, y)| starts.get(&(episode.place.as_str(), x, y))).flatten();
        let twin = near.copied().find(|other| {
            let other_one = &episodes[*other];
            let split_differs = episode.split.is_some() && other_one.split != episode.split;
            split_differs && other_one.group != episode.group && is_same(&ways[at], &ways[*other])
        });
        if let Some(other) = twin.filter(|_| named < NAMED) {
            named += 1;
            let (a, b) = (&episodes[other], episode);
            let message = format!(
                "its target walks the way of `{}`, which is in `{}`; this one is in `{}`",
                a.id,
                a.split.as_deref().unwrap_or_default(),
                b.split.as_deref().unwrap_or_default()
            );
            flags.push(Flag::damage("split-leak", &b.id, message));
        }
        starts.entry((episode.place.as_str(), x, y)).or_default().push(at);
    }
}

fn way(episode: &Episode) -> Vec<DVec3> {
    let count = episode.moments.len();
    let points = (0..POINTS).map(|at| at * count.saturating_sub(1) / (POINTS - 1));
    points.filter_map(|at| episode.moments.get(at)?.target_in_world).collect()
}

fn is_same(a: &[DVec3], b: &[DVec3]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.distance(*b) <= SAME_M)
}
