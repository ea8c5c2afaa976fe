//! People and vehicles within a short part of a sweep: figures that move evenly.

use super::scene::{Echo, LidarScene, LidarTriangle};
use cosfly_figures::{Bystander, Clothes, figure};
use cosfly_frames::DVec3;
use std::collections::BTreeMap;

/// Adds those who are there at a time, seconds since the first frame.
pub(super) type BodiesAt<'a> = &'a dyn Fn(f64, &mut Vec<Bystander>);

/// Bodies around a moment, each with the limbs of the moment and the place of the ray's own time.
pub(super) struct MovingBodies(Vec<MovingBody>);

struct MovingBody {
    mesh: LidarScene,
    center_in_world: DVec3,
    reach_m: f64,
    velocity_in_world: DVec3,
}

impl MovingBodies {
    /// The bodies within `range_m` of a place, from `half_s` before a time to `half_s` after it.
    pub(super) fn around(bodies: BodiesAt<'_>, (time_s, half_s): (f64, f64), from: DVec3, range_m: f64) -> Self {
        let at = |time_s: f64| {
            let mut list = vec![];
            bodies(time_s, &mut list);
            list
        };
        let places = |time_s: f64| -> BTreeMap<u32, DVec3> {
            at(time_s).iter().map(|it| (it.instance, it.walker.state.feet_in_world)).collect()
        };
        let (before, after) = (places(time_s - half_s), places(time_s + half_s));
        let is_near = |it: &&Bystander| {
            let reach_m = range_m + it.walker.height_m + it.walker.body.reach_m();
            it.walker.has_body() && it.walker.state.feet_in_world.distance(from) < reach_m
        };
        let moving = |it: &Bystander| {
            let way = before.get(&it.instance).zip(after.get(&it.instance)).map(|(before, after)| *after - *before);
            MovingBody::of(it, way.unwrap_or_default() / (2.0 * half_s))
        };
        Self(at(time_s).iter().filter(is_near).map(moving).collect())
    }

    /// The first body along a unit vector within `range_m`, `after_s` after the moment.
    pub(super) fn echo(&self, after_s: f64, from: DVec3, ray: DVec3, range_m: f64) -> Option<Echo> {
        let mut nearest: Option<Echo> = None;
        for body in &self.0 {
            let from = from - after_s * body.velocity_in_world;
            let to_center = body.center_in_world - from;
            let along_m = to_center.dot(ray);
            let is_beside = to_center.length_squared() - along_m * along_m > body.reach_m * body.reach_m;
            if is_beside || along_m < -body.reach_m {
                continue;
            }
            let reach_m = nearest.map_or(range_m, |echo| echo.distance_m);
            nearest = body.mesh.echo(from, ray, reach_m).or(nearest);
        }
        nearest
    }
}

impl MovingBody {
    fn of(it: &Bystander, velocity_in_world: DVec3) -> Self {
        let mut surface = vec![];
        figure(&it.walker, &Clothes::draw(&it.walker.clothes_seed), 0, &mut surface);
        let triangle = |triangle: &cosfly_figures::FigureTriangle| LidarTriangle {
            corners_in_world: triangle.corners_in_world,
            label: it.walker.body.label(triangle.region).id(),
            instance: it.instance,
        };
        let triangles: Vec<LidarTriangle> = surface.iter().map(triangle).collect();
        let corners = || triangles.iter().flat_map(|triangle| triangle.corners_in_world);
        let low = corners().fold(DVec3::INFINITY, DVec3::min);
        let high = corners().fold(DVec3::NEG_INFINITY, DVec3::max);
        let (center_in_world, reach_m) = (0.5 * (low + high), 0.5 * (high - low).length() + 1e-6);
        Self { mesh: LidarScene::new(&triangles), center_in_world, reach_m, velocity_in_world }
    }
}
