//! Vehicles and drones: bodies of flat faces, and riders, within the boxes of their bodies.

mod coaches;
mod drones;
mod livery;
mod model;
mod riders;
#[cfg(test)]
mod tests;

pub use livery::Livery;

use crate::figure::FigureTriangle;
use cosfly_domain::BodyKind;
use cosfly_figures::{Clothes, Walker};
use cosfly_frames::DVec3;
use model::Model;

/// Appends a vehicle with its rider to `triangles`. No corner leaves the vehicle's box, and each side of the box has a
/// corner within 1 cm of it.
pub fn add(
    walker: &Walker,
    kind: BodyKind,
    size_m: DVec3,
    clothes: &Clothes,
    person: u32,
    triangles: &mut Vec<FigureTriangle>,
) {
    let mut model = Model::new(walker, size_m, person, triangles);
    match kind {
        BodyKind::Bicycle => riders::bicycle(&mut model, clothes, walker.gait_phase_rad),
        BodyKind::Motorcycle => riders::motorcycle(&mut model, clothes),
        BodyKind::Van => coaches::van(&mut model),
        BodyKind::Truck => coaches::truck(&mut model),
        BodyKind::Bus => coaches::bus(&mut model),
        BodyKind::Drone => drones::quadrotor(&mut model),
        BodyKind::Car | BodyKind::Pedestrian => coaches::car(&mut model, Livery::draw(&walker.clothes_seed).body),
    }
}
