//! `cosfly doctor`: examines anyone's data.

use super::Outcome;
use crate::arguments::DoctorArguments;
use crate::exit;
use crate::text::count;
use cosfly_diagnose::Diagnostic;
use cosfly_doctor::{Examination, Layout, Severity, examine};
use indicatif::{ProgressBar, ProgressStyle};
use std::fmt::Write;

/// Flags that are printed; all of them are in the JSON file.
const PRINTED: usize = 200;

/// Prints one line per flag and a verdict.
pub fn doctor(arguments: &DoctorArguments) -> Outcome {
    // Draws nothing unless standard error is a terminal.
    let style = ProgressStyle::with_template("doctor {wide_bar:.cyan/blue} {pos}/{len} episodes {eta:>5} left")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    let bar = ProgressBar::new(0).with_style(style);
    let examination = examine(&arguments.dir, &arguments.quotas, &mut |done, all| {
        bar.set_length(all);
        bar.set_position(done);
    });
    bar.finish_and_clear();
    let examination = examination.map_err(|refusal| vec![refusal])?;
    if let Some(path) = &arguments.json {
        let json = serde_json::to_string_pretty(&examination).unwrap_or_default();
        std::fs::write(path, json + "\n")
            .map_err(|error| vec![Diagnostic::io(format!("write `{}`", path.display()), &error)])?;
    }
    let allowed = arguments.imperfect / 100.0;
    crate::print(&text(&examination, allowed))?;
    let quotas_are_met = examination.quotas.iter().all(|(quota, found)| *found >= quota.wanted);
    let is_well = !examination.has_damage() && examination.imperfect_share() <= allowed && quotas_are_met;
    Ok(if is_well { exit::SUCCESS } else { exit::FOUND_PROBLEMS })
}

fn text(examination: &Examination, allowed: f64) -> String {
    let mut text = String::new();
    for (severity, heading) in [(Severity::Damage, "damage"), (Severity::Imperfect, "imperfect")] {
        let flags: Vec<_> = examination.flags.iter().filter(|flag| flag.severity == severity).collect();
        for flag in flags.iter().take(PRINTED) {
            let _ = writeln!(text, "{heading}: {flag}");
        }
        if flags.len() > PRINTED {
            let _ = writeln!(text, "... and {} more", flags.len() - PRINTED);
        }
    }
    let layout = match examination.layout {
        Layout::Cosfly => "a dataset of cosfly",
        Layout::V7 => "the published v7 layout",
        Layout::Lerobot => "a LeRobot dataset",
    };
    let (episodes, frames) = (examination.episodes as u64, examination.frames as u64);
    let _ = writeln!(text, "examined {layout}: {} with {}", count(episodes, "episode"), count(frames, "frame"));
    let told: usize = examination.visibility.iter().map(|it| it.1).sum();
    if told > 0 {
        let classes = ["under 50 %", "50 to 80 %", "80 to 95 %", "95 % and more"];
        let shares = classes.iter().zip(&examination.visibility);
        let shares = shares.map(|(name, (_, frames))| format!("{name}: {:.1} %", 100.0 * *frames as f64 / told as f64));
        let _ = writeln!(text, "frames by visible share of the target: {}", shares.collect::<Vec<_>>().join(", "));
    }
    for gap in &examination.unchecked {
        let _ = writeln!(text, "not checked: {gap}");
    }
    for (quota, found) in &examination.quotas {
        let verdict = if *found >= quota.wanted { "met" } else { "not met" };
        let (from, to) = quota.lost_s;
        let _ = writeln!(
            text,
            "quota {verdict}: {:.1} % of the episodes lose their target for {from} to {to} s; {:.1} % are wanted",
            100.0 * found,
            100.0 * quota.wanted
        );
    }
    let share = examination.imperfect_share();
    let verdict = if share <= allowed { "no more than" } else { "more than" };
    let _ = writeln!(
        text,
        "{} without a flag, {} imperfect ({:.1} %, {verdict} the {:.1} % that do no harm), {} damaged",
        examination.kept.len(),
        examination.imperfect,
        100.0 * share,
        100.0 * allowed,
        examination.damaged
    );
    text
}
