//! The board for programs and for terminals.

use super::entry::Proof;
use super::standing::{Board, Class, Contest, Standing};
use crate::results::{METRICS, of_summaries};
use cosfly_diagnose::counted;
use cosfly_plot::text::one_line;
use serde_json::{Map, Value, json};
use std::fmt::Write as _;

/// The board, for programs.
pub fn json(board: &Board) -> String {
    let list = |standings: &[Standing]| standings.iter().map(of_standing).collect::<Vec<Value>>();
    let class = |it: &Class| json!({ "sees": it.sees, "ranked": list(&it.ranked) });
    let contest = |it: &Contest| {
        json!({
            "suite": it.suite.name, "hash": it.suite.hash, "episodes": it.suite.episodes, "settings": it.ground,
            "rerun": it.rerun.iter().map(class).collect::<Vec<Value>>(), "ranked": list(&it.ranked), "knows_world": list(&it.world), "claimed": list(&it.claimed),
        })
    };
    let suites: Vec<Value> = board.contests.iter().map(contest).collect();
    let refused = board.refused.iter().map(|it| json!({ "file": it.file, "reason": it.reason }));
    let refused: Vec<Value> = refused.collect();
    format!("{:#}\n", json!({ "suites": suites, "refused": refused }))
}

fn of_standing(it: &Standing) -> Value {
    let policy = &it.entry.card.policy;
    let behind = it.behind.as_ref().map(|behind| {
        let interval = behind.interval.map(|(low, high)| [low, high]);
        json!({ "difference": behind.difference(), "interval_95": interval, "episodes": behind.episodes })
    });
    let groups: Map<String, Value> = it.groups.iter().map(|(name, rate)| (name.clone(), json!(rate))).collect();
    let notes = &it.entry.notes;
    json!({
        "rank": it.rank, "flies_as": it.alike.as_ref().map(|(file, episodes)| json!({ "file": file, "episodes": episodes })), "file": it.entry.file, "policy": policy.name, "version": policy.version, "kind": policy.kind, "cosfly": it.entry.card.cosfly,
        "proof": it.entry.proof.word(), "differs": it.entry.proof.differs(), "sees": it.entry.sees.words,
        "latency": it.entry.card.latency(), "scores": of_summaries(&it.scores), "behind_first": behind,
        "tracking_rate_by_group": groups, "licence": notes.licence, "link": notes.link, "about": notes.about,
        "seconds_an_episode": notes.seconds, "core_seconds_an_episode": notes.core_seconds,
    })
}

/// Difference in words: a number of episodes, or the policy that could not be run.
pub fn differing(it: &Standing) -> String {
    let (count, all) = (it.entry.proof.differs().len(), it.entry.rows.len());
    match it.entry.proof {
        Proof::Claimed(_) => {
            format!("{count} of {all} {}", if all == 1 { "episode differs" } else { "episodes differ" })
        }
        Proof::NotRun(_) => "its policy could not be run".to_owned(),
        _ => format!("its policy was run and differs in {count} of {}", counted(all, "episode")),
    }
}

/// The entry that it flies alike with, in words.
pub fn alike(it: &Standing) -> Option<String> {
    let (file, episodes) = it.alike.as_ref()?;
    let all = counted(it.entry.rows.len(), "episode");
    Some(format!("flies {episodes} of {all} exactly as the entry `{}`", one_line(file)))
}

/// The version of cosfly that the episodes were flown by, in words.
pub fn flown_by(it: &Standing) -> String {
    format!("flown by cosfly {}", it.entry.card.cosfly)
}

/// The board, for terminals.
pub fn told(board: &Board) -> String {
    let mut text = String::new();
    if board.contests.is_empty() && board.refused.is_empty() {
        text.push_str("no entry is here: files of `cosfly fly bundle` end in `.jsonl.zst`\n");
    }
    for contest in &board.contests {
        let _ = writeln!(text, "{}, {}", one_line(&contest.suite.name), counted(contest.suite.episodes, "episode"));
        for it in contest.all() {
            let rank = it.rank.map_or_else(|| "-".to_owned(), |rank| rank.to_string());
            let name = one_line(&it.entry.card.policy.name);
            let (rate, decimals) = (it.rate(), METRICS[0].decimals);
            let (word, sees) = (it.entry.proof.word(), one_line(&it.entry.sees.words));
            let _ = writeln!(text, "{rank:>4}  {rate:.decimals$}  {word:<8}  {name} (sees {sees})");
            if let Some(words) = alike(it) {
                let _ = writeln!(text, "      {words}");
            }
            if let Some(first) = it.entry.proof.differs().first() {
                let _ = writeln!(text, "      {}: {} ({})", differing(it), one_line(first), one_line(&flown_by(it)));
            }
        }
    }
    for it in &board.refused {
        let _ = writeln!(text, "refused: {}: {}", one_line(&it.file), one_line(&it.reason));
    }
    text
}
