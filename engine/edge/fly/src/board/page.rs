//! The page of a board: one file in HTML that opens offline, without a script.

use super::standing::{Board, Contest, Refused, Standing};
use super::table::{alike, differing, flown_by};
use crate::results::{METRICS, Metric, MetricSummary, cell, ending, worst};
use cosfly_diagnose::counted;
use cosfly_plot::text::escaped;
use cosfly_report::{Section, document};
use std::fmt::Write as _;

/// Metrics that the tables have as columns, beside the tracking rate.
const COLUMNS: [&str; 5] = ["success", "collision", "lost", "policy_failure", "losses"];
/// Episodes that are named for each entry.
const WORST: usize = 5;
/// Episodes that come out differently, named for each entry.
const DIFFER: usize = 3;
/// Words below the drawing of an episode.
const CLIP: &str = "The first of them from above, four times as fast: the target in blue, the drone in red, dashed where it does not track.";
/// Most letters of a name.
const MOST_LETTERS: usize = 60;

/// The page.
pub fn page(board: &Board, cosfly: &str) -> String {
    let ids: Vec<String> = (1..=board.contests.len()).map(|number| format!("suite-{number}")).collect();
    let names: Vec<String> = board.contests.iter().map(|contest| escaped(&short(&contest.suite.name))).collect();
    let mut sections: Vec<Section<'_>> = (board.contests.iter().zip(&ids).zip(&names))
        .map(|((contest, id), name)| Section { id, short_title: name, title: name, body: of_contest(contest) })
        .collect();
    let refused = refused(&board.refused);
    sections.push(Section { id: "refused", short_title: "Refused", title: "Refused", body: refused });
    sections.push(Section { id: "words", short_title: "Words", title: "What the words say", body: words() });
    let foot = format!("<footer><p>Written by <code>cosfly leaderboard</code> {}.</p></footer>\n", escaped(cosfly));
    document("Leaderboard", &heading(board), &sections, &foot)
}

fn heading(board: &Board) -> String {
    let count = |of: fn(&Contest) -> usize| board.contests.iter().map(of).sum::<usize>();
    let reflown = count(|it| it.all().count() - it.claimed.len());
    let rerun = count(|it| it.all().filter(|it| it.entry.proof.word() == "re-run").count());
    format!(
        "<header><div class=\"words\"><p class=\"eyebrow\">Closed-loop evaluation</p><h1>Leaderboard</h1>\
         <p class=\"headline\"><b>{reflown}</b> {} flown again here and came to the same rows, byte for byte.</p>\
         <p class=\"facts\">{rerun} of them by their policies, run again<span aria-hidden=\"true\"> · </span>{} claimed<span aria-hidden=\"true\"> · </span>{} refused</p></div></header>\n",
        if reflown == 1 { "entry was" } else { "entries were" },
        board.claims(),
        board.refused.len()
    )
}

fn of_contest(contest: &Contest) -> String {
    let mut html = format!(
        "<p class=\"facts\">{}, suite <code>{}</code></p>",
        counted(contest.suite.episodes, "episode"),
        escaped(&contest.suite.hash)
    );
    for class in &contest.rerun {
        let title = format!("Re-run, sees {}", escaped(&short(&class.sees)));
        html += &table(&title, &class.ranked, &behind(&class.ranked));
    }
    html += &table("Re-flown", &contest.ranked, &behind(&contest.ranked));
    let note = "Not ranked: these know the whole walk and the expert&#39;s flight, or fly the expert&#39;s flight.";
    html += &table("With knowledge of the world", &contest.world, note);
    let note = "Not ranked: the actions came to other rows here. The scores are those that the file claims.";
    html += &table("Claimed", &contest.claimed, note);
    html += &groups(contest);
    for standing in contest.all() {
        html += &failures(standing);
    }
    let ground = serde_json::to_string_pretty(&contest.ground).unwrap_or_default();
    let _ = write!(
        html,
        "<details><summary>Settings</summary><pre class=\"scroll\" tabindex=\"0\"><code>{}</code></pre></details>",
        escaped(&ground)
    );
    html
}

/// Text of the column `behind`.
fn behind(ranked: &[Standing]) -> String {
    match ranked {
        [first, _, ..] => format!(
            "<i>behind</i>: tracking rate minus that of {}, over the same episodes; the interval of pairs leaves out 0 \
             where there is a *.",
            escaped(&short(&first.entry.card.policy.name))
        ),
        _ => String::new(),
    }
}

fn columns() -> impl Iterator<Item = (usize, &'static Metric)> {
    METRICS.iter().enumerate().filter(|(_, metric)| COLUMNS.contains(&metric.name))
}

fn table(title: &str, standings: &[Standing], note: &str) -> String {
    if standings.is_empty() {
        return String::new();
    }
    let mut html = format!(
        "<div class=\"card wide\"><h3>{title}</h3><div class=\"scroll\" role=\"group\" aria-label=\"{title}\" tabindex=\"0\"><table><thead><tr>"
    );
    let head = |html: &mut String, name: &str, doc: &str| {
        let _ = write!(html, "<th scope=\"col\" title=\"{}\">{}</th>", escaped(doc), escaped(name));
    };
    head(&mut html, "policy", "name of the policy, and its rank");
    head(&mut html, METRICS[0].title, METRICS[0].doc);
    head(&mut html, "behind", "tracking rate minus that of the first");
    head(&mut html, "proof", "what the file proves");
    head(&mut html, "sees", "what the policy sees, as its maker says");
    columns().for_each(|(_, metric)| head(&mut html, metric.title, metric.doc));
    head(&mut html, "latency", "time from an observation to the effect of the action that answers it");
    head(&mut html, "flown, s", "mean length of the flights, seconds");
    head(&mut html, "s an episode", "time by the clock for an episode, seconds, as its maker measured it");
    head(&mut html, "core-s an episode", "time of processors for an episode, core-seconds, as its maker measured it");
    head(&mut html, "licence", "licence of the policy, as its maker says");
    html.push_str("</tr></thead><tbody>");
    standings.iter().for_each(|standing| html += &line(standing));
    let _ = write!(html, "</tbody></table></div><p class=\"note\">Means with 95 % intervals. {note}</p></div>");
    html
}

fn line(standing: &Standing) -> String {
    let entry = &standing.entry;
    let rank = standing.rank.map_or(String::new(), |rank| format!("{rank}. "));
    let mut html = format!("<tr><th scope=\"row\">{rank}{}", name(standing));
    if let Some(about) = &entry.notes.about {
        let _ = write!(html, "<br><small>{}</small>", escaped(about));
    }
    if let Some(words) = alike(standing) {
        let _ = write!(html, "<br><small>{}</small>", escaped(&words));
    }
    html.push_str("</th>");
    let behind = standing.behind.as_ref().map_or("-".to_owned(), |it| {
        let interval = it.interval.map_or(String::new(), |(low, high)| format!(" [{low:+.3}, {high:+.3}]"));
        format!("{:+.3}{interval}{}", it.difference(), if it.is_clear() { " *" } else { "" })
    });
    let steps_s = entry.rows.iter().map(|row| f64::from(row.score.steps) * row.step_s);
    let flown_s = steps_s.sum::<f64>() / entry.rows.len().max(1) as f64;
    let _ = write!(
        html,
        "<td>{}</td><td>{behind}</td><td>{}</td><td>{}</td>",
        cell(&METRICS[0], &standing.scores[0]),
        entry.proof.word(),
        escaped(&entry.sees.words)
    );
    let plain = |at: usize| MetricSummary { interval: None, ..standing.scores[at] };
    columns().for_each(|(at, metric)| _ = write!(html, "<td>{}</td>", cell(metric, &plain(at))));
    let _ = write!(
        html,
        "<td>{}</td><td>{flown_s:.1}</td><td>{}</td><td>{}</td><td>{}</td></tr>",
        escaped(&entry.card.latency()),
        measured(entry.notes.seconds),
        measured(entry.notes.core_seconds),
        escaped(entry.notes.licence.as_deref().unwrap_or("-"))
    );
    html
}

/// A time of the notes, seconds.
fn measured(seconds: Option<f64>) -> String {
    seconds.map_or(
        "-".to_owned(),
        |seconds| if seconds < 10.0 { format!("{seconds:.3}") } else { format!("{seconds:.0}") },
    )
}

/// Name of the policy, with its version, the baseline that it is where that has another name, and its link where it has one.
fn name(standing: &Standing) -> String {
    let policy = &standing.entry.card.policy;
    let name = escaped(&short(&policy.name));
    let version = policy.version.as_ref().map_or(String::new(), |version| format!(" {}", escaped(&short(version))));
    let baseline = policy.baseline.as_ref().filter(|baseline| **baseline != policy.name);
    let baseline = baseline.map_or(String::new(), |baseline| format!(" (baseline {})", escaped(&short(baseline))));
    match &standing.entry.notes.link {
        Some(link) => format!("<a href=\"{}\" rel=\"nofollow noopener\">{name}</a>{version}{baseline}", escaped(link)),
        None => format!("{name}{version}{baseline}"),
    }
}

/// Mean tracking rate of all entries by group of episodes.
fn groups(contest: &Contest) -> String {
    let all: Vec<&Standing> = contest.all().take(contest.all().count() - contest.claimed.len()).collect();
    let Some(first) = all.first().filter(|first| !first.groups.is_empty()) else { return String::new() };
    let mut html = String::from(
        "<div class=\"card wide\"><h3>Tracking rate by group of episodes</h3>\
         <div class=\"scroll\" role=\"group\" aria-label=\"Tracking rate by group of episodes\" tabindex=\"0\"><table><thead><tr>\
         <th scope=\"col\">policy</th>",
    );
    first.groups.iter().for_each(|(name, _)| _ = write!(html, "<th scope=\"col\">{}</th>", escaped(name)));
    html.push_str("</tr></thead><tbody>");
    for standing in all {
        let _ = write!(html, "<tr><th scope=\"row\">{}</th>", escaped(&short(&standing.entry.card.policy.name)));
        standing.groups.iter().for_each(|(_, rate)| _ = write!(html, "<td>{rate:.3}</td>"));
        html.push_str("</tr>");
    }
    html.push_str(
        "</tbody></table></div><p class=\"note\">Groups are the stages of the suite, and thirds of its episodes by how well the \
         expert&#39;s flight sees the target.</p></div>",
    );
    html
}

/// The worst episodes of an entry, and those that came out differently.
fn failures(standing: &Standing) -> String {
    let entry = &standing.entry;
    let mut html = format!(
        "<details><summary>{} ({}): episodes with the lowest tracking rate</summary><ul>",
        escaped(&short(&entry.card.policy.name)),
        escaped(&short(&entry.file))
    );
    for row in worst(&entry.rows, WORST) {
        let (episode, rate) = (escaped(&short(&row.episode)), row.score.tracking_rate());
        let _ = write!(html, "<li>{episode}: {rate:.3}, {}</li>", escaped(&ending(row)));
    }
    let _ = write!(html, "</ul><p class=\"note\">{}</p>", escaped(&short(&flown_by(standing))));
    if !entry.clip.is_empty() {
        let _ = write!(html, "<figure>{}<figcaption>{CLIP}</figcaption></figure>", entry.clip);
    }
    let differ = entry.proof.differs();
    if !differ.is_empty() {
        let _ = write!(html, "<p class=\"bad\">{}:</p><ul>", differing(standing));
        differ.iter().take(DIFFER).for_each(|it| _ = write!(html, "<li>{}</li>", escaped(it)));
        html.push_str("</ul>");
    }
    html.push_str("</details>");
    html
}

fn refused(refused: &[Refused]) -> String {
    if refused.is_empty() {
        return String::new();
    }
    let mut html = String::from("<div class=\"card\"><ul>");
    for it in refused {
        let _ = write!(html, "<li><b>{}</b>: {}</li>", escaped(&short(&it.file)), escaped(&it.reason));
    }
    html.push_str("</ul></div>");
    html
}

fn words() -> String {
    "<div class=\"card\"><p><b>Re-run</b>: the policy was run again here on what it sees, and gave the same actions, which came to the \
     same rows. Only these are ranked by what they see.</p>\
     <p><b>Re-flown</b>: the recorded actions were flown again here and came to the same rows, byte for byte. So \
     these actions give these scores. It does not prove who gave the actions, or what they saw: a rank is one of actions.</p>\
     <p><b>Claimed</b>: the actions came to other rows here, so that the scores are a claim.</p>\
     <p><b>Sees</b>: what the maker of the entry says, or else all that the policy was sent. An entry that flies the expert&#39;s \
     flight counts as one that knows the world, whatever it says.</p></div>"
        .to_owned()
}

/// A text, cut where it is long.
fn short(text: &str) -> String {
    match text.chars().count() > MOST_LETTERS {
        true => text.chars().take(MOST_LETTERS).chain(['…']).collect(),
        false => text.to_owned(),
    }
}
