//! Share of the target's body that hundreds of rays reach: the figure's triangles against the town's boxes and other
//! people in double precision, without any code of the renderer, so that its pixels can be compared with it.

use cosfly_domain::{Camera, Lens};
use cosfly_figures::{BodyFigure, FigureInPicture, figure_triangles};
use cosfly_frames::{DVec3, Pose};
use cosfly_geometry::{BoxBvh, SpatialQuery};

/// Rays through the box around the body in the image; about half of them meet the body.
const RAYS: f64 = 900.0;
/// Distance from a line of sight to the middle of a person who cannot hide another one there, metres; vehicles add half their
/// diagonals.
const APART_M: f64 = 2.5;

/// Casts rays; keeps its buffers from frame to frame.
#[derive(Default)]
pub struct BodyRays {
    /// Inverse planar depth of the body at each ray, 1/m; 0 where the ray misses it.
    nearness: Vec<f64>,
    /// Inverse planar depth of the people in front of it, 1/m.
    nearness_of_others: Vec<f64>,
    points_in_world: Vec<DVec3>,
    blocked: Vec<bool>,
}

/// A corner in the image: u and v in pixels, inverse planar depth in 1/m.
type Corner = [f64; 3];

impl BodyRays {
    /// Share of unblocked rays among those, evenly spaced, that meet the body inside of the image; `None` where none meets
    /// it.
    pub fn visible_share(
        &mut self,
        boxes: &BoxBvh,
        others: &[FigureInPicture],
        camera: &Camera,
        pose: &Pose,
        target: &BodyFigure,
    ) -> Option<f64> {
        let in_image = |corner: DVec3| camera.project(pose, corner).map(|(u, v, depth_m)| [u, v, 1.0 / depth_m]);
        let seen = |[a, b, c]: [DVec3; 3]| Some([in_image(a)?, in_image(b)?, in_image(c)?]);
        let triangles: Vec<[Corner; 3]> = figure_triangles(target).into_iter().filter_map(seen).collect();
        let grid = Grid::around(&triangles, camera)?;
        self.nearness.clear();
        self.nearness.resize(grid.columns * grid.rows, 0.0);
        triangles.iter().for_each(|triangle| grid.meet(triangle, &mut self.nearness));
        self.nearness_of_others.clear();
        self.nearness_of_others.resize(grid.columns * grid.rows, 0.0);
        let is_before = |other: &&FigureInPicture| is_before(&other.figure, pose.position_in_world, target);
        for other in others.iter().filter(is_before) {
            let triangles = figure_triangles(&other.figure).into_iter().filter_map(seen);
            triangles.for_each(|triangle| grid.meet(&triangle, &mut self.nearness_of_others));
        }
        self.points_in_world.clear();
        for (at, nearness) in self.nearness.iter().enumerate().filter(|(_, nearness)| **nearness > 0.0) {
            let ray = camera.ray_in_world(pose, grid.u(at % grid.columns), grid.v(at / grid.columns));
            self.points_in_world.push(pose.position_in_world + ray * ((1.0 - 1e-9) / nearness));
        }
        self.blocked.clear();
        self.blocked.resize(self.points_in_world.len(), false);
        boxes.blocked_batch(pose.position_in_world, &self.points_in_world, &mut self.blocked);
        let cells = self.nearness.iter().zip(&self.nearness_of_others).filter(|(nearness, _)| **nearness > 0.0);
        let is_free = |(blocked, (body, other)): (&bool, (&f64, &f64))| !blocked && other <= body;
        let free = self.blocked.iter().zip(cells).filter(|it| is_free(*it)).count();
        (!self.blocked.is_empty()).then(|| free as f64 / self.blocked.len() as f64)
    }
}

/// Camera and pose of rays to a target: those of the picture, of a wide lens those of an ideal camera that looks at it.
pub fn aimed(lens: &Lens, camera: &Camera, pose: &Pose, target: &BodyFigure) -> (Camera, Pose) {
    if !lens.is_wide(camera) {
        return (*camera, *pose);
    }
    let pose = Pose::looking_at(pose.position_in_world, middle(target));
    (Camera { width: 640, height: 640, horizontal_fov_rad: 2.0 }, pose)
}

/// True where somebody may hide a part of the target from an eye.
pub fn is_before(other: &BodyFigure, eye_in_world: DVec3, target: &BodyFigure) -> bool {
    let to_target = middle(target) - eye_in_world;
    let to_other = middle(other) - eye_in_world;
    let along = to_other.dot(to_target) / to_target.length_squared().max(1e-9);
    let apart_m = APART_M + other.body.reach_m() + target.body.reach_m();
    (to_other - to_target * along.clamp(0.0, 1.0)).length() < apart_m
}

/// Middle of an upright body.
fn middle(figure: &BodyFigure) -> DVec3 {
    figure.state.feet_in_world + DVec3::Z * (0.5 * figure.body.height_m(figure.height_m))
}

/// Pixels of rays: the middles of square cells.
struct Grid {
    left: f64,
    top: f64,
    step: f64,
    columns: usize,
    rows: usize,
}

impl Grid {
    /// Grid over the part of the triangles' bounds that is in the image.
    fn around(triangles: &[[Corner; 3]], camera: &Camera) -> Option<Self> {
        let corners = || triangles.iter().flatten();
        let least = |axis: usize| corners().map(|corner| corner[axis]).fold(f64::INFINITY, f64::min).max(0.0);
        let most = |axis: usize, size: u32| {
            corners().map(|corner| corner[axis]).fold(f64::NEG_INFINITY, f64::max).min(f64::from(size))
        };
        let (left, top) = (least(0), least(1));
        let (width, height) = (most(0, camera.width) - left, most(1, camera.height) - top);
        if !(width > 0.0 && height > 0.0) {
            return None;
        }
        // Slender boxes have one row of rays at least, and not more than four times as many rays as others.
        let step = (width * height / RAYS).sqrt().max(width.max(height) / (4.0 * RAYS));
        // A cell whose middle lies outside belongs to no pixel of the image.
        let count = |length: f64| (length / step - 0.5).ceil().max(1.0) as usize;
        Some(Self { left, top, step, columns: count(width), rows: count(height) })
    }

    fn u(&self, column: usize) -> f64 {
        self.left + (column as f64 + 0.5) * self.step
    }

    fn v(&self, row: usize) -> f64 {
        self.top + (row as f64 + 0.5) * self.step
    }

    /// Notes the inverse depth of a triangle, seen from either side, at the rays through it.
    fn meet(&self, [a, b, c]: &[Corner; 3], nearness: &mut [f64]) {
        let area = cross(a, b, c[0], c[1]);
        if area == 0.0 {
            return;
        }
        let cells = |axis: usize, start: f64, count: usize| {
            let low = a[axis].min(b[axis]).min(c[axis]);
            let high = a[axis].max(b[axis]).max(c[axis]);
            let first = ((low - start) / self.step - 0.5).ceil().max(0.0) as usize;
            let end = ((high - start) / self.step + 0.5).floor().max(0.0) as usize;
            first..end.min(count)
        };
        for row in cells(1, self.top, self.rows) {
            for column in cells(0, self.left, self.columns) {
                let (u, v) = (self.u(column), self.v(row));
                let shares = [cross(b, c, u, v) / area, cross(c, a, u, v) / area, cross(a, b, u, v) / area];
                if shares.iter().all(|share| *share >= 0.0) {
                    // Inverse planar depth is linear in the image.
                    let here = shares[0] * a[2] + shares[1] * b[2] + shares[2] * c[2];
                    let nearest = &mut nearness[row * self.columns + column];
                    *nearest = nearest.max(here);
                }
            }
        }
    }
}

/// Twice the signed area between an edge and a point of the image.
fn cross(from: &Corner, to: &Corner, u: f64, v: f64) -> f64 {
    (to[0] - from[0]) * (v - from[1]) - (to[1] - from[1]) * (u - from[0])
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_domain::OrientedBox;
    use cosfly_figures::BodyShape;
    use cosfly_frames::{Seed, TargetState};

    const CAMERA: Camera = Camera { width: 640, height: 360, horizontal_fov_rad: 1.2 };

    fn target() -> BodyFigure {
        BodyFigure {
            state: TargetState { feet_in_world: DVec3::ZERO, heading_rad: 0.4, speed_mps: 1.3 },
            height_m: 1.8,
            radius_m: 0.3,
            clothes_seed: Seed([1; 32]),
            gait_phase_rad: 0.5,
            body: BodyShape::default(),
        }
    }

    fn share(obstacles: &[OrientedBox], pose: Pose) -> Option<f64> {
        BodyRays::default().visible_share(&BoxBvh::build(obstacles.to_vec()), &[], &CAMERA, &pose, &target())
    }

    /// A wall 5 m before the body, between two heights.
    fn wall(low_m: f64, high_m: f64) -> OrientedBox {
        OrientedBox::from_corners(DVec3::new(4.9, -5.0, low_m), DVec3::new(5.1, 5.0, high_m))
    }

    #[test]
    fn a_free_body_is_seen_whole_and_a_hidden_one_not_at_all() {
        let level = Pose::looking_at(DVec3::new(20.0, 0.0, 0.9), DVec3::new(0.0, 0.0, 0.9));
        assert_eq!(share(&[], level), Some(1.0));
        assert_eq!(share(&[wall(-1.0, 4.0)], level), Some(0.0));
        let away = Pose::looking_at(DVec3::new(20.0, 0.0, 0.9), DVec3::new(40.0, 0.0, 0.9));
        assert_eq!(share(&[], away), None);
    }

    #[test]
    fn somebody_before_the_body_hides_it_and_somebody_behind_does_not() {
        let pose = Pose::looking_at(DVec3::new(20.0, 0.0, 0.9), DVec3::new(0.0, 0.0, 0.9));
        let share = |x: f64, y: f64| {
            let mut figure = target();
            figure.state.feet_in_world = DVec3::new(x, y, 0.0);
            let other = [FigureInPicture { figure, instance: 9 }];
            BodyRays::default().visible_share(&BoxBvh::build(vec![]), &other, &CAMERA, &pose, &target()).unwrap()
        };
        assert!(
            share(2.0, 0.0) < 0.3 && (0.3..0.95).contains(&share(2.0, 0.3)),
            "{} {}",
            share(2.0, 0.0),
            share(2.0, 0.3)
        );
        assert_eq!([share(-2.0, 0.0), share(2.0, 1.5), share(22.0, 0.0)], [1.0; 3]);
    }

    #[test]
    fn a_long_vehicle_hides_from_far_off_its_middle_and_can_be_the_target() {
        let pose = Pose::looking_at(DVec3::new(20.0, 0.0, 0.9), DVec3::new(0.0, 0.0, 0.9));
        let size_m = DVec3::new(12.0, 2.5, 3.1);
        let bus = BodyShape::Vehicle { kind: cosfly_domain::BodyKind::Bus, size_m };
        let share = |target: &BodyFigure, x: f64, y: f64| {
            let mut figure = BodyFigure { body: bus, ..self::target() };
            (figure.state.feet_in_world, figure.state.heading_rad) =
                (DVec3::new(x, y, 0.0), 0.5 * cosfly_frames::real::PI);
            let other = [FigureInPicture { figure, instance: 9 }];
            BodyRays::default().visible_share(&BoxBvh::build(vec![]), &other, &CAMERA, &pose, target).unwrap()
        };
        // The end of the bus, 5 m from its middle, is before the person.
        let [before, behind, beside] = [(6.0, 5.0), (-6.0, 5.0), (6.0, 8.0)].map(|(x, y)| share(&target(), x, y));
        assert!(before < 0.05 && [behind, beside] == [1.0; 2], "{before} {behind} {beside}");
        let followed = BodyFigure { body: bus, ..target() };
        let half = share(&followed, 8.0, 6.0);
        assert!((0.2..0.8).contains(&half), "{half}");
    }

    #[test]
    fn half_a_wall_hides_the_lower_part_of_the_body() {
        let level = Pose::looking_at(DVec3::new(1000.0, 0.0, 0.9), DVec3::new(0.0, 0.0, 0.9));
        let shares: Vec<f64> =
            [0.3, 0.6, 0.9, 1.2, 1.5].map(|high| share(&[wall(-1.0, high)], level).unwrap()).to_vec();
        assert!(shares.is_sorted_by(|a, b| a > b), "{shares:?}");
        // The trunk is wider than the legs.
        assert!((0.5..0.75).contains(&shares[2]), "{shares:?}");
    }

    #[test]
    fn only_what_is_in_the_image_counts() {
        // The wall hides the right half of the body, which is outside of the image.
        let pose = Pose::looking_at(DVec3::new(10.0, 0.0, 0.9), DVec3::new(0.0, 0.0, 0.9));
        let to_the_left = Pose { yaw_rad: pose.yaw_rad - 0.6, ..pose };
        let (_, right) = (0, OrientedBox::from_corners(DVec3::new(4.9, -5.0, -1.0), DVec3::new(5.1, 0.0, 4.0)));
        let left = OrientedBox::from_corners(DVec3::new(4.9, 0.0, -1.0), DVec3::new(5.1, 5.0, 4.0));
        let halves = [share(&[right], to_the_left), share(&[left], to_the_left)];
        assert!(halves.contains(&Some(1.0)) && halves.contains(&Some(0.0)), "{halves:?}");
    }
}
