//! Chains of stages whose items share commands: where item `i` of a cheap stage reads item `i` of another one, one command
//! does both, one after the other, so that a process is started once for the whole chain.

use crate::request::Request;
use cosfly_recipe::{Connection, Recipe};
use cosfly_stage::Fan;
use std::collections::BTreeSet;

/// The first stage of the chain of each stage, which is the stage itself where it begins one. Chains depend on the recipe and
/// the requests alone. Stages that are not cheap, which share no commands among their items, have none.
pub(crate) fn first_stages(recipe: &Recipe, kept: &BTreeSet<usize>, requests: &[Request]) -> Vec<usize> {
    // All stages that a stage reads, directly or not.
    let mut read: Vec<BTreeSet<usize>> = Vec::with_capacity(recipe.stages.len());
    let mut first: Vec<usize> = Vec::with_capacity(recipe.stages.len());
    for (stage, described) in recipe.stages.iter().enumerate() {
        let direct: BTreeSet<usize> =
            described.connections.iter().flat_map(|it| it.upstreams.iter().copied()).collect();
        let begins = described.connections.iter().find_map(|connection| {
            let upstream = aligned(recipe, connection)?;
            let begin = first[upstream];
            let is_cheap = requests[stage].batch > 1 && requests[stage] == requests[upstream];
            // What else the stage reads must be finished before the chain begins, or is of the same items of the chain.
            let fits = described.connections.iter().all(|other| {
                let in_chain = aligned(recipe, other).is_some_and(|it| first[it] == begin);
                in_chain || other.upstreams.iter().all(|it| read[begin].contains(it))
            });
            let is_kept = kept.contains(&stage) || kept.contains(&upstream);
            (is_cheap && fits && !is_kept).then_some(begin)
        });
        first.push(begins.unwrap_or(stage));
        let indirect = direct.iter().flat_map(|it| read[*it].iter().copied());
        let all = direct.iter().copied().chain(indirect).collect();
        read.push(all);
    }
    first
}

/// The stage whose item `i` feeds item `i` through a connection; `None` where items meet in another way.
fn aligned(recipe: &Recipe, connection: &Connection) -> Option<usize> {
    let [upstream] = connection.upstreams[..] else { return None };
    let is_aligned = connection.port.fan == Fan::Each
        && connection.arrivals.len() == recipe.stages[upstream].items.len()
        && connection.arrivals.iter().enumerate().all(|(index, arrival)| arrival.item == index);
    is_aligned.then_some(upstream)
}
