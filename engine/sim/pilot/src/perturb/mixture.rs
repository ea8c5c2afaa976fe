//! The mixture of kinds of perturbation that each flight draws one from.

use cosfly_planner::trajectory::Kind;
use cosfly_random::Seed;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Shares of the kinds of perturbation among the flights: each flight draws one kind. The shares are relative to their sum.
/// All kinds but `jumps` drift away from the expert's way and back, and do what they are named after besides.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Mixture {
    /// The paper's: two independent events per frame displace the drone and turn its view. No drone could fly it: 2 to 3 m
    /// between frames are some 40 m/s^2. Default 1.
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub jumps: f64,
    /// Nothing but the drift. Default 0.
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub drift: f64,
    /// Gusts push the drone aside, from which it recovers. Default 0.
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub gusts: f64,
    /// The drone flies the expert's way early or late, and so turns early or late. Default 0.
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub timing: f64,
    /// The camera aims coarsely and late. Default 0.
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub aim: f64,
    /// The camera loses the target at times, looks for it to both sides, and finds it again. Default 0.
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub search: f64,
}

impl Default for Mixture {
    fn default() -> Self {
        Self { jumps: 1.0, drift: 0.0, gusts: 0.0, timing: 0.0, aim: 0.0, search: 0.0 }
    }
}

impl Mixture {
    /// The shares in the order of [`Kind::ALL`].
    pub fn shares(&self) -> [f64; 6] {
        [self.jumps, self.drift, self.gusts, self.timing, self.aim, self.search]
    }

    /// The kind of the flight with a seed.
    pub fn draw(&self, seed: &Seed) -> Kind {
        let shares = self.shares();
        let mut left = seed.stream("kind").uniform(0.0, shares.iter().sum());
        for (kind, share) in Kind::ALL.into_iter().zip(shares) {
            if left < share {
                return kind;
            }
            left -= share;
        }
        Kind::Jumps
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flights_have_the_shares_that_the_mixture_states() {
        let mixture = Mixture { jumps: 2.0, drift: 1.0, search: 1.0, ..Mixture::default() };
        let drawn: Vec<Kind> =
            (0..4000).map(|number| mixture.draw(&Seed::of_item(1, "perturbed", &format!("p{number}")))).collect();
        for (kind, share) in [(Kind::Jumps, 0.5), (Kind::Drift, 0.25), (Kind::Search, 0.25), (Kind::Gusts, 0.0)] {
            let found = drawn.iter().filter(|it| **it == kind).count() as f64 / 4000.0;
            assert!((found - share).abs() < 0.03, "{kind:?} {found}");
        }
        assert_eq!(Mixture::default().draw(&Seed([3; 32])), Kind::Jumps);
    }
}
