//! Street trees, lamps, benches and bus shelters on the pavements.

use super::GenerateConfig;
use super::blocks::tree_at;
use super::streets::{Network, Street};
use crate::lot::Lot;
use crate::things::{Footprint, GeneratedThing, ThingKind};
use cosfly_frames::{RandomStream, Seed};

/// Ends of a street that stay free for crossings, metres.
const FREE_END_M: f64 = 6.5;
/// Distance of trunks and lamps from the kerb, metres.
const KERB_GAP_M: f64 = 0.7;

/// Furnishes every pavement.
pub fn furnish(network: &Network, config: &GenerateConfig, seed: Seed) -> Vec<GeneratedThing> {
    let mut things = Vec::new();
    for (index, street) in network.streets.iter().enumerate() {
        for (side_index, side) in [1.0, -1.0].into_iter().enumerate() {
            let mut stream = seed.child("street", 2 * index as u64 + side_index as u64).stream("furniture");
            furnish_side(street, side, config, &mut stream, &mut things);
        }
    }
    things
}

fn furnish_side(
    street: &Street,
    side: f64,
    config: &GenerateConfig,
    stream: &mut RandomStream,
    things: &mut Vec<GeneratedThing>,
) {
    let end_m = street.line.length_m() - FREE_END_M;
    let curb_m = street.profile.carriageway_m();
    let mut taken = Vec::new();
    let spot = |s_m: f64, from_curb_m: f64| street.line.pose_at(s_m).moved(0.0, side * (curb_m + from_curb_m));
    let standing = |kind, s_m: f64, from_curb_m: f64, size: [f64; 2], height_m: f64| {
        let pose = spot(s_m, from_curb_m);
        let half_m = 0.5 * cosfly_frames::DVec2::from(size);
        GeneratedThing::on_lot(kind, Lot { center: pose.at, half_m, heading_rad: pose.heading_rad }, height_m)
    };
    if end_m - FREE_END_M > 14.0 && stream.chance(0.12) {
        let s_m = stream.uniform(FREE_END_M + 4.0, end_m - 4.0);
        things.push(standing(ThingKind::BusStop, s_m, street.profile.sidewalk_m - 0.8, [4.0, 1.4], 2.6));
        taken.push((s_m, 4.0));
    }
    let mut s_m = FREE_END_M + stream.uniform(0.5, 8.0);
    while s_m < end_m {
        let footprint = Footprint::Disc { center: spot(s_m, KERB_GAP_M - 0.2).at, radius_m: 0.08 };
        things.push(GeneratedThing::new(ThingKind::Lamp, footprint, 6.5));
        taken.push((s_m, 2.0));
        s_m += 26.0;
    }
    let is_lined = stream.chance(config.tree_density);
    s_m = FREE_END_M + stream.uniform(0.0, 3.0);
    while is_lined && s_m < end_m {
        if taken.iter().all(|&(at_m, gap_m): &(f64, f64)| (at_m - s_m).abs() > gap_m) {
            things.push(tree_at(spot(s_m, KERB_GAP_M).at, stream));
        }
        s_m += stream.uniform(7.0, 10.0);
    }
    if stream.chance(0.45) && end_m > FREE_END_M {
        let s_m = stream.uniform(FREE_END_M, end_m);
        if taken.iter().all(|&(at_m, gap_m)| gap_m < 3.0 || (at_m - s_m).abs() > gap_m) {
            things.push(standing(ThingKind::Bench, s_m, street.profile.sidewalk_m - 0.45, [1.8, 0.5], 0.8));
        }
    }
}
