//! `seconds_to_loss`: labels every frame with the time until the target is out of sight, for training to foresee it.

use cosfly_plugin::{Answer, Column, Flight, Gives, Metadata, Stage, params, reals};

params! {
    /// When a target counts as lost.
    pub struct Params {
        /// Visibility below which the target counts as lost.
        visibility: f64 = 0.5, [0.0, 1.0];
        /// Longest time that is told, seconds; also told when it is not lost any more.
        horizon_s: f64 = 10.0, [0.1, 600.0];
    }
}

/// See the crate.
pub struct SecondsToLoss(Params);

impl Stage for SecondsToLoss {
    type Params = Params;

    fn describe() -> Metadata {
        let summary = "Labels every frame with the time until the target is out of sight.";
        Metadata { name: "seconds_to_loss", version: "0.1.0", summary }
    }

    fn new(params: Params) -> Result<Self, String> {
        Ok(Self(params))
    }

    fn reads(&self) -> Vec<Column> {
        reals(["time_s", "visibility"])
    }

    fn gives(&self) -> Gives {
        Gives::Labels(vec![Column::real("seconds_to_loss", "seconds until the target is out of sight")])
    }

    fn run(&self, flight: &Flight) -> Result<Answer, String> {
        let (times, seen) = (flight.column("time_s")?, flight.column("visibility")?);
        let mut left = vec![self.0.horizon_s; times.len()];
        let mut lost_at = f64::INFINITY;
        for frame in (0..times.len()).rev() {
            if seen[frame] < self.0.visibility {
                lost_at = times[frame];
            }
            left[frame] = (lost_at - times[frame]).min(self.0.horizon_s);
        }
        Ok(Answer::Labels(vec![left]))
    }
}

cosfly_plugin::stage!(SecondsToLoss);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_runs_down_to_the_loss_and_is_capped() {
        let flight = Flight::new("p", &[("time_s", &[0.0, 1.0, 2.0, 3.0]), ("visibility", &[1.0, 1.0, 0.0, 1.0])]);
        let stage = SecondsToLoss::new(Params { horizon_s: 1.5, ..Params::default() }).unwrap();
        assert_eq!(stage.run(&flight), Ok(Answer::Labels(vec![vec![1.5, 1.0, 0.0, 1.5]])));
    }
}
