//! `sun_glare`: keeps the sun away from the middle of the picture.

use cosfly_plugin::{CostTerm, Metadata, Point, Run, dot, length, libm, params, sub};

params! {
    /// Where the sun is.
    pub struct Params {
        /// Direction of the sun, degrees from x towards y.
        azimuth_deg: f64 = 0.0, [-360.0, 360.0];
        /// Height of the sun above the horizon, degrees.
        elevation_deg: f64 = 10.0, [-10.0, 90.0];
        /// Angle between the camera's axis and the sun at which the glare begins, degrees.
        half_angle_deg: f64 = 75.0, [5.0, 120.0];
    }
}

/// `((cos a - cos h) / (1 - cos h))^2` where the angle a between axis and sun is smaller than h: 1 straight into the sun.
pub struct SunGlare {
    sun: Point,
    cos_half: f64,
    aims: Vec<Point>,
}

impl CostTerm for SunGlare {
    type Params = Params;

    fn describe() -> Metadata {
        let summary = "Keeps the sun away from the middle of the picture.";
        Metadata { name: "sun_glare", version: "0.1.0", summary }
    }

    fn new(params: Params) -> Result<Self, String> {
        let (azimuth, elevation) = (params.azimuth_deg.to_radians(), params.elevation_deg.to_radians());
        let across = libm::cos(elevation);
        let sun = [across * libm::cos(azimuth), across * libm::sin(azimuth), libm::sin(elevation)];
        Ok(Self { sun, cos_half: libm::cos(params.half_angle_deg.to_radians()), aims: vec![] })
    }

    fn begin(&mut self, run: Run) -> Result<(), String> {
        self.aims = run.body_points.iter().map(|body| body[2]).collect();
        Ok(())
    }

    fn evaluate(&self, waypoints: &[Point], costs: &mut [f64], _: Option<&mut [Point]>) -> Result<(), String> {
        for ((waypoint, aim), cost) in waypoints.iter().zip(&self.aims).zip(costs) {
            let view = sub(*aim, *waypoint);
            let cosine = dot(view, self.sun) / length(view).max(1e-6);
            let glare = ((cosine - self.cos_half) / (1.0 - self.cos_half)).max(0.0);
            *cost = glare * glare;
        }
        Ok(())
    }
}

cosfly_plugin::cost_term!(SunGlare);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn straight_into_the_sun_costs_one_and_away_from_it_nothing() {
        let mut term = SunGlare::new(Params { elevation_deg: 0.0, ..Params::default() }).unwrap();
        term.begin(Run { body_points: vec![[[10.0, 0.0, 0.0]; 8]; 2], ..Run::default() }).unwrap();
        let mut costs = [0.0; 2];
        term.evaluate(&[[0.0; 3], [20.0, 0.0, 0.0]], &mut costs, None).unwrap();
        assert!((costs[0] - 1.0).abs() < 1e-12 && costs[1] == 0.0, "{costs:?}");
    }
}
