//! Sizes and limits of the kinds of vehicles.

use crate::config::MixConfig;
use cosfly_domain::{BodyKind, LaneKind};
use cosfly_frames::{DVec3, RandomStream};

/// What a kind of vehicle can do.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits {
    /// Largest speed, m/s.
    pub top_mps: f64,
    /// Largest acceleration of a calm driver, m/s^2.
    pub accelerate_mps2: f64,
    /// Comfortable braking, m/s^2.
    pub brake_mps2: f64,
    /// Sideways acceleration in bends, m/s^2.
    pub sideways_mps2: f64,
}

/// Limits of a kind: passenger cars after Treiber's parameters for towns, the others slower in this order of mass.
pub(crate) fn limits(kind: BodyKind) -> Limits {
    let of = |top_mps: f64, accelerate_mps2: f64, brake_mps2: f64, sideways_mps2: f64| Limits {
        top_mps,
        accelerate_mps2,
        brake_mps2,
        sideways_mps2,
    };
    match kind {
        BodyKind::Bicycle => of(5.5, 0.9, 1.8, 1.6),
        BodyKind::Motorcycle => of(40.0, 2.2, 2.5, 2.5),
        BodyKind::Van => of(36.0, 1.3, 2.0, 2.0),
        BodyKind::Truck => of(25.0, 0.9, 1.8, 1.5),
        BodyKind::Bus => of(24.0, 1.0, 1.6, 1.2),
        BodyKind::Car | BodyKind::Pedestrian | BodyKind::Drone => of(45.0, 1.5, 2.0, 2.2),
    }
}

/// Ranges of length, width and height, metres.
pub(crate) fn size_m(kind: BodyKind, random: &mut RandomStream) -> DVec3 {
    let [length, width, height] = match kind {
        BodyKind::Bicycle => [[1.70, 1.85], [0.58, 0.68], [1.65, 1.85]],
        BodyKind::Motorcycle => [[2.00, 2.25], [0.75, 0.90], [1.55, 1.70]],
        BodyKind::Van => [[4.80, 5.90], [1.90, 2.05], [1.95, 2.55]],
        BodyKind::Truck => [[6.50, 8.50], [2.30, 2.50], [2.90, 3.50]],
        BodyKind::Bus => [[10.5, 12.0], [2.50, 2.55], [3.00, 3.20]],
        BodyKind::Car | BodyKind::Pedestrian | BodyKind::Drone => [[3.60, 4.85], [1.66, 1.90], [1.42, 1.68]],
    };
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
