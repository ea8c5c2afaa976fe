//! Language: how different the texts are, what they speak of, whether they single the target out, what was refused.

use crate::model::Report;
use crate::sketch::{FlightSketch, TextSketch};
use cosfly_captions::{Diversity, Language, coverage, diversity};
use cosfly_diagnose::counted;
use cosfly_plot::text::{escaped, grouped, percent};
use std::collections::BTreeMap;
use std::fmt::Write;

/// The section; empty where the drawn flights have no texts.
pub fn section(report: &Report) -> String {
    let drawn = report.figures.drawn();
    let texts = different_by_flight(&drawn);
    if texts.is_empty() {
        return String::new();
    }
    let mut html = String::new();
    for language in Language::ALL.iter().copied() {
        let own: Vec<&TextSketch> = texts.iter().filter(|text| text.language == language.code()).copied().collect();
        if !own.is_empty() {
            html += &of_language(&own, language);
        }
    }
    let _ = write!(
        html,
        "<p class=\"note\">Instructions and goals of {} that this page draws. Distinct-n: different runs of n words (characters in Chinese) of all; \
         self-BLEU: likeness of a text to its neighbours, 1 for all alike. A text singles the target out where it names the clothes and nobody \
         else who is seen in the flight wears the same. Captions were compared with the facts; goals of kind negative do not fit on purpose.</p>",
        counted(drawn.len(), "flight")
    );
    html
}

/// Texts of the films, in their order, without those that another film of the same flight has had: texts are of flights.
fn different_by_flight<'a>(films: &[&'a FlightSketch]) -> Vec<&'a TextSketch> {
    let mut first: BTreeMap<[&str; 4], u64> = BTreeMap::new();
    let mut texts = vec![];
    for &film in films {
        for text in &film.texts {
            let key = [&film.flight_id, &text.language, &text.kind, &text.text].map(String::as_str);
            if film.flight_id.is_empty() || *first.entry(key).or_insert(film.number) == film.number {
                texts.push(text);
            }
        }
    }
    texts
}

fn of_language(texts: &[&TextSketch], language: Language) -> String {
    let figures = diversity(texts.iter().map(|text| text.text.as_str()), language);
    let name = language.name();
    let mut html = format!("<h3>{name}</h3><dl class=\"tiles\">");
    for (title, value, note) in tiles(texts, &figures) {
        let _ = write!(
            html,
            "<div class=\"tile\"><dt>{title}</dt><dd><b>{}</b><small>{}</small></dd></div>",
            escaped(&value),
            escaped(&note)
        );
    }
    html.push_str("</dl>");
    let mut subjects: BTreeMap<&str, usize> = BTreeMap::new();
    texts.iter().flat_map(|text| &text.subjects).for_each(|it| *subjects.entry(it).or_default() += 1);
    let mut refused: BTreeMap<&str, usize> = BTreeMap::new();
    texts.iter().flat_map(|text| &text.refused_for).for_each(|it| *refused.entry(it).or_default() += 1);
    for subject in refused.keys() {
        subjects.entry(subject).or_default();
    }
    html.push_str(
        "<table><thead><tr><th>Subject</th><th>Texts that speak of it</th><th>Answers refused for it</th></tr></thead><tbody>",
    );
    for (subject, count) in subjects {
        let share = percent(count as f64 / texts.len() as f64);
        let refused = grouped(refused.get(subject).copied().unwrap_or_default() as u64);
        let (subject, count) = (escaped(subject), grouped(count as u64));
        let _ = write!(html, "<tr><td>{subject}</td><td>{count} ({share})</td><td>{refused}</td></tr>");
    }
    html.push_str("</tbody></table>");
    html += &of_coverage(texts, language);
    html
}

/// Tables of the relations and the intents that the texts speak of.
fn of_coverage(texts: &[&TextSketch], language: Language) -> String {
    let found = coverage(texts.iter().map(|text| text.text.as_str()), language);
    let mut html = String::new();
    for (title, counts) in [("Relation", found.relations), ("Intent", found.intents)] {
        let _ = write!(html, "<table><thead><tr><th>{title}</th><th>Texts that speak of it</th></tr></thead><tbody>");
        for (kind, count) in counts {
            let share = percent(count as f64 / texts.len() as f64);
            let _ = write!(html, "<tr><td>{kind}</td><td>{} ({share})</td></tr>", grouped(count as u64));
        }
        html.push_str("</tbody></table>");
    }
    html
}

fn tiles(texts: &[&TextSketch], figures: &Diversity) -> Vec<(&'static str, String, String)> {
    let mut kinds: BTreeMap<&str, usize> = BTreeMap::new();
    texts.iter().for_each(|text| *kinds.entry(&text.kind).or_default() += 1);
    let kinds: Vec<String> = kinds.into_iter().map(|(kind, count)| format!("{count} {kind}")).collect();
    let singled = texts.iter().filter(|text| text.singles_out).count() as f64 / texts.len() as f64;
    let taught = texts.iter().filter(|text| text.is_taught).count() as u64;
    let refused: u64 = texts.iter().map(|text| text.refused).sum();
    let [least, most] = figures.words;
    vec![
        ("Texts", grouped(figures.texts as u64), kinds.join(", ")),
        ("Different texts", grouped(figures.different_texts as u64), String::new()),
        ("Words of a text", format!("{:.1}", figures.mean_words), format!("{least} to {most}")),
        ("Distinct-1", format!("{:.3}", figures.distinct_1), String::new()),
        ("Distinct-2", format!("{:.3}", figures.distinct_2), counted(grouped(figures.pairs as u64), "pair")),
        ("Self-BLEU", format!("{:.3}", figures.self_bleu), "against neighbouring texts".to_owned()),
        ("Single the target out", percent(singled), "by clothes that nobody else seen wears".to_owned()),
        ("Texts of a teacher", grouped(taught), format!("{} refused", counted(grouped(refused), "answer"))),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figures::Figures;

    #[test]
    fn texts_are_counted_by_language_and_escaped() {
        let text = |language: &str, text: &str, singles_out| TextSketch {
            language: language.to_owned(),
            kind: "step".to_owned(),
            text: text.to_owned(),
            subjects: vec!["<turn>".to_owned()],
            singles_out,
            ..TextSketch::default()
        };
        let texts =
            vec![text("en", "They turn left.", true), text("en", "They stop.", false), text("zh", "往左拐。", false)];
        let mut figures = Figures::default();
        figures.add(FlightSketch { texts, ..FlightSketch::default() });
        let html = section(&Report { figures, ..Report::default() });
        assert!(html.contains("English") && html.contains("Chinese") && html.contains("&lt;turn&gt;"), "{html}");
        assert!(html.contains("2 (100"), "{html}");
        assert!(html.contains("<td>wait</td><td>1 (50"), "{html}");
        assert_eq!(section(&Report::default()), "");
    }

    #[test]
    fn a_text_of_several_films_of_a_flight_counts_once() {
        let count = |flights: [&str; 2]| {
            let text =
                |kind: &str| TextSketch { kind: kind.to_owned(), text: "They stop.".into(), ..TextSketch::default() };
            let film = |number: u64| FlightSketch {
                number,
                flight_id: flights[number as usize].to_owned(),
                texts: vec![text("step"), text("goal"), text("step")],
                ..FlightSketch::default()
            };
            different_by_flight(&[&film(0), &film(1)]).len()
        };
        assert_eq!((count(["a", "a"]), count(["a", "b"]), count(["", ""])), (3, 6, 6));
    }
}
