//! Dependency order of the stages, and cycles that prevent one.

use crate::document::{Place, Problems, Texts};
use crate::outline::Outline;
use cosfly_diagnose::{Diagnostic, Fault};
use std::collections::BTreeSet;

/// Stages that each stage reads: number and place in the recipe, for every name that exists.
pub(crate) type Reads = Vec<Vec<(usize, Place)>>;

/// Stage numbers in dependency order, inputs first; stages that are ready at the same time keep the order of the file.
///
/// # Errors
/// All cycles.
pub(crate) fn dependency_order(outline: &Outline, reads: &Reads, texts: &Texts) -> Result<Vec<usize>, Problems> {
    let mut waits: Vec<BTreeSet<usize>> =
        reads.iter().map(|upstreams| upstreams.iter().map(|(stage, _)| *stage).collect()).collect();
    let mut readers = vec![vec![]; reads.len()];
    for (stage, upstreams) in waits.iter().enumerate() {
        upstreams.iter().for_each(|upstream| readers[*upstream].push(stage));
    }
    let mut ready: BTreeSet<usize> = (0..reads.len()).filter(|stage| waits[*stage].is_empty()).collect();
    let mut order = vec![];
    while let Some(stage) = ready.pop_first() {
        order.push(stage);
        for reader in &readers[stage] {
            waits[*reader].remove(&stage);
            if waits[*reader].is_empty() {
                ready.insert(*reader);
            }
        }
    }
    if order.len() == reads.len() { Ok(order) } else { Err(cycles(outline, reads, &waits, texts)) }
}

/// Walks upstream from every stage that never became ready; each walk ends in a cycle.
fn cycles(outline: &Outline, reads: &Reads, waits: &[BTreeSet<usize>], texts: &Texts) -> Problems {
    let mut found = Problems::new();
    let mut seen = vec![false; reads.len()];
    for start in (0..reads.len()).filter(|stage| !waits[*stage].is_empty()) {
        let mut passed = vec![];
        let mut stage = start;
        while !seen[stage] {
            seen[stage] = true;
            passed.push(stage);
            stage = *waits[stage].first().expect("a stage that waits waits for a stage that waits");
        }
        if let Some(first) = passed.iter().position(|other| *other == stage) {
            found.push(cycle(outline, reads, &passed[first..], texts));
        }
    }
    found
}

fn cycle(outline: &Outline, reads: &Reads, stages: &[usize], texts: &Texts) -> Box<Diagnostic> {
    // Begin with the stage that is first in the file.
    let first = stages.iter().enumerate().min_by_key(|(_, stage)| **stage).map_or(0, |(index, _)| index);
    let name = |index: usize| &outline.stages[stages[(first + index) % stages.len()]].name;
    let reading: Vec<String> =
        (0..stages.len()).map(|index| format!("`{}` reads `{}`", name(index), name(index + 1))).collect();
    let message = match stages {
        [_] => format!("stage `{}` reads itself", name(0)),
        _ => format!("stages read each other in a cycle: {}", reading.join(", ")),
    };
    let mut problem = Diagnostic::new("recipe-cycle", Fault::Recipe, message);
    for index in 0..stages.len() {
        let stage = stages[(first + index) % stages.len()];
        let upstream = stages[(first + index + 1) % stages.len()];
        if let Some((_, place)) = reads[stage].iter().find(|(read, _)| *read == upstream) {
            problem = problem.at(texts.label(place, format!("`{}` reads it", outline.stages[stage].name)));
        }
    }
    problem.hint(match stages {
        [_] => "connect it to another stage",
        _ => "connect one of them to a stage outside the cycle",
    })
}
