//! Results of other planners for the same walks.

use crate::model::{KnownNumber, PlannerRow, Report};
use cosfly_diagnose::counted;
use cosfly_plot::text::{escaped, percent, short};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Number of terms with a colour of their own; all others share one.
const MOST_TERMS: usize = 5;
/// Length of the longest bar in lengths of the shortest; longer ones are cut.
const LONGEST: f64 = 8.0;

/// The section.
pub fn section(report: &Report) -> String {
    let rows = &report.planners;
    let Some(asked) = rows.iter().map(|row| row.asked).max().filter(|asked| *asked > 0) else { return String::new() };
    let walks = if asked == 1 { "one walk" } else { &format!("{asked} walks") };
    format!(
        "{}{}<p class=\"note\">On {walks} of this dataset, 200 frames of each at most. All are measured alike against the \
         unsimplified town; the other planners have the limits of the published flights and default wishes. A* searches \
         voxels of 2 m; smoothed, its way is brought within the limits of motion. Straight behind keeps its place behind \
         the walker and sees no obstacle: what planning is for.</p>",
        table(rows),
        costs(rows)
    )
}

fn table(rows: &[PlannerRow]) -> String {
    let mut text = String::from(
        "<div class=\"scroll card wide\" tabindex=\"0\" role=\"region\" aria-label=\"Table of planners\"><table class=\"wide-table\"><thead><tr>",
    );
    let heads = [
        "planner",
        "visible",
        "half seen",
        "distance, m",
        "way, m",
        "nearest obstacle, m",
        "most m/s²",
        "most m/s³",
        "within limits",
    ];
    for head in heads {
        let _ = write!(text, "<th scope=\"col\">{head}</th>");
    }
    text.push_str("</tr></thead><tbody>");
    let known = |value: KnownNumber, written: fn(f64) -> String| value.map_or("–".to_owned(), written);
    for row in rows {
        let _ = write!(text, "<tr><th scope=\"row\">{}</th>", named(&row.planner));
        for share in [row.visible, row.half_visible] {
            let _ = write!(text, "<td>{}</td>", known(share, percent));
        }
        for number in [row.distance_m, row.length_m, row.nearest_m, row.acceleration_mps2, row.jerk_mps3] {
            let _ = write!(text, "<td>{}</td>", known(number, |value| format!("{value:.1}")));
        }
        let class = if row.sound == row.asked { "" } else { " class=\"bad\"" };
        let _ = write!(text, "<td{class}>{} of {}</td></tr>", row.sound, row.asked);
    }
    text.push_str("</tbody></table></div>");
    for row in rows.iter().filter(|row| row.planned < row.asked) {
        let reason = row.refusal.as_deref().map_or(String::new(), |reason| format!(": {}", escaped(reason)));
        let _ = write!(
            text,
            "<p class=\"note\">{} found {} of {}; its numbers are of these{reason}</p>",
            named(&row.planner),
            row.planned,
            counted(row.asked, "flight")
        );
    }
    text
}

/// A name whose parts in back-ticks are code, as HTML.
fn named(name: &str) -> String {
    let parts = escaped(name);
    let mut parts = parts.split('`');
    let mut text = parts.next().unwrap_or_default().to_owned();
    for (at, part) in parts.enumerate() {
        let _ = write!(text, "{}{part}", if at % 2 == 0 { "<code>" } else { "</code>" });
    }
    text
}

/// Cost per frame as bars of terms.
fn costs(rows: &[PlannerRow]) -> String {
    let rows: Vec<&PlannerRow> = rows.iter().filter(|row| !row.costs.is_empty()).collect();
    let mut sums: BTreeMap<&str, f64> = BTreeMap::new();
    for (name, cost) in rows.iter().flat_map(|row| &row.costs) {
        *sums.entry(name).or_default() += cost;
    }
    let mut order: Vec<(&str, f64)> = sums.into_iter().collect();
    order.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(b.0)));
    let shown: Vec<&str> = order.iter().take(MOST_TERMS).map(|it| it.0).collect();
    let total = |row: &PlannerRow| row.costs.iter().map(|it| it.1).sum::<f64>();
    let least = rows.iter().map(|row| total(row)).fold(f64::INFINITY, f64::min);
    let longest = rows.iter().map(|row| total(row)).fold(0.0, f64::max).min(LONGEST * least);
    if rows.is_empty() || !longest.is_finite() || longest <= 0.0 {
        return String::new();
    }
    let mut text = String::from("<figure class=\"card wide\"><h3>Cost per frame, by term</h3><p class=\"legend\">");
    for (class, name) in shown.iter().enumerate() {
        let _ = write!(text, "<span><i class=\"c{class}\"></i>{}</span>", escaped(name));
    }
    if order.len() > shown.len() {
        let _ = write!(text, "<span><i class=\"c{MOST_TERMS}\"></i>others</span>");
    }
    text.push_str(
        "</p><table class=\"bars costs\"><thead><tr><th scope=\"col\">planner</th><th scope=\"col\">cost</th>\
         <th scope=\"col\"><span class=\"hidden\">bar</span></th></tr></thead><tbody>",
    );
    for row in &rows {
        let cost = |term: &str| row.costs.iter().find(|it| it.0 == term).map_or(0.0, |it| it.1.max(0.0));
        let mut parts: Vec<f64> = shown.iter().map(|term| cost(term)).collect();
        parts.push((total(row) - parts.iter().sum::<f64>()).max(0.0));
        let is_cut = total(row) > longest * 1.001;
        let mut bar = String::new();
        let mut left = longest;
        for (class, part) in parts.iter().enumerate() {
            let part = part.min(left);
            left -= part;
            if part > 0.0 {
                let _ = write!(bar, "<i class=\"c{class}\" style=\"width:{:.2}%\"></i>", 100.0 * part / longest);
            }
        }
        let _ = write!(
            text,
            "<tr><th scope=\"row\">{}</th><td>{}</td><td class=\"bar-cell{}\">{bar}</td></tr>",
            named(&row.planner),
            short(total(row)),
            if is_cut { " cut" } else { "" }
        );
    }
    text.push_str("</tbody></table>");
    text.push_str(&numbers(&rows, &order));
    text.push_str(
        "<figcaption>The cost that the default preset minimises, without the terms of plugins. A dotted end: longer than drawn.</figcaption></figure>",
    );
    text
}

fn numbers(rows: &[&PlannerRow], order: &[(&str, f64)]) -> String {
    let mut text = String::from(
        "<details><summary>Numbers</summary><div class=\"scroll\" tabindex=\"0\" role=\"region\" \
         aria-label=\"Table of costs per frame, by term\"><table class=\"wide-table\"><thead><tr><th scope=\"col\">planner</th>",
    );
    for (name, _) in order {
        let _ = write!(text, "<th scope=\"col\">{}</th>", escaped(name));
    }
    text.push_str("</tr></thead><tbody>");
    for row in rows {
        let _ = write!(text, "<tr><th scope=\"row\">{}</th>", named(&row.planner));
        for (name, _) in order {
            let cost = row.costs.iter().find(|it| it.0 == *name).map_or(0.0, |it| it.1);
            let _ = write!(text, "<td>{}</td>", short(cost));
        }
        text.push_str("</tr>");
    }
    text.push_str("</tbody></table></div></details>");
    text
}
