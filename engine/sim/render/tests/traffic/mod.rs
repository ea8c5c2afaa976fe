//! Invented vehicles for tests and benches.

use cosfly_domain::BodyKind;
use cosfly_figures::{BodyFigure, BodyShape, FigureInPicture};
use cosfly_frames::{DVec3, Seed, TargetState};

/// Kinds of vehicles with their sizes, metres; most are cars.
const VEHICLES: [(BodyKind, [f64; 3]); 8] = [
    (BodyKind::Car, [4.4, 1.8, 1.5]),
    (BodyKind::Bicycle, [1.8, 0.65, 1.75]),
    (BodyKind::Car, [4.7, 1.85, 1.6]),
    (BodyKind::Van, [5.3, 2.0, 2.3]),
    (BodyKind::Car, [4.1, 1.75, 1.45]),
    (BodyKind::Bus, [12.0, 2.55, 3.1]),
    (BodyKind::Motorcycle, [2.1, 0.8, 1.6]),
    (BodyKind::Truck, [8.0, 2.5, 3.3]),
];

/// A vehicle at a place; its number draws kind and looks.
pub fn vehicle(number: u32, place: DVec3, heading_rad: f64) -> FigureInPicture {
    let (kind, size_m) = VEHICLES[number as usize % VEHICLES.len()];
    let figure = BodyFigure {
        state: TargetState { feet_in_world: place, heading_rad, speed_mps: 6.0 },
        height_m: size_m[2],
        radius_m: 0.5 * size_m[1],
        clothes_seed: Seed([7; 32]).child("vehicle", u64::from(number)),
        gait_phase_rad: 0.7 * f64::from(number),
        body: BodyShape::of(kind, DVec3::from_array(size_m)),
    };
    FigureInPicture { figure, instance: 60_000 + number }
}
