//! `twin`: a plugin that exists natively, too, for `cosfly-lab plugins`.
#![cfg(target_family = "wasm")]
use cosfly_plugin::{CostTerm, Metadata, Point, Run, params, per_waypoint};

mod kernels;

params! {
    /// Which of the kernels.
    pub struct Params {
        /// `true` for the one full of functions, `false` for the one of a single square root.
        heavy: bool = false;
    }
}

struct Twin {
    params: Params,
    feet: Vec<Point>,
}

impl CostTerm for Twin {
    type Params = Params;

    fn describe() -> Metadata {
        Metadata { name: "twin", version: "0.1.0", summary: "For measuring the border." }
    }

    fn new(params: Params) -> Result<Self, String> {
        Ok(Self { params, feet: vec![] })
    }

    fn begin(&mut self, run: Run) -> Result<(), String> {
        self.feet = run.targets;
        Ok(())
    }

    fn evaluate(&self, waypoints: &[Point], costs: &mut [f64], _: Option<&mut [Point]>) -> Result<(), String> {
        if self.params.heavy {
            let each = waypoints.iter().zip(&self.feet).zip(costs);
            each.for_each(|((waypoint, feet), cost)| *cost = kernels::heavy(*waypoint, *feet));
        } else {
            per_waypoint(waypoints, &self.feet, costs, |waypoint, feet| kernels::root(waypoint, *feet));
        }
        Ok(())
    }
}

cosfly_plugin::cost_term!(Twin);
