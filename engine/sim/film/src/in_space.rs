//! Bodies in space: 3-D boxes of those whom a frame shows, and key points of people in its picture.

use cosfly_domain::{BodyInSpace, Camera, FrameImages, KeyPoint, Lens, Shown};
use cosfly_figures::{BodyFigure, BodyShape, FigureInPicture, key_points};
use cosfly_frames::{DVec3, Pose};
use std::collections::BTreeSet;

/// A joint is seen where the body's own surface before it is nearer by no more than this, body heights: limbs are thinner, trunk and
/// head are thicker.
const WITHIN: f64 = 0.085;

/// A frame and how it was taken.
pub struct Taken<'a> {
    /// Number of the frame.
    pub frame: usize,
    /// Pictures of the frame.
    pub images: &'a FrameImages,
    /// The ideal camera.
    pub camera: Camera,
    /// The lens before it.
    pub lens: Lens,
    /// Pose of the camera.
    pub pose: Pose,
}

impl Taken<'_> {
    /// Boxes and key points of those among `bodies` that cover a pixel, by instance id.
    pub fn bodies(&self, bodies: impl IntoIterator<Item = FigureInPicture>) -> Vec<BodyInSpace> {
        let runs = self.images.instance.chunk_by(|a, b| a == b);
        let shown: BTreeSet<u32> = runs.map(|run| run[0]).collect();
        let seen = bodies.into_iter().filter(|body| shown.contains(&body.instance));
        let mut all: Vec<BodyInSpace> = seen.map(|body| self.body(&body)).collect();
        all.sort_by_key(|body| body.instance);
        all
    }

    fn body(&self, body: &FigureInPicture) -> BodyInSpace {
        let FigureInPicture { figure, instance } = *body;
        let size_m = size_m(&figure);
        let points = key_points(&figure).into_iter().flatten();
        BodyInSpace {
            frame: self.frame as u32,
            instance,
            centre_in_world: figure.state.feet_in_world + DVec3::Z * (0.5 * size_m.z),
            size_m,
            heading_rad: figure.state.heading_rad,
            key_points: points.map(|point| self.point(point, instance, WITHIN * figure.height_m)).collect(),
        }
    }

    fn point(&self, point_in_world: DVec3, instance: u32, within_m: f64) -> KeyPoint {
        let outside = |depth_m: f64| KeyPoint { point_in_world, pixel: [0.0; 2], depth_m, shown: Shown::Outside };
        let point = self.pose.body_from_world_point(point_in_world);
        let Some((u, v, depth_m)) = self.lens.project(&self.camera, point) else { return outside(0.0) };
        if !self.lens.shows(&self.camera, point, (u, v)) {
            return outside(depth_m);
        }
        let (width, height) = (f64::from(self.camera.width), f64::from(self.camera.height));
        if !((0.0..width).contains(&u) && (0.0..height).contains(&v)) {
            return outside(depth_m);
        }
        let at = v as usize * self.camera.width as usize + u as usize;
        let is_own = self.images.instance.get(at) == Some(&instance);
        let is_before = self.images.depth_m.get(at).is_some_and(|it| f64::from(*it) >= depth_m - within_m);
        let shown = if is_own && is_before { Shown::Visible } else { Shown::Occluded };
        KeyPoint { point_in_world, pixel: [u, v], depth_m, shown }
    }
}

/// Length, width and height of a body.
fn size_m(figure: &BodyFigure) -> DVec3 {
    match figure.body {
        BodyShape::Vehicle { size_m, .. } => size_m,
        BodyShape::Person { .. } => DVec3::new(2.0 * figure.radius_m, 2.0 * figure.radius_m, figure.height_m),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_frames::{Seed, TargetState};

    #[test]
    fn a_key_point_is_seen_on_its_own_body_occluded_behind_another_and_outside_beyond_the_edge() {
        let camera = Camera { width: 64, height: 64, horizontal_fov_rad: 1.0 };
        let pose = Pose::looking_at(DVec3::new(-6.0, 0.0, 1.0), DVec3::new(0.0, 0.0, 1.0));
        let state = TargetState { feet_in_world: DVec3::ZERO, heading_rad: 3.1, speed_mps: 0.0 };
        let figure = BodyFigure {
            state,
            height_m: 1.75,
            radius_m: 0.3,
            clothes_seed: Seed([4; 32]),
            gait_phase_rad: 0.0,
            body: BodyShape::default(),
        };
        let mut images = FrameImages {
            width: 64,
            height: 64,
            depth_m: vec![6.0; 64 * 64],
            instance: vec![7; 64 * 64],
            ..FrameImages::default()
        };
        let bodies = [FigureInPicture { figure, instance: 7 }, FigureInPicture { figure, instance: 8 }];
        let shown = |images: &FrameImages, camera: Camera| {
            let taken = Taken { frame: 3, images, camera, lens: Lens::default(), pose };
            let found = taken.bodies(bodies);
            assert_eq!((found.len(), found[0].instance, found[0].frame), (1, 7, 3), "8 covers no pixel");
            assert!((found[0].centre_in_world.z - 0.875).abs() < 1e-12);
            found[0].key_points.iter().map(|point| point.shown).collect::<Vec<_>>()
        };
        assert_eq!(shown(&images, camera), [Shown::Visible; 17]);
        images.depth_m.fill(4.0);
        assert_eq!(shown(&images, camera), [Shown::Occluded; 17]);
        // A longer focal length shows the trunk alone.
        let near = shown(&images, Camera { horizontal_fov_rad: 0.1, ..camera });
        assert!(near.contains(&Shown::Outside));
    }
}
