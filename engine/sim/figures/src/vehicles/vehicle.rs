//! Triangles of a vehicle with its rider, by its kind.

use super::model::Model;
use super::{cars, coaches, drones, lorries, riders, sitters, taken_along};
use crate::Clothes;
use crate::body_figure::BodyFigure;
use crate::frustum::FigureTriangle;
use cosfly_domain::BodyKind;
use cosfly_frames::DVec3;

/// Appends a vehicle with its rider to `triangles`. No corner leaves the vehicle's box, and each side of the box has a
/// corner within 1 cm of it.
pub fn add(
    figure: &BodyFigure,
    kind: BodyKind,
    size_m: DVec3,
    clothes: &Clothes,
    person: u32,
    triangles: &mut Vec<FigureTriangle>,
) {
    let mut model = Model::new(figure, size_m, person, triangles);
    let mut looks = figure.clothes_seed.stream("shape");
    let phase_rad = figure.gait_phase_rad;
    match kind {
        BodyKind::Bicycle => riders::bicycle(&mut model, clothes, phase_rad),
        BodyKind::EScooter => riders::e_scooter(&mut model, clothes),
        BodyKind::Motorcycle if looks.chance(0.4) => riders::scooter(&mut model, clothes),
        BodyKind::Motorcycle => riders::motorcycle(&mut model, clothes),
        BodyKind::Truck => lorries::lorry(&mut model, &mut looks),
        BodyKind::Bus => coaches::bus(&mut model, &mut looks),
        BodyKind::Drone => drones::quadrotor(&mut model),
        BodyKind::Wheelchair => taken_along::wheelchair(&mut model, clothes),
        BodyKind::Sitter => sitters::sitter(&mut model, clothes),
        BodyKind::PushChair => taken_along::push_chair(&mut model, clothes, figure),
        BodyKind::DogWalker => taken_along::dog(&mut model, clothes, figure),
        BodyKind::Car | BodyKind::Van | BodyKind::Pedestrian | BodyKind::Child | BodyKind::Elder | BodyKind::Runner => {
            let shape = cars::shape(kind, size_m, &mut looks);
            cars::car(&mut model, shape, phase_rad, &mut looks);
        }
    }
}
