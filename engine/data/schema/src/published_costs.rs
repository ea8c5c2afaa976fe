//! Costs of a flight as tables and plugins see them: those of its terms, and the coverage of an inspection.

use cosfly_domain::Trajectory;

/// Name of the coverage among the costs; no term has it.
const COVERAGE: &str = "coverage";

/// A published cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PublishedCost<'a> {
    /// Name of the term, or `coverage`.
    pub name: &'a str,
    /// Weight of the term; 0 for the coverage.
    pub weight: f64,
    /// Sum over the frames, unweighted.
    pub sum: f64,
    /// Unweighted cost of each frame.
    pub per_frame: &'a [f64],
}

/// Costs of a flight; the coverage is the last one, where there is one.
pub fn costs(flight: &Trajectory) -> impl Iterator<Item = PublishedCost<'_>> {
    let terms = flight.terms.iter().map(|term| PublishedCost {
        name: &term.name,
        weight: term.weight,
        sum: term.sum,
        per_frame: &term.per_frame,
    });
    let sum = flight.coverage.iter().sum();
    let coverage = PublishedCost { name: COVERAGE, weight: 0.0, sum, per_frame: &flight.coverage };
    terms.chain((!flight.coverage.is_empty()).then_some(coverage))
}
