//! Pictures by one ray for each pixel: ground, a wall, cylinders for people.

use cosfly_domain::channels::SeenPoint;
use cosfly_domain::{
    BodyView, Camera, FrameImages, OrientedBox, PixelBox, SemanticLabel, TARGET_INSTANCE, TargetView, Town,
};
use cosfly_frames::{DVec3, Pose, TargetState, real};

/// Height and radius of everybody, metres.
pub(crate) const HEIGHT_M: f64 = 1.8;
pub(crate) const RADIUS_M: f64 = 0.35;
/// Instance id of the bystander who walks ahead of every target.
pub(crate) const COMPANION: u32 = 7;

/// Way on the picture of a point that stands, from one pose to another: right and down, pixels.
pub(crate) fn flow_px(point: &SeenPoint, camera: &Camera, here: &Pose, beside: &Pose) -> [f32; 2] {
    // The sky is as far as makes no difference.
    let depth_m = f64::from(point.depth_m).min(1e9);
    let seen = |pose: &Pose| camera.project(pose, point.camera_in_world + depth_m * point.ray_in_world);
    match (seen(here), seen(beside)) {
        (Some(from), Some(to)) => [(to.0 - from.0) as f32, (to.1 - from.1) as f32],
        _ => [0.0; 2],
    }
}

/// Whether a picture from a pose, with these depths, shows a point that stands.
pub(crate) fn is_shown(point: &SeenPoint, camera: &Camera, beside: &Pose, depths_m: &[f32]) -> bool {
    let depth_m = f64::from(point.depth_m).min(1e9);
    let seen = camera.project(beside, point.camera_in_world + depth_m * point.ray_in_world);
    let (width, height) = (f64::from(camera.width), f64::from(camera.height));
    seen.is_some_and(|(u, v, ahead_m)| {
        let is_inside = (0.0..width).contains(&u) && (0.0..height).contains(&v);
        is_inside && f64::from(depths_m[v as usize * camera.width as usize + u as usize]) > 0.99 * ahead_m
    })
}

/// Point of the surface at a pixel, assumed level.
pub(crate) fn point(images: &FrameImages, camera: &Camera, pose: &Pose, at: usize) -> SeenPoint {
    let (column, row) = (at as u32 % images.width, at as u32 / images.width);
    let depth_m = images.depth_m[at];
    SeenPoint {
        depth_m,
        label: images.semantic[at],
        instance: images.instance[at],
        normal_in_world: if depth_m.is_finite() { DVec3::Z } else { DVec3::ZERO },
        ray_in_world: camera.ray_in_world(pose, f64::from(column) + 0.5, f64::from(row) + 0.5),
        camera_in_world: pose.position_in_world,
    }
}

/// Ray-casts ground, wall, target and bystander.
pub(crate) fn look(
    camera: &Camera,
    pose: &Pose,
    state: &TargetState,
    town: &Town,
) -> (FrameImages, TargetView, Option<BodyView>) {
    let (width, height) = (camera.width, camera.height);
    let mut images = FrameImages { width, height, ..FrameImages::default() };
    let (mut full, mut visible, mut companion) = (vec![], vec![], vec![]);
    let wall = &town.obstacles[0];
    for v in 0..height {
        for u in 0..width {
            let ray = camera.ray_in_world(pose, f64::from(u) + 0.5, f64::from(v) + 0.5);
            let from = pose.position_in_world;
            let ground = if ray.z < 0.0 { -from.z / ray.z } else { f64::INFINITY };
            let body = cylinder_hit(from - state.feet_in_world, ray);
            let wall_hit = box_hit(&wall.shape, from, ray);
            let other = cylinder_hit(from - ahead_of(state).feet_in_world, ray);
            let depth = ground.min(body).min(wall_hit).min(other);
            let (label, id) = if depth == f64::INFINITY {
                (SemanticLabel::Sky, 0)
            } else if depth == body {
                (SemanticLabel::Pedestrian, TARGET_INSTANCE)
            } else if depth == other {
                (SemanticLabel::Pedestrian, COMPANION)
            } else if depth == wall_hit {
                (SemanticLabel::Wall, wall.object_id + 2)
            } else {
                (SemanticLabel::Ground, 0)
            };
            if body < f64::INFINITY {
                full.push((u, v));
            }
            match id {
                TARGET_INSTANCE => visible.push((u, v)),
                COMPANION => companion.push((u, v)),
                _ => {}
            }
            images.rgb.extend(label.colour());
            images.depth_m.push(depth as f32);
            images.semantic.push(label.id());
            images.instance.push(id);
        }
    }
    let share = visible.len() as f64 / full.len().max(1) as f64;
    let view = TargetView {
        in_view: !full.is_empty(),
        visible_by_rays: share,
        visible_by_pixels: share,
        pixels: visible.len() as u32,
        visible_box: bounds(&visible),
        full_box: bounds(&full),
        occluder_instance: if visible.len() < full.len() { wall.object_id + 2 } else { 0 },
    };
    let pixels = companion.len() as u32;
    let companion = bounds(&companion).map(|visible_box| BodyView { instance: COMPANION, pixels, visible_box });
    (images, view, companion)
}

fn bounds(pixels: &[(u32, u32)]) -> Option<PixelBox> {
    Some(PixelBox {
        u_min: pixels.iter().map(|pixel| pixel.0).min()?,
        v_min: pixels.iter().map(|pixel| pixel.1).min()?,
        u_max: pixels.iter().map(|pixel| pixel.0).max()?,
        v_max: pixels.iter().map(|pixel| pixel.1).max()?,
    })
}

/// First hit with the body, a vertical cylinder at the origin, as a multiple of `ray`; infinite without a hit.
fn cylinder_hit(from: DVec3, ray: DVec3) -> f64 {
    let (a, b) = (ray.x * ray.x + ray.y * ray.y, from.x * ray.x + from.y * ray.y);
    let c = from.x * from.x + from.y * from.y - RADIUS_M * RADIUS_M;
    let root = (b * b - a * c).max(0.0).sqrt();
    let side = (-b - root) / a;
    let lid = (HEIGHT_M - from.z) / ray.z;
    let lid_point = from + ray * lid;
    if b * b >= a * c && side > 0.0 && (0.0..=HEIGHT_M).contains(&(from.z + ray.z * side)) {
        side
    } else if lid > 0.0 && lid_point.x * lid_point.x + lid_point.y * lid_point.y <= RADIUS_M * RADIUS_M {
        lid
    } else {
        f64::INFINITY
    }
}

/// First hit with a box (slab test in its own axes), as a multiple of `ray`; infinite without a hit.
fn box_hit(shape: &OrientedBox, from: DVec3, ray: DVec3) -> f64 {
    let (sin, cos) = real::sin_cos(shape.yaw_rad);
    let local = |v: DVec3| DVec3::new(cos * v.x + sin * v.y, cos * v.y - sin * v.x, v.z);
    let (origin, direction) = (local(from - shape.center_in_world), local(ray));
    let to_min = (-shape.half_extents_m - origin) / direction;
    let to_max = (shape.half_extents_m - origin) / direction;
    let enter = to_min.min(to_max).max_element();
    let leave = to_min.max(to_max).min_element();
    if enter <= leave && enter > 0.0 { enter } else { f64::INFINITY }
}

/// State of a bystander 2.5 m ahead and 1.5 m to the right.
pub(crate) fn ahead_of(state: &TargetState) -> TargetState {
    let (sin, cos) = real::sin_cos(state.heading_rad);
    let away = DVec3::new(2.5 * cos - 1.5 * sin, 2.5 * sin + 1.5 * cos, 0.0);
    TargetState { feet_in_world: state.feet_in_world + away, ..*state }
}
