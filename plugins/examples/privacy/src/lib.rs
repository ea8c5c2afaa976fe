//! `privacy`: keeps the camera from looking into given facades.

use cosfly_plugin::{CostTerm, Metadata, Point, Run, dot, length, libm, params, scale, sub};

params! {
    /// A facade seen from above, looking out to the right of the way from its first to its last corner.
    pub struct Facade {
        /// Where it begins, x y in metres.
        from: [f64; 2] = [0.0, 0.0];
        /// Where it ends, x y in metres.
        to: [f64; 2] = [1.0, 0.0];
        /// Height of its lower end, metres.
        low_m: f64 = 0.0, [-1000.0, 10000.0];
        /// Height of its upper end, metres.
        high_m: f64 = 12.0, [-1000.0, 10000.0];
    }
}

params! {
    /// Which windows are private.
    pub struct Params {
        /// The facades.
        facades: Vec<Facade> = vec![];
        /// Half of the camera's field of view, degrees.
        half_fov_deg: f64 = 45.0, [5.0, 90.0];
        /// Distance beyond which nothing can be made out, metres.
        reach_m: f64 = 60.0, [1.0, 1000.0];
    }
}

/// Points of a facade that stand for it, as shares of its length and height.
const WINDOWS: [[f64; 2]; 5] = [[0.5, 0.5], [0.15, 0.25], [0.85, 0.25], [0.15, 0.75], [0.85, 0.75]];

/// Per facade the mean over its windows of (how central in the picture) x (how near) x (how square-on), each 0 to 1.
pub struct Privacy {
    params: Params,
    /// (window, unit normal)
    windows: Vec<(Point, Point)>,
    aims: Vec<Point>,
    cos_half: f64,
}

impl CostTerm for Privacy {
    type Params = Params;

    fn describe() -> Metadata {
        let summary = "Keeps the camera from looking into given facades.";
        Metadata { name: "privacy", version: "0.1.0", summary }
    }

    fn new(params: Params) -> Result<Self, String> {
        let mut windows = Vec::new();
        for (index, facade) in params.facades.iter().enumerate() {
            let along = [facade.to[0] - facade.from[0], facade.to[1] - facade.from[1]];
            let width = (along[0] * along[0] + along[1] * along[1]).sqrt();
            if width < 0.1 || facade.low_m >= facade.high_m {
                return Err(format!("facade {index} has no area"));
            }
            let normal = [along[1] / width, -along[0] / width, 0.0];
            for [across, up] in WINDOWS {
                let height = facade.low_m + up * (facade.high_m - facade.low_m);
                windows
                    .push(([facade.from[0] + across * along[0], facade.from[1] + across * along[1], height], normal));
            }
        }
        let cos_half = libm::cos(params.half_fov_deg.to_radians());
        Ok(Self { params, windows, aims: vec![], cos_half })
    }

    fn begin(&mut self, run: Run) -> Result<(), String> {
        self.aims = run.body_points.iter().map(|body| body[2]).collect();
        Ok(())
    }

    fn evaluate(&self, waypoints: &[Point], costs: &mut [f64], _: Option<&mut [Point]>) -> Result<(), String> {
        for ((waypoint, aim), cost) in waypoints.iter().zip(&self.aims).zip(costs) {
            let view = sub(*aim, *waypoint);
            let view = scale(view, 1.0 / length(view).max(1e-6));
            for (window, normal) in &self.windows {
                let sight = sub(*window, *waypoint);
                let distance = length(sight).max(1e-6);
                let near = 1.0 - distance / self.params.reach_m;
                let square_on = -dot(sight, *normal) / distance;
                let central = (dot(sight, view) / distance - self.cos_half) / (1.0 - self.cos_half);
                if near > 0.0 && square_on > 0.0 && central > 0.0 {
                    *cost += near * square_on * central / WINDOWS.len() as f64;
                }
            }
        }
        Ok(())
    }
}

cosfly_plugin::cost_term!(Privacy);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn looking_at_windows_from_the_front_costs_and_from_behind_does_not() {
        let facades = vec![Facade { from: [0.0, 0.0], to: [0.0, 20.0], low_m: 0.0, high_m: 12.0 }];
        let mut term = Privacy::new(Params { facades, ..Params::default() }).unwrap();
        let cost = |term: &mut Privacy, drone: Point, aim: Point| {
            term.begin(Run { body_points: vec![[aim; 8]], ..Run::default() }).unwrap();
            let mut costs = [0.0];
            term.evaluate(&[drone], &mut costs, None).unwrap();
            costs[0]
        };
        // The facade runs along y, so it looks out to x > 0.
        assert!(cost(&mut term, [30.0, 10.0, 20.0], [5.0, 10.0, 1.0]) > 0.1);
        assert_eq!(cost(&mut term, [30.0, 10.0, 20.0], [60.0, 10.0, 1.0]), 0.0);
        assert_eq!(cost(&mut term, [-30.0, 10.0, 20.0], [-5.0, 10.0, 1.0]), 0.0);
    }
}
