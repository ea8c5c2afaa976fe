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
    let MixConfig { cars, vans, trucks, buses, motorcycles, bicycles } = *mix;
    let shares = [
        (BodyKind::Car, cars),
        (BodyKind::Van, vans),
        (BodyKind::Truck, trucks),
        (BodyKind::Bus, buses),
        (BodyKind::Motorcycle, motorcycles),
        (BodyKind::Bicycle, bicycles),
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
    lane == LaneKind::Driving || kind == BodyKind::Bicycle
}
