//! Goals as conversations: write the goal of pictures, judge whether pictures do what a goal says, understand a correction.

use super::conversation::{as_words, language_name, task};
use crate::source::ExportedFlight;
use cosfly_read::PublishedGoal;
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Most pictures of a stretch.
const PICTURES: usize = 4;

/// Lines of a flight's goals, each with the name of its file after the split. `pictures` has the paths of the flight's pictures by frame;
/// a goal whose stretch has none is left out.
pub fn lines(
    episode: &ExportedFlight<'_>,
    goals: &[PublishedGoal],
    language: &str,
    pictures: &BTreeMap<usize, String>,
) -> Vec<(&'static str, Value)> {
    let mut found = vec![];
    let task = task(episode);
    let system =
        format!("You are the pilot of a drone that {task}. The pictures are from its camera, in order of time.");
    for (number, goal) in goals.iter().enumerate() {
        let Some((&first, &last)) = goal.frames.first().zip(goal.frames.last()) else { continue };
        let shown = shown(pictures, first, last);
        if shown.is_empty() {
            continue;
        }
        let line = |name: &str, asked: String, answer: String| {
            let user = format!("{}\n{asked}", "<image>".repeat(shown.len()));
            json!({
                "id": format!("{}_{name}_{number:03}", episode.flight.trajectory_id),
                "trajectory_id": episode.flight.trajectory_id,
                "frame": first,
                "messages": [
                    {"role": "system", "content": system},
                    {"role": "user", "content": user},
                    {"role": "assistant", "content": answer},
                ],
                "images": shown,
            })
        };
        let text = said(&goal.lines);
        if let ("flight" | "step", true) = (goal.grain.as_str(), goal.fits) {
            let language = language_name(language);
            let asked = format!("Which instruction does this {} carry out? Write it in {language}.", goal.grain);
            found.push(("goals", line("goal", asked, text.clone())));
        }
        if goal.grain == "dialogue" {
            let asked = format!("{text}\nWhat does the user say in the end? Answer with one JSON object.");
            found.push(("dialogues", line("dialogue", asked, json!({"claims": bare(&goal.claims)}).to_string())));
        } else {
            let asked = format!("Goal: {text}\nDo the pictures show what the goal says? Answer with one JSON object.");
            let answer = json!({"fits": goal.fits, "false_subject": goal.false_subject}).to_string();
            found.push(("goal_checks", line("check", asked, answer)));
        }
    }
    found
}

/// Paths of pictures spread over the frames of a stretch.
fn shown(pictures: &BTreeMap<usize, String>, first: usize, end: usize) -> Vec<&String> {
    let inside: Vec<&String> = pictures.range(first..end.max(first)).map(|(_, path)| path).collect();
    let Some(last) = inside.len().checked_sub(1) else { return vec![] };
    let mut places: Vec<usize> = (0..PICTURES).map(|at| at * last / (PICTURES - 1)).collect();
    places.dedup();
    places.into_iter().map(|place| inside[place]).collect()
}

/// The lines of a goal: one as it is, several with their speakers.
fn said(lines: &[String]) -> String {
    match lines {
        [one] => as_words(one),
        several => {
            let speaker = |at: usize| if at.is_multiple_of(2) { "User" } else { "Pilot" };
            let lines = several.iter().enumerate().map(|(at, line)| format!("{}: {}", speaker(at), as_words(line)));
            lines.collect::<Vec<_>>().join("\n")
        }
    }
}

/// Claims without their frames, which no picture shows.
fn bare(claims: &[String]) -> Vec<&str> {
    claims.iter().map(|claim| claim.split(" @ ").next().unwrap_or(claim)).collect()
}
