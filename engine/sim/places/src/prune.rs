//! Trees beside houses are cut back: no crown reaches into a wall or a roof.

use crate::geometry::{bounds, contains, disc, edges, segment_distance_m};
use crate::things::{Footprint, GeneratedThing, ThingKind};
use cosfly_frames::DVec2;

/// From a crown to the wall beside it, metres.
const GAP_M: f64 = 0.1;
/// Corners of the boxes that stand for a crown, as a share of its radius.
const CORNERS: f64 = 1.1;
/// A tree whose crown would be narrower goes; radius, metres.
const LEAST_CROWN_M: f64 = 0.8;

/// Makes crowns narrower beside buildings, and takes trees away that have no room.
pub fn prune(things: &mut Vec<GeneratedThing>) {
    let buildings = outlines_of_buildings(things);
    things.retain_mut(|thing| {
        let at = thing.footprint.center();
        let Some((_, text)) = thing.data.iter_mut().find(|(code, _)| *code == "crown_radius") else { return true };
        let Ok(crown_m) = text.parse::<f64>() else { return true };
        let room_m = (room_m(at, CORNERS * crown_m + GAP_M, &buildings) - GAP_M) / CORNERS;
        if room_m < crown_m {
            *text = format!("{:.2}", (100.0 * room_m).floor() / 100.0);
        }
        room_m >= crown_m.min(LEAST_CROWN_M)
    });
}

/// Outlines of all buildings.
fn outlines_of_buildings(things: &[GeneratedThing]) -> Vec<Vec<DVec2>> {
    let buildings = things.iter().filter(|thing| thing.kind == ThingKind::Building);
    buildings
        .map(|thing| match &thing.footprint {
            Footprint::Rectangle(lot) => lot.corners().to_vec(),
            Footprint::Polygon(corners) => corners.clone(),
            Footprint::Disc { center, radius_m } => disc(*center, *radius_m, 16),
        })
        .collect()
}

/// Distance to the nearest building, metres: at most `reach_m`, and 0 within one.
fn room_m(at: DVec2, reach_m: f64, buildings: &[Vec<DVec2>]) -> f64 {
    let mut room_m = reach_m;
    for outline in buildings {
        let [low, high] = bounds(outline);
        if low.cmpgt(at + room_m).any() || high.cmplt(at - room_m).any() {
            continue;
        }
        if contains(outline, at) {
            return 0.0;
        }
        room_m = edges(outline).map(|edge| segment_distance_m([at, at], edge)).fold(room_m, f64::min);
    }
    room_m
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinds::ALL;
    use cosfly_frames::Seed;
    use std::collections::BTreeMap;

    #[test]
    fn crowns_of_all_kinds_end_beside_houses_and_few_trees_go() {
        for kind in ALL.iter().filter(|kind| kind.name != "grid") {
            for seed in 1..6 {
                let mut things = (kind.build)(&kind.settings(&BTreeMap::new()).unwrap(), Seed([seed; 32])).things;
                let trees = |things: &[GeneratedThing]| things.iter().filter(|it| it.kind == ThingKind::Tree).count();
                let before = trees(&things);
                prune(&mut things);
                assert!(trees(&things) * 20 > before * 19, "{}: {} of {before} trees", kind.name, trees(&things));
                let buildings = outlines_of_buildings(&things);
                for tree in things.iter().filter(|thing| thing.kind == ThingKind::Tree) {
                    let crown_m: f64 = tree.data[0].1.parse().unwrap();
                    let room_m = room_m(tree.footprint.center(), 9.0, &buildings);
                    assert!(
                        crown_m >= LEAST_CROWN_M && room_m >= crown_m + GAP_M,
                        "{}: {tree:?}, {room_m} m",
                        kind.name
                    );
                }
            }
        }
    }
}
