//! Two versions of labels side by side.

use super::folder::{LabelCard, RoundCard};
use cosfly_diagnose::counted;
use std::fmt::Write as _;

/// Rounds and labels that a version has and another has not, in words.
pub fn told(old: Option<&LabelCard>, new: &LabelCard) -> String {
    let mut text = String::new();
    let before = old.map_or(&[][..], |old| &old.rounds);
    if let Some(old) = old.filter(|old| old.suite != new.suite || old.environment != new.environment) {
        let _ = writeln!(text, "suite or environment differ: {} and {}", old.suite.hash, new.suite.hash);
    }
    for round in &new.rounds {
        let known = before.iter().find(|it| it.name == round.name);
        let what = match known {
            Some(known) if known == round => "kept",
            Some(_) => "changed",
            None => "added",
        };
        let _ = writeln!(text, "{what}: {}", of_round(round));
    }
    for round in before.iter().filter(|round| new.rounds.iter().all(|it| it.name != round.name)) {
        let _ = writeln!(text, "dropped: {}", of_round(round));
    }
    text
}

fn of_round(round: &RoundCard) -> String {
    let policy = &round.policy;
    let version = policy.version.as_ref().map_or(String::new(), |version| format!(" {version}"));
    let made = round.made.as_ref().map_or("not yet whole".to_owned(), |made| {
        let states = counted(made.states, "state");
        format!("{} in {states} of {}", counted(made.labels, "label"), counted(made.episodes, "episode"))
    });
    let share = 100.0 * round.by_expert;
    format!("round `{}`: {made}; policy {}{version}, the expert flew {share:.0} %", round.name, policy.name)
}
