//! Needs of stages towards those that they read: names of variants, numbers below those of others.

use crate::document::list;
use crate::model::{Connection, RecipeStage};
use cosfly_diagnose::{ParameterError, nearest_name};
use cosfly_stage::StageNeed;
use cosfly_stage::parameters::refused_at;
use std::collections::BTreeSet;

/// Checks what a stage needs of the stages in `done` that its ports are connected to.
///
/// # Errors
/// The first need that is not met, at its parameter.
pub(crate) fn check(
    needs: &[StageNeed],
    connections: &[Connection],
    done: &[RecipeStage],
) -> Result<(), ParameterError> {
    needs.iter().try_for_each(|need| match need {
        StageNeed::Variant { parameter, port, name } => variant((parameter, port), name, connections, done),
        StageNeed::LessThan { parameter, number, port, other, times } => {
            let theirs = above_port(port, connections, done).into_iter().map(|index| &done[index]);
            let parameter_of = |stage: &RecipeStage| stage.stage.properties().parameters.get(*other)?.as_f64();
            let bounds = theirs.filter_map(|stage| Some((stage, times * parameter_of(stage)?)));
            let Some((stage, most)) = bounds.min_by(|a, b| a.1.total_cmp(&b.1)) else { return Ok(()) };
            if *number + 1e-9 <= most {
                return Ok(());
            }
            let name = &stage.name;
            let message = match *times == 1.0 {
                true => format!("`{number}` is not less than `{most}`, the `{other}` of `{name}`"),
                false => format!("`{number}` is not less than `{most}`, {times} times the `{other}` of `{name}`"),
            };
            let hint = Some(format!("set a number below {most}, or a larger `{other}` of `{name}`"));
            Err(ParameterError { hint, ..refused_at(parameter, message) })
        }
    })
}

fn variant(
    (parameter, port): (&str, &str),
    name: &str,
    connections: &[Connection],
    done: &[RecipeStage],
) -> Result<(), ParameterError> {
    let arrivals = connections.iter().filter(|it| it.port.name == port).flat_map(|it| it.arrivals.iter());
    let known: BTreeSet<&str> = arrivals.filter_map(|it| done[it.stage].items[it.item].variant()).collect();
    if known.contains(name) {
        return Ok(());
    }
    let message = format!("no item at `inputs.{port}` is called `{name}`");
    let hint = match (nearest_name(name, known.iter().copied()), known.is_empty()) {
        (Some(near), _) => format!("did you mean `{near}`?"),
        (None, true) => format!("leave the key out: the items at `inputs.{port}` have no such names"),
        (None, false) => format!("names there: {}", list(known.iter().copied(), 40)),
    };
    Err(ParameterError { hint: Some(hint), ..refused_at(parameter, message) })
}

/// Stages that are connected to a port, and all that they read.
fn above_port(port: &str, connections: &[Connection], done: &[RecipeStage]) -> BTreeSet<usize> {
    let own = connections.iter().filter(|it| it.port.name == port).flat_map(|it| it.upstreams.iter().copied());
    let (mut found, mut open) = (BTreeSet::new(), own.collect::<Vec<_>>());
    while let Some(index) = open.pop() {
        if found.insert(index) {
            open.extend(done[index].connections.iter().flat_map(|it| it.upstreams.iter().copied()));
        }
    }
    found
}
