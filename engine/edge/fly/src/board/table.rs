//! The board for programs and for terminals.

use super::entry::Proof;
use super::standing::{Board, Contest, Standing};
use crate::results::{METRICS, of_summaries};
use cosfly_plot::text::one_line;
use serde_json::{Map, Value, json};
use std::fmt::Write as _;

/// The board, for programs.
pub fn json(board: &Board) -> String {
    let list = |standings: &[Standing]| standings.iter().map(of_standing).collect::<Vec<Value>>();
    let contest = |it: &Contest| {
        json!({
            "suite": it.suite.name, "hash": it.suite.hash, "episodes": it.suite.episodes, "settings": it.ground,
            "ranked": list(&it.ranked), "knows_world": list(&it.world), "claimed": list(&it.claimed),
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
    let differ = match &it.entry.proof {
        Proof::Reflown => &[][..],
        Proof::Claimed(differ) => &differ[..],
    };
    json!({
        "rank": it.rank, "file": it.entry.file, "policy": policy.name, "version": policy.version, "kind": policy.kind,
        "proof": it.entry.proof.word(), "differs": differ, "sees": it.entry.sees.words,
        "latency": it.entry.card.latency(), "scores": of_summaries(&it.scores), "behind_first": behind,
        "tracking_rate_by_group": groups, "licence": notes.licence, "link": notes.link, "about": notes.about,
    })
}

/// The board, for terminals.
pub fn told(board: &Board) -> String {
    let mut text = String::new();
    for contest in &board.contests {
        let _ = writeln!(text, "{}, {} episodes", one_line(&contest.suite.name), contest.suite.episodes);
        let all = contest.ranked.iter().chain(&contest.world).chain(&contest.claimed);
        for it in all {
            let rank = it.rank.map_or_else(|| "-".to_owned(), |rank| rank.to_string());
            let name = one_line(&it.entry.card.policy.name);
            let (rate, decimals) = (it.rate(), METRICS[0].decimals);
            let (word, sees) = (it.entry.proof.word(), one_line(&it.entry.sees.words));
            let _ = writeln!(text, "{rank:>4}  {rate:.decimals$}  {word:<8}  {name} (sees {sees})");
            if let Proof::Claimed(differ) = &it.entry.proof {
                let first = differ.first().map(|it| one_line(it)).unwrap_or_default();
                let _ = writeln!(text, "      {} of {} episodes differ: {first}", differ.len(), it.entry.rows.len());
            }
        }
    }
    for it in &board.refused {
        let _ = writeln!(text, "refused: {}: {}", one_line(&it.file), one_line(&it.reason));
    }
    text
}
