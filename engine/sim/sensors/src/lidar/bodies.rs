//! People and vehicles within a short part of a sweep: figures that move evenly.

use super::scene::{Echo, LidarScene, LidarTriangle};
use cosfly_figures::{Clothes, FigureInPicture, add_figure};
use cosfly_frames::DVec3;
use std::cell::OnceCell;
use std::collections::BTreeMap;

/// Adds those who are there at a time, seconds since the first frame.
pub(super) type BodiesAt<'a> = &'a dyn Fn(f64, &mut Vec<FigureInPicture>);

/// Bodies around a moment, each with the limbs of the moment and the place of the ray's own time.
pub(super) struct MovingBodies(Vec<MovingBody>);

struct MovingBody {
    at: FigureInPicture,
    /// Sphere around all that the body may be, from its feet.
    most_m: f64,
    velocity_in_world: DVec3,
    /// Made when the first ray comes near: most bodies stand behind something, or beside all rays.
    figure: OnceCell<Figure>,
}

struct Figure {
    mesh: LidarScene,
    center_in_world: DVec3,
    reach_m: f64,
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
            at(time_s).iter().map(|it| (it.instance, it.figure.state.feet_in_world)).collect()
        };
        let (before, after) = (places(time_s - half_s), places(time_s + half_s));
        let moving = |it: FigureInPicture| {
            let way = before.get(&it.instance).zip(after.get(&it.instance)).map(|(before, after)| *after - *before);
            let velocity_in_world = way.unwrap_or_default() / (2.0 * half_s);
            // Arms, umbrellas and mirrors are within.
            let most_m = 1.0 + 2.0 * it.figure.height_m + it.figure.body.reach_m();
            MovingBody { at: it, most_m, velocity_in_world, figure: OnceCell::new() }
        };
        let is_near = |it: &MovingBody| {
            let figure = &it.at.figure;
            let reach_m = range_m + figure.height_m + figure.body.reach_m();
            figure.has_body() && figure.state.feet_in_world.distance(from) < reach_m
        };
        Self(at(time_s).into_iter().map(moving).filter(is_near).collect())
    }

    /// The first body along a unit vector within `range_m`, `after_s` after the moment.
    pub(super) fn echo(&self, after_s: f64, from: DVec3, ray: DVec3, range_m: f64) -> Option<Echo> {
        let mut nearest: Option<Echo> = None;
        for body in &self.0 {
            let from = from - after_s * body.velocity_in_world;
            let range_m = nearest.map_or(range_m, |echo| echo.distance_m);
            if !may_meet((from, ray, range_m), body.at.figure.state.feet_in_world, body.most_m) {
                continue;
            }
            let figure = body.figure.get_or_init(|| Figure::of(&body.at));
            if may_meet((from, ray, range_m), figure.center_in_world, figure.reach_m) {
                nearest = figure.mesh.echo(from, ray, range_m).or(nearest);
            }
        }
        nearest
    }
}

/// Whether a ray may meet something in a sphere within its range.
fn may_meet((from, ray, range_m): (DVec3, DVec3, f64), center_in_world: DVec3, reach_m: f64) -> bool {
    let to_center = center_in_world - from;
    let along_m = to_center.dot(ray);
    let is_beside = to_center.length_squared() - along_m * along_m > reach_m * reach_m;
    !is_beside && along_m >= -reach_m && along_m - reach_m <= range_m
}

impl Figure {
    fn of(it: &FigureInPicture) -> Self {
        let mut surface = vec![];
        add_figure(&it.figure, &Clothes::draw(&it.figure.clothes_seed), 0, &mut surface);
        let triangle = |triangle: &cosfly_figures::FigureTriangle| LidarTriangle {
            corners_in_world: triangle.corners_in_world,
            label: it.figure.body.label(triangle.region).id(),
            instance: it.instance,
        };
        let triangles: Vec<LidarTriangle> = surface.iter().map(triangle).collect();
        let corners = || triangles.iter().flat_map(|triangle| triangle.corners_in_world);
        let low = corners().fold(DVec3::INFINITY, DVec3::min);
        let high = corners().fold(DVec3::NEG_INFINITY, DVec3::max);
        let (center_in_world, reach_m) = (0.5 * (low + high), 0.5 * (high - low).length() + 1e-6);
        Self { mesh: LidarScene::new(&triangles), center_in_world, reach_m }
    }
}
