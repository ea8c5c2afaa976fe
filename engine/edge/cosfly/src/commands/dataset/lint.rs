//! `cosfly dataset lint`: leaks between the splits of one or several datasets.

use crate::command::{Command, Outcome};
use crate::console::Console;
use crate::exit;
use crate::text::count;
use clap::Parser;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_schema::config::OverlapDirection;
use cosfly_splits::policy::SplitPolicy;
use cosfly_splits::{Balance, FlightFacts, LintRules, facts_of_dataset, lint, ways_back};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Pairs of opposite walks that are named.
const NAMED: usize = 8;

/// Look for leaks between the splits of one or several datasets, and name the pairs
#[derive(Debug, Parser)]
#[command(
    name = "lint",
    after_help = "\
Examples:
  cosfly dataset lint out/carla_town
  cosfly dataset lint out/Town01 out/Town02_Opt --by-town   no place may be in two splits, whatever it is called

A leak is a town with the same ground plan under two names, a pedestrian or a pair of twins in two splits, a walk that repeats
another one, or two equal windows. Each finding names both flights and both splits. Exits with 1 when there is a leak.

Walks over the same ground in opposite directions are counted; they are leaks with --either-direction, or where the recipe has
`splits.overlap_direction = \"either\"`."
)]
pub struct Arguments {
    /// Folders of finished datasets, judged as one dataset
    #[arg(required = true, value_name = "DATASET")]
    dirs: Vec<PathBuf>,
    /// A town must be in one split only, so that `val` and `test` show unseen towns
    #[arg(long)]
    by_town: bool,
    /// Share of a walk that a walk of another split may repeat [default: the rule of the first dataset]
    #[arg(long, value_name = "SHARE")]
    max_route_overlap: Option<f64>,
    /// Count the way back as a repeated walk, too [default: the rule of the first dataset]
    #[arg(long)]
    either_direction: bool,
}

impl Command for Arguments {
    fn run(&self, console: &dyn Console) -> Outcome {
        let policies = self.dirs.iter().map(|dir| policy(dir)).collect::<Result<Vec<_>>>()?;
        let rules = LintRules {
            max_route_overlap: match self.max_route_overlap {
                Some(share) if (0.0..=1.0).contains(&share) => share,
                Some(share) => return Err(out_of_range(share).into()),
                None => policies.first().map_or(0.5, |policy| policy.splits.max_route_overlap),
            },
            overlap_direction: match policies.first() {
                Some(policy) if !self.either_direction => policy.splits.overlap_direction,
                _ => OverlapDirection::Either,
            },
            by_town: self.by_town || policies.iter().all(|policy| policy.rules().by_town),
            by_kind: policies.iter().all(|policy| policy.rules().by_kind),
        };
        let window = policies.first().map_or(10, |policy| policy.windows.shape().size());
        let stop = console.stop();
        let mut facts = vec![];
        for (number, dir) in self.dirs.iter().enumerate() {
            facts.extend(facts_of_dataset(dir, number, 0, &stop)?);
        }
        let mut leaks = lint(&facts, &rules);
        let dirs: Vec<&Path> = self.dirs.iter().map(PathBuf::as_path).collect();
        leaks.of_windows(&facts, &dirs, window, &stop)?;
        if let [policy] = &policies[..] {
            leaks.of_areas(&facts, &policy.splits);
        }
        let mut text = String::new();
        for leak in &leaks.kept {
            let _ = writeln!(text, "{leak}");
        }
        if leaks.found > leaks.kept.len() {
            let _ = writeln!(text, "... and {} more", leaks.found - leaks.kept.len());
        }
        text += &compared(&facts, &rules);
        text += &opposite(&facts, &rules);
        // The shares are those of one dataset.
        if let [policy] = &policies[..] {
            let balance = Balance::of(&facts, &policy.splits, 0);
            let _ = writeln!(text, "{}", balance.told());
            balance.warnings().iter().for_each(|warning| {
                let _ = writeln!(text, "{warning}");
            });
        }
        let _ = match leaks.found {
            0 => writeln!(text, "no leak was found"),
            found => writeln!(text, "{} found", count(found as u64, "leak")),
        };
        console.print(&text)?;
        Ok(if leaks.found == 0 { exit::SUCCESS } else { exit::FOUND_PROBLEMS })
    }
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

/// Pairs of walks over the same ground in opposite directions, which the rules allow.
fn opposite(facts: &[FlightFacts], rules: &LintRules) -> String {
    let notes = ways_back(facts, rules);
    let mut text = String::new();
    for note in notes.kept.iter().take(NAMED) {
        let _ = writeln!(text, "note: {note}");
    }
    if notes.found > NAMED {
        let _ = writeln!(text, "note: ... and {} more", notes.found - NAMED);
    }
    if rules.overlap_direction == OverlapDirection::Same {
        let pairs = count(notes.found as u64, "pair");
        let _ = writeln!(
            text,
            "{pairs} of walks in two splits lead over the same ground in opposite directions{}",
            if notes.found == 0 { "" } else { "; `splits.overlap_direction = \"either\"` keeps them together" }
        );
    }
    text
}

/// Numbers of flights by town and split.
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
    let places = match (rules.by_kind, rules.by_town) {
        (true, _) => "one split per kind of town",
        (false, true) => "one split per town",
        (false, false) => "towns may be in all splits",
    };
    let way = match rules.overlap_direction {
        OverlapDirection::Same => " in the same direction",
        OverlapDirection::Either => ", there or back",
    };
    let _ = writeln!(
        text,
        "rules: walks repeat at most {:.0} % of each other{way}; {places}",
        100.0 * rules.max_route_overlap
    );
    text
}
