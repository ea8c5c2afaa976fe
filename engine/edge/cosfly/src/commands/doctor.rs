//! `cosfly doctor`: examines anyone's data and prints its findings.

use crate::command::{Command, Outcome};
use crate::commands::scanned_mesh::MeshArguments;
use crate::console::Console;
use crate::exit;
use crate::text::count;
use clap::Parser;
use cosfly_diagnose::{Diagnostic, Result, plausible};
use cosfly_doctor::{Examination, GivenTexts, HeldAgainst, Layout, TextFigures, examine_given};
use cosfly_episodes::Severity;
use cosfly_export::on_threads;
use cosfly_metrics::shortcuts::{Probe, ShortcutFigures};
use std::fmt::Write;
use std::path::PathBuf;

/// Flags that are printed; all of them are in the JSON.
const PRINTED: usize = 200;

/// Examine anyone's data: splits that leak, signs, units, shifts, frozen frames, times, instructions, limits
#[derive(Debug, Parser)]
#[command(
    name = "doctor",
    after_help = "\
Examples:
  cosfly doctor out/carla_town                       a dataset of cosfly
  cosfly doctor CosFly/data_v7                       the published release
  cosfly doctor my-lerobot-data                      a LeRobot dataset, exported or anyone's
  cosfly doctor out/carla_town --quota 0.2:2-4       do 20 % of the episodes lose their target for 2 to 4 s?
  cosfly doctor out/carla_town --out verdict.json    every flag, and which episodes are without one
  cosfly doctor out/carla_town --texts mine.jsonl    are my texts about these flights true, and how different are they?
  cosfly doctor out/street --mesh street.glb         do flights and people fit the scan?

A damage is a statement of the data that is false; an imperfection is true and worse than elsewhere. Exits with 1 when there
is a damage, more imperfect episodes than --imperfect-share allows, or a quota that is not met."
)]
pub struct Arguments {
    /// Folder of the data
    #[arg(value_name = "DATASET")]
    dir: PathBuf,
    /// Share of imperfect episodes that does no harm, 0 to 1
    #[arg(long, value_name = "SHARE", default_value_t = 0.05, value_parser = share)]
    imperfect_share: f64,
    /// Share of episodes, 0 to 1, that lose their target for a time between two lengths in seconds (repeatable)
    #[arg(long = "quota", value_name = "SHARE:FROM-TO", value_parser = quota)]
    quotas: Vec<cosfly_doctor::Quota>,
    /// Judge these texts in the place of the data's own: lines of JSON with trajectory_id, language and text
    #[arg(long, value_name = "FILE")]
    texts: Option<PathBuf>,
    #[command(flatten)]
    mesh: MeshArguments,
    /// File for all findings as JSON
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Print all findings as JSON, instead of the text
    #[arg(long)]
    json: bool,
    /// Number of threads [default: all cores]
    #[arg(short = 'j', long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
}

impl Command for Arguments {
    fn run(&self, console: &dyn Console) -> Outcome {
        let examination = on_threads(self.jobs, || self.examined(console))??;
        let json = || serde_json::to_string_pretty(&examination).unwrap_or_default();
        if let Some(path) = &self.out {
            cosfly_whole::write_file(path, (json() + "\n").as_bytes())
                .map_err(|error| Diagnostic::io(format!("write `{}`", path.display()), &error))?;
        }
        let allowed = self.imperfect_share;
        console.print(&if self.json { json() + "\n" } else { text(&examination, allowed) })?;
        let quotas_are_met = examination.quotas.iter().all(|(quota, found)| *found >= quota.wanted);
        let is_well = !examination.has_damage() && examination.imperfect_share() <= allowed && quotas_are_met;
        Ok(if is_well { exit::SUCCESS } else { exit::FOUND_PROBLEMS })
    }
}

impl Arguments {
    fn examined(&self, console: &dyn Console) -> Result<Examination> {
        let progress = console.progress("doctor", "episodes");
        let texts = self.texts.as_deref().map(GivenTexts::read).transpose()?;
        let given = HeldAgainst { texts, mesh: self.mesh.read(&self.dir)? };
        let (stop, mut told) = (console.stop(), |done, all| progress(done, all));
        examine_given(&self.dir, &self.quotas, &given, (&stop, &mut told))
    }
}

/// A share from 0 to 1.
fn share(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|number| (0.0..=1.0).contains(number));
    number.ok_or_else(|| "it must be a share from 0 to 1, such as 0.05 for 5 %".to_owned())
}

/// A quota such as `0.2:2-4`.
fn quota(text: &str) -> Result<cosfly_doctor::Quota, String> {
    let parts = text.split_once(':').and_then(|(share, times)| Some((share, times.split_once('-')?)));
    let number = |text: &str| text.parse::<f64>().ok().filter(|number| plausible(*number).is_ok() && *number >= 0.0);
    let numbers = parts.and_then(|(share, (from, to))| Some((number(share)?, number(from)?, number(to)?)));
    match numbers {
        Some((wanted, from, to)) if wanted <= 1.0 && from <= to => {
            Ok(cosfly_doctor::Quota { wanted, lost_s: (from, to) })
        }
        _ => Err("it must be a share from 0 to 1, a colon and two times in seconds, such as 0.2:2-4".to_owned()),
    }
}

/// Frames by visible share of the target: a line for each role, since twins are perturbed to lose sight of it.
fn visibility(examination: &Examination) -> String {
    let told = [0, 1].map(|role| examination.visibility.iter().map(|it| it.1[role]).sum::<usize>());
    let line = |role: usize| {
        let classes = ["under 50 %", "50 to 80 %", "80 to 95 %", "95 % and more"];
        let share = |frames: &[usize; 2]| 100.0 * frames[role] as f64 / told[role] as f64;
        let classes = classes.iter().zip(&examination.visibility);
        let shares: Vec<String> =
            classes.map(|(name, (_, frames))| format!("{name}: {:.1} %", share(frames))).collect();
        let whose = if told[1] == 0 { "" } else { [" of experts", " of perturbed flights"][role] };
        format!("frames{whose} by visible share of the target: {}\n", shares.join(", "))
    };
    [0, 1].into_iter().filter(|role| told[*role] > 0).map(line).collect()
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
    text.push_str(&visibility(examination));
    text.push_str(&examination.shortcuts.as_ref().map_or_else(String::new, shortcuts));
    examination.texts.iter().for_each(|figures| text.push_str(&language(figures)));
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

/// Figures of the texts of one language: how different, how true, what they speak of.
fn language(figures: &TextFigures) -> String {
    let mut text = String::new();
    let it = &figures.diversity;
    let share = |share: Option<f64>, what: &str| share.map(|share| format!("{:.0} % {what}", 100.0 * share));
    let shares =
        [share(figures.names_target_share, "name clothes"), share(figures.singles_out_share, "single the target out")];
    let shares: Vec<String> = shares.into_iter().flatten().collect();
    let shares = if shares.is_empty() { String::new() } else { format!("; {}", shares.join(", ")) };
    let _ = writeln!(
        text,
        "texts ({}): {} of {} different; {:.1} % true; distinct-1 {:.3}, distinct-2 {:.3}, self-BLEU {:.2}; {} to {} words, {:.1} on average{}",
        figures.language,
        it.different_texts,
        it.texts,
        100.0 * figures.true_share,
        it.distinct_1,
        it.distinct_2,
        it.self_bleu,
        it.words[0],
        it.words[1],
        it.mean_words,
        shares,
    );
    let verdict = |(subject, [told, wrong]): (&&str, &[usize; 2])| format!("{subject} {told} ({wrong} wrong)");
    let verdicts: Vec<String> = figures.subjects.iter().map(verdict).collect();
    let _ = writeln!(text, "  texts by subject, and those that contradict the facts: {}", verdicts.join(", "));
    for (title, counts) in [("relation", &figures.relations), ("intent", &figures.intents)] {
        let found = counts.values().filter(|count| **count > 0).count();
        let kinds: Vec<String> = counts.iter().map(|(kind, count)| format!("{kind} {count}")).collect();
        let _ = writeln!(text, "  texts by {title} ({found} of {} occur): {}", counts.len(), kinds.join(", "));
    }
    text
}

/// Signs that give targets away, a line each.
fn shortcuts(figures: &ShortcutFigures) -> String {
    let mut text = String::new();
    if let (Some(share), Some(nearer)) = (figures.target_nearest_the_centre, figures.mean_people_nearer) {
        let _ = writeln!(
            text,
            "of its kind, the target is nearest to the picture's centre in {:.1} % of {}; {nearer:.2} others are nearer on average",
            100.0 * share,
            count(figures.frames, "expert frame")
        );
    }
    for (sign, probe, others) in [
        ("nearness to the centre", figures.place, "others in the frame"),
        ("height in pixels", figures.height, "others in the frame"),
        ("height", figures.height_in_the_same_place, "whole people as far away and as far from the centre"),
    ] {
        let Some(Probe { auc, standard_error, flights, .. }) = probe else { continue };
        let error = standard_error.map_or_else(String::new, |error| format!(" +- {error:.3}"));
        let of = count(flights, "flight");
        let few = few(standard_error.unwrap_or(f64::INFINITY));
        let _ = writeln!(
            text,
            "{sign} tells the target from {others} with AUC {auc:.2}{error} ({of}{few}); 0.50 tells nothing"
        );
    }
    if let Some(looks) = figures.looks {
        let _ = writeln!(
            text,
            "looks tell {} from {} with AUC {:.2} by colourfulness, {:.2} by brightness, {:.2} by body height, {:.2} by bags, {:.2} by build, {:.2} by steps; 0.50 +- {:.2} is chance{}",
            count(figures.targets as u64, "target"),
            count(figures.others as u64, "bystander"),
            looks.colourfulness,
            looks.brightness,
            looks.height,
            looks.bag,
            looks.build,
            looks.steps,
            looks.standard_error,
            few(looks.standard_error)
        );
    }
    text
}

/// A warning where a figure is of too few targets.
fn few(standard_error: f64) -> &'static str {
    if ShortcutFigures::is_telling(standard_error) { "" } else { ", too few to tell" }
}
