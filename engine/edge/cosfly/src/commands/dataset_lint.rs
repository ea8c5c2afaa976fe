//! `cosfly dataset lint`: leaks between the splits of one or several datasets.

use super::Outcome;
use crate::arguments::LintArguments;
use crate::exit;
use crate::text::count;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_splits::policy::SplitPolicy;
use cosfly_splits::{FlightFacts, LintRules, facts_of_dataset, lint};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

/// Prints one line per leak and what was compared.
pub fn dataset_lint(arguments: &LintArguments) -> Outcome {
    let policies = arguments.dirs.iter().map(|dir| policy(dir)).collect::<Result<Vec<_>>>();
    let policies = policies.map_err(|refusal| vec![refusal])?;
    let rules = LintRules {
        max_route_overlap: match arguments.max_route_overlap {
            Some(share) if (0.0..=1.0).contains(&share) => share,
            Some(share) => return Err(vec![out_of_range(share)]),
            None => policies.first().map_or(0.5, |policy| policy.splits.max_route_overlap),
        },
        by_town: arguments.by_town || policies.iter().all(|policy| policy.rules().by_town),
    };
    let window = policies.first().map_or(10, |policy| policy.windows.shape().size());
    let mut facts = vec![];
    for (number, dir) in arguments.dirs.iter().enumerate() {
        facts.extend(facts_of_dataset(dir, number, window).map_err(|refusal| vec![refusal])?);
    }
    let leaks = lint(&facts, &rules);
    let mut text = String::new();
    for leak in &leaks.kept {
        let _ = writeln!(text, "{leak}");
    }
    if leaks.found > leaks.kept.len() {
        let _ = writeln!(text, "... and {} more", leaks.found - leaks.kept.len());
    }
    text += &compared(&facts, &rules);
    let _ = match leaks.found {
        0 => writeln!(text, "no leak was found"),
        found => writeln!(text, "{} found", count(found as u64, "leak")),
    };
    crate::print(&text)?;
    Ok(if leaks.found == 0 { exit::SUCCESS } else { exit::FOUND_PROBLEMS })
}

fn policy(dir: &Path) -> Result<SplitPolicy> {
    SplitPolicy::of_dataset(dir).map_err(|message| {
        let file = dir.join(cosfly_splits::policy::FILE);
        Diagnostic::new("dataset-damaged", Fault::Input, format!("`{}` cannot be read", file.display()))
            .because(message)
    })
}

fn out_of_range(share: f64) -> Box<Diagnostic> {
    let message = format!("`--max-route-overlap` is `{share}`; it must be from 0 to 1");
    Diagnostic::new("dataset-lint-share", Fault::Recipe, message)
}

/// How many flights of which towns are in which split.
fn compared(facts: &[FlightFacts], rules: &LintRules) -> String {
    let mut text = String::new();
    let mut towns: BTreeMap<(&str, &str), BTreeMap<&str, u64>> = BTreeMap::new();
    for it in facts {
        *towns.entry((&it.town, it.layout.short())).or_default().entry(&it.split).or_default() += 1;
    }
    for ((town, layout), splits) in towns {
        let splits: Vec<String> =
            splits.iter().map(|(split, flights)| format!("{} in `{split}`", count(*flights, "flight"))).collect();
        let _ = writeln!(text, "town `{town}` (ground plan {layout}): {}", splits.join(", "));
    }
    let places = if rules.by_town { "one split per town" } else { "towns may be in all splits" };
    let _ =
        writeln!(text, "rules: walks repeat at most {:.0} % of each other; {places}", 100.0 * rules.max_route_overlap);
    text
}
