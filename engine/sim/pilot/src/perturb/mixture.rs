//! The mixture of kinds of perturbation, and the kind of each flight.

use cosfly_domain::PerturbationKind;
use cosfly_random::Seed;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Shares of the kinds of perturbation among the flights: each flight has one kind, and every kind has its share of the first N
/// flights to within one flight, for any N. The shares are relative to their sum.
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

/// Rounding of sums of shares.
const TOLERANCE: f64 = 1e-9;

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

    /// The mixture of flight number `number` (from 0) among those that share this one: its kind alone. Kinds take turns so that
    /// after any number of flights each has been given its share of them to within one flight; further flights change none
    /// before them. `order` decides between kinds whose turn it is alike.
    ///
    /// Tijdeman's chairman assignment (The chairman assignment problem, 1980): of the kinds that are owed enough, the one whose
    /// turn must come first.
    pub fn of_flight(&self, number: u64, order: &Seed) -> Self {
        let shares = self.shares();
        let sum: f64 = shares.iter().sum();
        let kinds: Vec<(Kind, f64)> = Kind::ALL
            .into_iter()
            .zip(shares)
            .filter(|it| it.1 > 0.0)
            .map(|(kind, share)| (kind, share / sum))
            .collect();
        let [.., last] = kinds[..] else { return self.clone() };
        if kinds.len() == 1 {
            return Self::only(last.0);
        }
        let slack = 1.0 / (2 * kinds.len() - 2) as f64;
        let mut given = vec![0.0; kinds.len()];
        let mut ties = order.stream("turns");
        let mut chosen = 0;
        for turn in 0..=number {
            let is_owed = |at: &usize| kinds[*at].1 * (turn + 1) as f64 - given[*at] >= slack - TOLERANCE;
            let latest = |at: usize| (given[at] + 1.0 - slack) / kinds[at].1;
            let owed: Vec<usize> = (0..kinds.len()).filter(is_owed).collect();
            let first = owed.iter().map(|at| latest(*at)).fold(f64::INFINITY, f64::min);
            let alike: Vec<usize> = owed.into_iter().filter(|at| latest(*at) <= first * (1.0 + TOLERANCE)).collect();
            chosen = alike.get(ties.index(alike.len())).copied().unwrap_or(chosen);
            given[chosen] += 1.0;
        }
        Self::only(kinds[chosen].0)
    }

    /// The mixture of one kind.
    fn only(kind: Kind) -> Self {
        let [jumps, drift, gusts, timing, aim, search] = Kind::ALL.map(|it| f64::from(u8::from(it == kind)));
        Self { jumps, drift, gusts, timing, aim, search }
    }

    /// The kind of the flight with a seed: of a mixture of several kinds, one by chance.
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

    /// Kinds of the first flights.
    fn first(mixture: &Mixture, count: u64, order: &str) -> Vec<Kind> {
        let order = Seed::of_item(0, "mixture", order);
        (0..count).map(|number| mixture.of_flight(number, &order).draw(&Seed([number as u8; 32]))).collect()
    }

    #[test]
    fn every_kind_has_its_share_of_any_number_of_first_flights_to_within_one() {
        let mut random = Seed::of_item(1, "test", "mixtures").stream("test");
        for round in 0..60 {
            let share = |random: &mut cosfly_random::RandomStream| {
                if random.chance(0.3) { 0.0 } else { (random.uniform(0.0, 9.0) * 4.0).ceil() / 4.0 }
            };
            let [jumps, drift, gusts, timing, aim, search] = [(); 6].map(|()| share(&mut random));
            let mixture = Mixture { jumps: jumps + 0.25, drift, gusts, timing, aim, search };
            let kinds = first(&mixture, 120, &round.to_string());
            let sum: f64 = mixture.shares().iter().sum();
            for (kind, share) in Kind::ALL.into_iter().zip(mixture.shares()) {
                let mut found = 0.0;
                for (at, one) in kinds.iter().enumerate() {
                    found += f64::from(u8::from(*one == kind));
                    let due = share / sum * (at + 1) as f64;
                    assert!((found - due).abs() < 1.0, "{mixture:?} {kind:?}: {found} of {due} after {}", at + 1);
                }
            }
        }
    }

    #[test]
    fn small_sets_miss_no_kind_and_one_more_flight_changes_none() {
        // The mixture of `carla_town.toml`.
        let mixture = Mixture { jumps: 2.0, drift: 1.0, gusts: 1.0, timing: 1.0, aim: 1.0, search: 1.0 };
        for order in ["perturbed", "perturbed_uptown", "twins"] {
            let kinds = first(&mixture, 14, order);
            for kind in Kind::ALL {
                let expected = if kind == Kind::Jumps { 2 } else { 1 };
                assert_eq!(kinds[..7].iter().filter(|it| **it == kind).count(), expected, "{order} {kind:?}");
            }
            assert_eq!(first(&mixture, 8, order), kinds[..8]);
        }
        assert_ne!(first(&mixture, 14, "perturbed"), first(&mixture, 14, "twins"));
        assert_eq!(first(&Mixture::default(), 3, "perturbed"), [Kind::Jumps; 3]);
    }
}
