//! `cosfly why`: the parameter or input that changed a key.

use super::{Outcome, recipe, store_dir};
use crate::arguments::WhyArguments;
use crate::exit;
use cosfly_runner::Explanation;
use cosfly_store::Store;
use std::fmt::Write;

/// Prints the explanation.
pub fn why(arguments: &WhyArguments) -> Outcome {
    let recipe = recipe(&arguments.recipe)?;
    let store = Store::open_to_read(&store_dir(&arguments.store)).map_err(|refusal| vec![refusal])?;
    let (stage, item) = match arguments.subject.split_once('/') {
        Some((stage, item)) => (stage, Some(item)),
        None => (arguments.subject.as_str(), None),
    };
    let explanation = cosfly_runner::why(&recipe, &store, stage, item).map_err(|refusal| vec![refusal])?;
    crate::print(&told(&explanation))?;
    Ok(exit::SUCCESS)
}

/// Text of an explanation: the chain from the task to the root cause, one indentation per step upstream.
fn told(explanation: &Explanation) -> String {
    let subject = &explanation.id;
    let mut text = match (explanation.finished, explanation.chain.is_empty()) {
        (true, true) => format!("`{subject}` is cached; nothing has changed since it was first made\n"),
        (true, false) => format!("`{subject}` is cached; the last time it was made, it was because\n"),
        (false, _) => format!("`{subject}` would run, because\n"),
    };
    for (depth, link) in explanation.chain.iter().enumerate() {
        let indent = "  ".repeat(depth + 1);
        for change in &link.changes {
            let _ = writeln!(text, "{indent}{}: {change}", link.id);
        }
    }
    text
}
