//! Where things of a town stand, and a model in the place of one.

use crate::config::ModelFit;
use crate::model::{Model, ModelTriangle};
use cosfly_domain::{Obstacle, ObstacleKind};
use cosfly_frames::{DVec2, DVec3, real};
use std::collections::BTreeMap;

/// The box around all parts of a thing, in the axes of its largest part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stand {
    /// Middle, metres.
    pub center_in_world: DVec3,
    /// Half of length, width and height, metres.
    pub half_extents_m: DVec3,
    /// Turn of its x axis from the world's, radians.
    pub yaw_rad: f64,
    /// Kind of the largest part.
    pub kind: ObstacleKind,
}

/// The things of a town that have a part of some kind, by object id, with all of their parts.
pub fn stands(obstacles: &[Obstacle], is_part: impl Fn(ObstacleKind) -> bool) -> BTreeMap<u32, Stand> {
    let of_kind = obstacles.iter().filter(|obstacle| is_part(obstacle.kind));
    let mut parts: BTreeMap<u32, Vec<&Obstacle>> = of_kind.map(|obstacle| (obstacle.object_id, vec![])).collect();
    for obstacle in obstacles {
        if let Some(parts) = parts.get_mut(&obstacle.object_id) {
            parts.push(obstacle);
        }
    }
    parts.into_iter().filter_map(|(id, parts)| Some((id, around(&parts)?))).collect()
}

fn around(parts: &[&Obstacle]) -> Option<Stand> {
    let volume = |part: &Obstacle| part.shape.half_extents_m.element_product();
    let largest = parts.iter().copied().max_by(|a, b| volume(a).total_cmp(&volume(b)))?;
    let (sin, cos) = real::sin_cos(largest.shape.yaw_rad);
    let along = DVec2::new(cos, sin);
    let own = |point: DVec3| {
        let flat = point.truncate();
        DVec3::new(flat.dot(along), flat.dot(along.perp()), point.z)
    };
    let corners = || parts.iter().flat_map(|part| part.shape.corners_in_world()).map(own);
    let (low, high) = (corners().fold(DVec3::INFINITY, DVec3::min), corners().fold(DVec3::NEG_INFINITY, DVec3::max));
    let (middle, half_extents_m) = (0.5 * (low + high), 0.5 * (high - low));
    let flat = along * middle.x + along.perp() * middle.y;
    let stand = Stand {
        center_in_world: flat.extend(middle.z),
        half_extents_m,
        yaw_rad: largest.shape.yaw_rad,
        kind: largest.kind,
    };
    (stand.center_in_world.is_finite() && half_extents_m.is_finite()).then_some(stand)
}

/// The triangles of a model that was turned by `turn_rad`, in the box around a thing, in the world's frame. Where the model is longer along the
/// box's shorter side, it turns by a right angle.
pub fn place(model: &Model, turn_rad: f64, fit: ModelFit, stand: &Stand) -> Vec<ModelTriangle> {
    let long = |size: DVec3| size.x >= size.y;
    let turned = bounds(model, turn_rad);
    let is_across = long(turned[1] - turned[0]) != long(stand.half_extents_m);
    let turn_rad = if is_across { turn_rad + real::FRAC_PI_2 } else { turn_rad };
    let [low, high] = if is_across { bounds(model, turn_rad) } else { turned };
    let size = (high - low).max(DVec3::splat(1e-6));
    let stretch = 2.0 * stand.half_extents_m / size;
    let scale = match fit {
        ModelFit::Fill => stretch,
        ModelFit::Within => DVec3::splat(stretch.min_element()),
    };
    let base = DVec3::new(0.5 * (low.x + high.x), 0.5 * (low.y + high.y), low.z);
    let (sin, cos) = real::sin_cos(stand.yaw_rad);
    let ground = stand.center_in_world - DVec3::Z * stand.half_extents_m.z;
    let in_world = |corner: DVec3| {
        let own = (about_vertical(corner, turn_rad) - base) * scale;
        ground + DVec3::new(cos * own.x - sin * own.y, sin * own.x + cos * own.y, own.z)
    };
    model.triangles.iter().map(|it| ModelTriangle { corners: it.corners.map(in_world), ..*it }).collect()
}

fn about_vertical(point: DVec3, turn_rad: f64) -> DVec3 {
    let (sin, cos) = real::sin_cos(turn_rad);
    DVec3::new(cos * point.x - sin * point.y, sin * point.x + cos * point.y, point.z)
}

fn bounds(model: &Model, turn_rad: f64) -> [DVec3; 2] {
    let corners = || model.triangles.iter().flat_map(|it| it.corners).map(|corner| about_vertical(corner, turn_rad));
    [corners().fold(DVec3::INFINITY, DVec3::min), corners().fold(DVec3::NEG_INFINITY, DVec3::max)]
}
