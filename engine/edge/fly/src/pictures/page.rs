//! The page of a result: numbers, episodes, the worst ones as clips; HTML that opens offline beside its clips.

use crate::flight::Row;
use crate::log::LogLine;
use crate::results::{Card, METRICS, Metric, MetricSummary, cell, ending, strata, summary};
use cosfly_diagnose::counted;
use cosfly_plot::strip::{CLASSES, strip};
use cosfly_plot::text::escaped;
use cosfly_report::{Section, document};
use std::fmt::Write;

/// An episode that the page shows.
pub struct Case<'a> {
    /// Its row.
    pub row: &'a Row,
    /// Its steps.
    pub steps: Vec<LogLine>,
    /// Whether there is a clip of it.
    pub has_clip: bool,
}

/// The page of a result with its worst episodes; `has_logs` tells whether each episode has a log that plays.
pub fn page(card: &Card, rows: &[Row], worst: &[Case<'_>], has_logs: bool) -> String {
    let section = |id, [short_title, title]: [&'static str; 2], body| Section { id, short_title, title, body };
    let sections = [
        section("scores", ["Scores"; 2], scores(rows)),
        section("worst", ["Worst episodes", "Episodes with the lowest tracking rate"], cases(worst)),
        section("episodes", ["Episodes", "All episodes"], episodes(rows, has_logs)),
        section("settings", ["Settings"; 2], settings(card)),
    ];
    let title = format!("{} on {}", card.policy.name, card.suite.name);
    document(&title, &heading(card, rows, &title), &sections, &foot(card))
}

fn heading(card: &Card, rows: &[Row], title: &str) -> String {
    let rate = summary(&rows.iter().collect::<Vec<_>>())[0].mean.unwrap_or(0.0);
    let measured = if card.is_measured() {
        "<p class=\"note\">Latencies are measured: another run gives other numbers.</p>"
    } else {
        ""
    };
    let version = card.policy.version.as_ref().map_or(String::new(), |version| format!(", version {version}"));
    format!(
        "<header><div class=\"words\"><p class=\"eyebrow\">Closed-loop evaluation</p><h1>{}</h1>\
         <p class=\"headline\"><b>{:.1} %</b> of all steps track the target.</p>\
         <p class=\"facts\">policy {}{} ({})<span aria-hidden=\"true\"> · </span>{}\
         <span aria-hidden=\"true\"> · </span>suite {}</p>{measured}</div></header>\n",
        escaped(title),
        100.0 * rate,
        escaped(&card.policy.name),
        escaped(&version),
        escaped(&card.policy.kind),
        counted(rows.len(), "episode"),
        escaped(&card.suite.hash)
    )
}

fn scores(rows: &[Row]) -> String {
    let groups = strata(rows);
    let several = groups.len() > 1;
    let groups: Vec<(&str, Vec<MetricSummary>)> =
        groups.into_iter().filter(|_| several).map(|(name, rows)| (name, summary(&rows))).collect();
    let all = summary(&rows.iter().collect::<Vec<_>>());
    let mut html = String::from(
        "<div class=\"card\"><div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Scores\"><table><thead><tr><th scope=\"col\">metric</th><th scope=\"col\">all</th>",
    );
    groups.iter().for_each(|(name, _)| _ = write!(html, "<th scope=\"col\">{}</th>", escaped(name)));
    html.push_str("</tr></thead><tbody>");
    for (at, metric) in METRICS.iter().enumerate().filter(|(at, _)| all[*at].count > 0) {
        let _ = write!(html, "<tr>{}<td>{}</td>", named(metric), cell(metric, &all[at]));
        groups.iter().for_each(|(_, group)| _ = write!(html, "<td>{}</td>", cell(metric, &group[at])));
        html.push_str("</tr>");
    }
    html.push_str(
        "</tbody></table></div><p class=\"note\">Means with 95 % intervals over resampled episodes.</p></div>",
    );
    html
}

fn named(metric: &Metric) -> String {
    format!("<th scope=\"row\" title=\"{}\">{}</th>", escaped(metric.doc), escaped(metric.title))
}

fn cases(worst: &[Case<'_>]) -> String {
    if worst.is_empty() {
        return String::new();
    }
    let classes = CLASSES.iter().enumerate();
    let legend: String = classes.map(|(at, name)| format!("<span><i class=\"b{at}\"></i>{name}</span>")).collect();
    let mut html = format!("<p class=\"legend\">visible: {legend}</p><div class=\"grid cases\">");
    for Case { row, steps, has_clip } in worst {
        let name = escaped(&row.episode);
        let _ = write!(
            html,
            "<article class=\"card\"><h3>{name}</h3><p><b>{:.1} % tracked</b>, {}</p>",
            100.0 * row.score.tracking_rate(),
            escaped(&ending(row))
        );
        if let Some(reason) = &row.policy_failure {
            let _ = write!(html, "<p class=\"bad\">{}</p>", escaped(reason));
        }
        if *has_clip {
            let _ = write!(
                html,
                "<div class=\"shot\"><img src=\"clips/{name}.gif\" loading=\"lazy\" alt=\"What the camera saw in {name}: \
                 colours, depth, labels\"></div>"
            );
        }
        let visible: Vec<f32> =
            steps.iter().map(|step| if step.in_picture { step.visible as f32 } else { 0.0 }).collect();
        let longest = row.score.planned_steps.max(1) as usize;
        html.push_str(&strip(&visible, longest, &format!("{}: share of the target in the picture", row.episode)));
        html.push_str("</article>");
    }
    html.push_str("</div>");
    html
}

fn episodes(rows: &[Row], has_logs: bool) -> String {
    let mut html = String::from(
        "<div class=\"card\"><div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Episodes\"><table><thead><tr><th scope=\"col\">episode</th><th scope=\"col\">\
         tracking rate</th><th scope=\"col\">losses</th><th scope=\"col\">visibility</th><th scope=\"col\">reward</th>\
         <th scope=\"col\">end</th><th scope=\"col\">log</th></tr></thead><tbody>",
    );
    for row in rows {
        let (name, score) = (escaped(&row.episode), &row.score);
        let played = if has_logs { format!(" <a href=\"logs/{name}.mcap\">mcap</a>") } else { String::new() };
        let _ = write!(
            html,
            "<tr><th scope=\"row\">{name}</th><td>{:.3}</td><td>{}</td><td>{:.3}</td><td>{:.1}</td><td>{}</td>\
             <td><a href=\"logs/{name}.jsonl\">steps</a>{played}</td></tr>",
            score.tracking_rate(),
            score.losses,
            score.mean_visibility(),
            score.reward_sum,
            escaped(&ending(row))
        );
    }
    html.push_str("</tbody></table></div></div>");
    html
}

fn settings(card: &Card) -> String {
    let text = serde_json::to_string_pretty(card).unwrap_or_default();
    format!("<div class=\"card\"><pre class=\"scroll\" tabindex=\"0\"><code>{}</code></pre></div>", escaped(&text))
}

fn foot(card: &Card) -> String {
    format!(
        "<footer><p>Written by <code>cosfly fly</code> {}. Logs (<code>.mcap</code>) play in Foxglove. Compare with another \
         policy: <code>cosfly fly compare</code>.</p></footer>\n",
        escaped(&card.cosfly)
    )
}
