//! `wind`: energy against a wind that grows with height; with gradient.

use cosfly_plugin::{CostTerm, Metadata, Point, Run, Shape, length, libm, params};

params! {
    /// The wind and what it takes to fly against it.
    pub struct Params {
        /// Speed of the wind at the reference height, m/s.
        speed_mps: f64 = 6.0, [0.0, 40.0];
        /// Where it blows to, degrees from x towards y.
        toward_deg: f64 = 0.0, [-360.0, 360.0];
        /// Height at which it has that speed, metres.
        reference_m: f64 = 10.0, [1.0, 200.0];
        /// How fast it grows with height: speed times (height / reference) to this power.
        shear: f64 = 0.2, [0.0, 1.0];
    }
}

/// Height below which the wind grows no weaker, metres.
const LOWEST_M: f64 = 1.0;

/// Power against drag of a frame's step, `|v - wind(z)|^3 / 1000`: kilowatts for a drone of drag area 1.6 m^2.
pub struct Wind {
    params: Params,
    toward: [f64; 2],
    dt: f64,
}

impl Wind {
    /// Speed at a height, and how it grows with it.
    fn speed(&self, height: f64) -> (f64, f64) {
        let Params { speed_mps, reference_m, shear, .. } = self.params;
        let speed = speed_mps * libm::pow(height.max(LOWEST_M) / reference_m, shear);
        (speed, if height > LOWEST_M { shear * speed / height } else { 0.0 })
    }

    /// Velocity through the air on the way from a waypoint to the next.
    fn airspeed(&self, from: Point, to: Point) -> Point {
        let (wind, _) = self.speed(from[2]);
        let along = |axis: usize| (to[axis] - from[axis]) / self.dt;
        [along(0) - wind * self.toward[0], along(1) - wind * self.toward[1], along(2)]
    }
}

impl CostTerm for Wind {
    type Params = Params;

    fn describe() -> Metadata {
        Metadata { name: "wind", version: "0.1.0", summary: "Saves energy against a wind that grows with height." }
    }

    fn new(params: Params) -> Result<Self, String> {
        let angle = params.toward_deg.to_radians();
        Ok(Self { toward: [libm::cos(angle), libm::sin(angle)], params, dt: 1.0 })
    }

    /// A step reads its own waypoint and the next.
    fn shape(&self) -> Shape {
        Shape { support: 1, gradients: true }
    }

    fn begin(&mut self, run: Run) -> Result<(), String> {
        self.dt = run.dt;
        Ok(())
    }

    fn evaluate(
        &self,
        waypoints: &[Point],
        costs: &mut [f64],
        mut gradients: Option<&mut [Point]>,
    ) -> Result<(), String> {
        for (frame, pair) in waypoints.windows(2).enumerate() {
            let air = self.airspeed(pair[0], pair[1]);
            let speed = length(air);
            costs[frame] = speed * speed * speed / 1000.0;
            if let Some(gradients) = gradients.as_deref_mut() {
                let by_air = 3.0 * speed / 1000.0;
                for axis in 0..3 {
                    let slope = by_air * air[axis] / self.dt;
                    gradients[frame][axis] -= slope;
                    gradients[frame + 1][axis] += slope;
                }
                let (_, growth) = self.speed(pair[0][2]);
                gradients[frame][2] -= by_air * growth * (air[0] * self.toward[0] + air[1] * self.toward[1]);
            }
        }
        Ok(())
    }
}

cosfly_plugin::cost_term!(Wind);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flying_with_the_wind_is_cheap_and_the_gradient_is_the_slope() {
        let mut term = Wind::new(Params::default()).unwrap();
        term.begin(Run { dt: 0.5, ..Run::default() }).unwrap();
        let costs = |points: &[Point]| {
            let mut costs = vec![0.0; points.len()];
            term.evaluate(points, &mut costs, None).unwrap();
            costs.iter().sum::<f64>()
        };
        let (with, against) = ([[0.0, 0.0, 10.0], [3.0, 0.0, 10.0]], [[3.0, 0.0, 10.0], [0.0, 0.0, 10.0]]);
        assert!(costs(&with) < 1e-12 && costs(&against) > 1.0);
        let points = [[0.0, 0.0, 10.0], [1.0, 2.0, 12.0], [4.0, 1.0, 15.0]];
        let mut slopes = [[0.0; 3]; 3];
        term.evaluate(&points, &mut [0.0; 3], Some(&mut slopes)).unwrap();
        for frame in 0..3 {
            for axis in 0..3 {
                let (mut low, mut high) = (points, points);
                low[frame][axis] -= 1e-5;
                high[frame][axis] += 1e-5;
                let wanted = (costs(&high) - costs(&low)) / 2e-5;
                assert!((slopes[frame][axis] - wanted).abs() < 1e-6, "{frame} {axis}");
            }
        }
    }
}
