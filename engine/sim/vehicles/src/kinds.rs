//! Kinds of vehicles in traffic: sizes, limits, mix.

use crate::config::MixConfig;
use cosfly_domain::{BodyKind, Driving, LaneKind};
use cosfly_frames::{DVec3, RandomStream};

/// Sizes and limits of a kind; those of a car for what does not drive.
pub(crate) fn driving(kind: BodyKind) -> &'static Driving {
    kind.row().driving.as_ref().or(BodyKind::Car.row().driving.as_ref()).expect("cars drive")
}

/// Length, width and height, metres.
pub(crate) fn size_m(kind: BodyKind, random: &mut RandomStream) -> DVec3 {
    let [length, width, height] = driving(kind).sizes_m;
    let mut draw = |[low, high]: [f64; 2]| random.uniform(low, high);
    DVec3::new(draw(length), draw(width), draw(height))
}

/// A kind by the shares of the mix.
pub(crate) fn draw_kind(mix: &MixConfig, random: &mut RandomStream) -> BodyKind {
    let MixConfig { cars, vans, trucks, buses, motorcycles, bicycles, e_scooters } = *mix;
    let shares = [
        (BodyKind::Car, cars),
        (BodyKind::Van, vans),
        (BodyKind::Truck, trucks),
        (BodyKind::Bus, buses),
        (BodyKind::Motorcycle, motorcycles),
        (BodyKind::Bicycle, bicycles),
        (BodyKind::EScooter, e_scooters),
    ];
    let mut left = random.unit() * shares.iter().map(|(_, share)| share).sum::<f64>();
    let drawn = shares.into_iter().find(|(_, share)| {
        left -= share;
        left < 0.0
    });
    drawn.map_or(BodyKind::Car, |(kind, _)| kind)
}

/// Whether a kind of vehicle drives on a kind of lane.
pub(crate) fn drives_on(kind: BodyKind, lane: LaneKind) -> bool {
    lane == LaneKind::Driving || keeps_to_edges(kind)
}

/// Whether a kind rides at the edge of lanes that it shares, and on those of bicycles.
pub(crate) fn keeps_to_edges(kind: BodyKind) -> bool {
    matches!(kind, BodyKind::Bicycle | BodyKind::EScooter)
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_frames::Seed;

    #[test]
    fn e_scooters_come_by_their_share_and_change_no_other_draw_without_one() {
        let drawn = |mix: &MixConfig| {
            let mut random = Seed([3; 32]).stream("kinds");
            (0..200).map(|_| draw_kind(mix, &mut random)).collect::<Vec<_>>()
        };
        let usual = MixConfig::default();
        assert!(usual.e_scooters == 0.0 && !drawn(&usual).contains(&BodyKind::EScooter));
        let some = drawn(&MixConfig { e_scooters: 1.0, ..usual.clone() });
        let count = some.iter().filter(|kind| **kind == BodyKind::EScooter).count();
        assert!((70..130).contains(&count), "{count} of 200");
        assert!(drives_on(BodyKind::EScooter, LaneKind::Biking) && !drives_on(BodyKind::Car, LaneKind::Biking));
    }
}
