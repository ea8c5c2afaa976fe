//! Towns and rays for `cosfly-lab geometry`: boxes around a walk, cameras above it, body points below.

use cosfly_domain::OrientedBox;
use cosfly_frames::{DVec3, TargetTrack, real};
use cosfly_geometry::{BoxBvh, SpatialQuery};
use cosfly_random::{RandomStream, Seed};
use cosfly_scenes::{SceneKind, SeededScene};
use cosfly_surroundings::visibility::body_points;

/// Rays of one view: the body points of visibility.
pub const RAYS: usize = 8;
/// Number of views of each set of a town.
pub const VIEWS: usize = 1024;
/// Yaw of the towns whose boxes are not axis-aligned, radians.
const TURN_RAD: f64 = 0.5;

/// A camera and the body points that it looks at.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// Position of the camera, 20 to 40 m from the target.
    pub camera_in_world: DVec3,
    /// Body points of the target, see [`body_points`].
    pub points_in_world: [DVec3; RAYS],
}

/// Boxes around a walk, and queries about them.
pub struct BenchTown {
    /// All boxes.
    pub boxes: Vec<OrientedBox>,
    /// Whether the whole town is rotated, so that no box is axis-aligned.
    pub is_turned: bool,
    /// Views with at least five of eight rays occluded.
    pub hidden_views: Vec<View>,
    /// Views with at most one ray occluded.
    pub free_views: Vec<View>,
}

impl BenchTown {
    /// The `count` boxes nearest to a walk, or all where there are fewer: up to 1,000 of a leafy town, up to 2,500 of
    /// one with tree tunnels, beyond that of a leafy town cut into small boxes.
    pub fn generate(seed: u64, count: usize, is_turned: bool) -> Self {
        let kind = if count <= 1_000 {
            SceneKind::Leafy
        } else if count <= 2_500 {
            SceneKind::Tunnel
        } else {
            SceneKind::Fine
        };
        let scene = SeededScene::generate(kind, seed);
        let track = scene.walker(seed, 0);
        let mut boxes = nearest_boxes(scene.boxes, &track, count);
        let mut stream = Seed::of_item(seed, "bench", "geometry").stream("views");
        let tree = BoxBvh::build(boxes.clone());
        let (mut hidden_views, mut free_views) = (Vec::new(), Vec::new());
        // A town in which one kind of view is rare is measured with fewer of them.
        for _ in 0..200 * VIEWS {
            let view = view(&track, &mut stream);
            let mut hidden = [false; RAYS];
            tree.blocked_batch(view.camera_in_world, &view.points_in_world, &mut hidden);
            let count = hidden.iter().filter(|&&one| one).count();
            if count >= 5 && hidden_views.len() < VIEWS {
                hidden_views.push(view);
            } else if count <= 1 && free_views.len() < VIEWS {
                free_views.push(view);
            }
            if hidden_views.len() == VIEWS && free_views.len() == VIEWS {
                break;
            }
        }
        if is_turned {
            boxes.iter_mut().for_each(turn_box);
            hidden_views.iter_mut().chain(&mut free_views).for_each(|view| {
                view.camera_in_world = turned(view.camera_in_world);
                view.points_in_world = view.points_in_world.map(turned);
            });
        }
        Self { boxes, is_turned, hidden_views, free_views }
    }
}

fn nearest_boxes(boxes: Vec<OrientedBox>, track: &TargetTrack, count: usize) -> Vec<OrientedBox> {
    let distance = |shape: &OrientedBox| {
        let (min, max) = shape.bounds_in_world();
        let of_state = |feet: DVec3| (min - feet).max(feet - max).max(DVec3::ZERO).length_squared();
        track.states.iter().map(|state| of_state(state.feet_in_world)).fold(f64::INFINITY, f64::min)
    };
    let mut ranked: Vec<(f64, OrientedBox)> = boxes.into_iter().map(|shape| (distance(&shape), shape)).collect();
    ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
    ranked.into_iter().take(count).map(|(_, shape)| shape).collect()
}

/// A camera 20 to 40 m away at an elevation of 25 to 75 degrees, at any azimuth.
fn view(track: &TargetTrack, stream: &mut RandomStream) -> View {
    let state = &track.states[stream.index(track.states.len())];
    let distance_m = stream.uniform(20.0, 40.0);
    let (azimuth_rad, pitch_rad) = (stream.uniform(0.0, std::f64::consts::TAU), stream.uniform(0.44, 1.3));
    let ((sin_a, cos_a), (sin_p, cos_p)) = (real::sin_cos(azimuth_rad), real::sin_cos(pitch_rad));
    let arm = distance_m * DVec3::new(cos_a * cos_p, sin_a * cos_p, sin_p);
    View { camera_in_world: state.feet_in_world + arm, points_in_world: body_points(state, track.height_m) }
}

fn turned(point: DVec3) -> DVec3 {
    let (sin, cos) = real::sin_cos(TURN_RAD);
    DVec3::new(cos * point.x - sin * point.y, sin * point.x + cos * point.y, point.z)
}

fn turn_box(shape: &mut OrientedBox) {
    shape.center_in_world = turned(shape.center_in_world);
    shape.yaw_rad += TURN_RAD;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn towns_have_the_boxes_and_views_asked_for() {
        for count in [50, 200, 2000] {
            let town = BenchTown::generate(3, count, false);
            assert!(town.boxes.len() <= count && 10 * town.boxes.len() > 7 * count, "{}", town.boxes.len());
            assert!(town.hidden_views.len() > 100 && town.free_views.len() > 100);
        }
    }
}
