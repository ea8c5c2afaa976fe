//! People who may change a picture, told without drawing it.

use crate::body_bounds::Bounds;
use cosfly_domain::{Camera, Weather};
use cosfly_figures::BodyFigure;
use cosfly_frames::{DVec3, Pose};
use cosfly_materials::far_light::FarLight;
use cosfly_raster::eye::Eye;
use cosfly_raster::visibility::Screen;

/// The view of an ideal camera at a moment.
pub struct Outlook {
    eye: Eye,
    screen: Screen,
    far: FarLight,
}

impl Outlook {
    /// The view of `camera` from `pose`.
    pub fn new(camera: &Camera, weather: &Weather, pose: &Pose) -> Self {
        Self { eye: Eye::new(pose), screen: Screen::new(camera), far: FarLight::of(weather) }
    }

    /// False where every renderer leaves a person out, whatever hides or surrounds them: the body is less than a pixel
    /// high, or neither the body nor its shadow nor the light of its lamps is in view.
    pub fn may_show(&self, figure: &BodyFigure) -> bool {
        figure.has_body() && Bounds::new(figure).may_matter(figure, &self.eye, &self.screen, self.far)
    }

    /// Corners of a convex hull around a body and all that it darkens or lights above a height, metres: whatever hides the hull from
    /// the camera hides all of that.
    pub fn hull(&self, figure: &BodyFigure, lowest_m: f64) -> [DVec3; 16] {
        Bounds::new(figure).hull(lowest_m, self.far)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_figures::BodyShape;
    use cosfly_frames::{Seed, TargetState};

    fn figure(x: f64, y: f64) -> BodyFigure {
        BodyFigure {
            state: TargetState { feet_in_world: DVec3::new(x, y, 0.0), heading_rad: 0.4, speed_mps: 1.3 },
            height_m: 1.8,
            radius_m: 0.3,
            clothes_seed: Seed([1; 32]),
            gait_phase_rad: 0.5,
            body: BodyShape::default(),
        }
    }

    #[test]
    fn people_out_of_view_do_not_show_and_those_whose_shadow_is_in_view_do() {
        let camera = Camera { width: 640, height: 360, horizontal_fov_rad: 1.0 };
        let mut weather = cosfly_materials::presets::preset("ClearNoon").expect("a preset");
        (weather.sun_altitude_angle, weather.sun_azimuth_angle) = (20.0, 0.0);
        let pose = Pose::looking_at(DVec3::new(0.0, 0.0, 10.0), DVec3::new(0.0, 30.0, 0.0));
        let outlook = Outlook::new(&camera, &weather, &pose);
        assert!(outlook.may_show(&figure(0.0, 30.0)) && outlook.may_show(&figure(5.0, 60.0)));
        assert!(!outlook.may_show(&figure(0.0, -30.0)));
        // The shadow falls away from the sun.
        let beside = [figure(22.0, 30.0), figure(-22.0, 30.0)].map(|figure| outlook.may_show(&figure));
        assert_eq!(beside.iter().filter(|shows| **shows).count(), 1);
        // Farther than a body is a pixel high.
        assert!(!outlook.may_show(&figure(0.0, 1500.0)));
    }

    #[test]
    fn the_hull_holds_body_and_shadow_down_to_the_lowest_place() {
        let weather = cosfly_materials::presets::preset("ClearSunset").expect("a preset");
        let camera = Camera { width: 64, height: 36, horizontal_fov_rad: 1.0 };
        let pose = Pose::looking_at(DVec3::new(0.0, 0.0, 10.0), DVec3::ZERO);
        let outlook = Outlook::new(&camera, &weather, &pose);
        let figure = figure(3.0, 4.0);
        let (flat, deep) = (outlook.hull(&figure, 0.0), outlook.hull(&figure, -100.0));
        let length = |hull: &[DVec3]| {
            let far = hull.iter().map(|corner| (*corner - figure.state.feet_in_world).truncate().length());
            far.fold(0.0, f64::max)
        };
        assert!(length(&flat) > 4.0 && length(&flat) < length(&deep) && length(&deep) < 100.0);
    }
}
