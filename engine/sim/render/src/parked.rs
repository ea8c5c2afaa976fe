//! Cars of a town as vehicles within their boxes.

use crate::props::Props;
use cosfly_domain::{ObstacleKind, Town, object_instance};
use cosfly_figures::{BodyFigure, BodyShape, FigureInPicture};
use cosfly_frames::{DVec3, Seed, TargetState, real};
use cosfly_materials::parts::SceneBox;
use cosfly_models::stands;
use std::collections::BTreeSet;

/// The cars of a town that no model draws and that are one box of a vehicle's size; `seed` draws their looks. They fill
/// their boxes along the longer side, so that what certificates and planners keep away from holds all of them.
pub(crate) fn parked_cars(town: &Town, props: &Props, seed: Seed) -> Vec<FigureInPicture> {
    let drawn: BTreeSet<u32> = props.props.iter().map(|prop| prop.instance).collect();
    let mut seen = BTreeSet::new();
    let several: BTreeSet<u32> =
        town.obstacles.iter().map(|it| it.object_id).filter(|object_id| !seen.insert(*object_id)).collect();
    let cars = stands(&town.obstacles, |kind| kind == ObstacleKind::Car).into_iter();
    let whole = cars.filter(|(id, _)| !several.contains(id) && !drawn.contains(&object_instance(*id)));
    let parked = whole.filter_map(|(object_id, stand)| {
        let (size_m, yaw_rad) = (2.0 * stand.half_extents_m, stand.yaw_rad);
        let is_across = size_m.y > size_m.x;
        let (size_m, heading_rad) = if is_across {
            (DVec3::new(size_m.y, size_m.x, size_m.z), yaw_rad + real::FRAC_PI_2)
        } else {
            (size_m, yaw_rad)
        };
        let feet_in_world = stand.center_in_world - DVec3::Z * stand.half_extents_m.z;
        let figure = BodyFigure {
            state: TargetState { feet_in_world, heading_rad, speed_mps: 0.0 },
            height_m: size_m.z,
            radius_m: 0.5 * size_m.y,
            clothes_seed: seed.child("parked", u64::from(object_id)),
            gait_phase_rad: 0.0,
            body: BodyShape::of_vehicle_in(size_m)?,
        };
        Some(FigureInPicture { figure, instance: object_instance(object_id) })
    });
    parked.collect()
}

/// Leaves out the boxes of cars that are drawn as vehicles.
pub(crate) fn leave_out(parked: &[FigureInPicture], boxes: &mut Vec<SceneBox>) {
    let drawn: BTreeSet<u32> = parked.iter().map(|car| car.instance).collect();
    boxes.retain(|b| !drawn.contains(&b.instance));
}
