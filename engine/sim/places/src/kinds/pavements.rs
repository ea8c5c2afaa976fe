//! Lamps, trees and benches on the pavements.

use crate::lot::Lot;
use crate::site::{Site, tree};
use crate::things::{Footprint, GeneratedThing, ThingKind};
use cosfly_frames::{DVec2, RandomStream};

/// Ends of a street that stay free for crossings, metres.
const FREE_END_M: f64 = 6.0;
/// Distance of trunks and lamps from the kerb, metres.
const KERB_GAP_M: f64 = 0.6;
/// Distance between lamps, metres.
const LAMPS_M: f64 = 27.0;
/// Trees stand on pavements of at least this width, metres.
const WITH_TREES_M: f64 = 2.6;

/// Things on the pavements.
pub struct Furniture {
    /// Share of the street sides that are lined with trees.
    pub tree_share: f64,
    /// Radius of their crowns, metres.
    pub crown_m: f64,
    /// Height of lamps, metres.
    pub lamp_m: f64,
}

impl Furniture {
    /// Furnishes all pavements.
    pub fn put(&self, site: &mut Site, stream: &mut RandomStream) {
        for street in site.network.streets.clone() {
            let (line, profile) = (&street.line, street.profile);
            let end_m = line.length_m() - FREE_END_M;
            for side in [1.0, -1.0] {
                let spot = |s_m: f64, from_kerb_m: f64| {
                    line.pose_at(s_m).moved(0.0, side * (profile.carriageway_m() + from_kerb_m))
                };
                let is_lined = profile.sidewalk_m >= WITH_TREES_M && stream.chance(self.tree_share);
                let mut s_m = FREE_END_M + stream.uniform(0.5, 5.0);
                let mut next_lamp_m = s_m;
                while s_m < end_m {
                    if s_m >= next_lamp_m {
                        let foot = Footprint::Disc { center: spot(s_m, KERB_GAP_M - 0.2).at, radius_m: 0.08 };
                        site.things.push(GeneratedThing::new(ThingKind::Lamp, foot, self.lamp_m));
                        next_lamp_m += LAMPS_M;
                    } else if is_lined {
                        site.things.push(tree(spot(s_m, KERB_GAP_M).at, self.crown_m, stream));
                    }
                    s_m += if is_lined { stream.uniform(2.4, 3.2) * self.crown_m.max(2.0) } else { LAMPS_M };
                }
                if profile.sidewalk_m >= WITH_TREES_M && end_m > FREE_END_M && stream.chance(0.3) {
                    let pose = spot(stream.uniform(FREE_END_M, end_m), profile.sidewalk_m - 0.4);
                    let lot = Lot { center: pose.at, half_m: DVec2::new(0.9, 0.25), heading_rad: pose.heading_rad };
                    site.things.push(GeneratedThing::on_lot(ThingKind::Bench, lot, 0.8));
                }
            }
        }
    }
}
