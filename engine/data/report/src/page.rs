//! The page as a whole: heading, contents, sections, foot.

use crate::document::{Section, document};
use crate::model::Report;
use crate::moments;
use crate::pictures::{Source, image};
use crate::sections::{
    distributions, language, maps, numbers, planners, planning, shares, shortcuts, timelines, worst,
};
use cosfly_plot::text::escaped;
use std::fmt::Write;

/// Pictures in the heading.
const GALLERY: usize = 6;

/// The page, HTML. `pictures` returns the small colour image of a frame of a flight, where there is one.
///
/// # Errors
/// Those of `pictures`.
pub fn page<E>(report: &Report, pictures: Source<'_, E>) -> Result<String, E> {
    let section = |id, [short_title, title]: [&'static str; 2], body| Section { id, short_title, title, body };
    let sections = [
        section("numbers", ["Numbers", "In numbers"], numbers::section(report)),
        section("maps", ["Maps", "Where they fly"], maps::section(report)),
        section("time", ["Visibility", "When the target is seen"], timelines::section(report)),
        section("distributions", ["Distributions"; 2], distributions::section(report)),
        section("shortcuts", ["Shortcuts", "What gives the target away"], shortcuts::section(report)),
        section("language", ["Language", "What the texts say"], language::section(report)),
        section("planning", ["Planning"; 2], planning::section(report)),
        section("planners", ["Planners", "Planners beside each other"], planners::section(report)),
        section("worst", ["Worst cases"; 2], worst::section(report, pictures)?),
        section("shares", ["Shares", "What is where, and what was left out"], shares::section(report)),
    ];
    Ok(document(&report.title, &heading(report, pictures)?, &sections, &foot(report)))
}

fn heading<E>(report: &Report, pictures: Source<'_, E>) -> Result<String, E> {
    let mut html = format!(
        "<header><div class=\"words\"><p class=\"eyebrow\">Dataset report</p><h1>{}</h1><p class=\"lead\">{}</p>",
        escaped(&report.title),
        escaped(report.description.trim())
    );
    let visible = &report.figures.visible_by_expert;
    if !visible.is_empty() {
        let sum: f64 = visible.values().map(|(value, count)| value * count as f64).sum();
        let twins = report.figures.mean_visible()[1];
        let twins = twins.map_or_else(String::new, |mean| format!(", {:.1} % over perturbed flights", 100.0 * mean));
        let _ = write!(
            html,
            "<p class=\"headline\"><b>{:.1} %</b> of the target is visible on average over expert flights{twins}; {:.1} % in the \
             median expert flight.</p>",
            100.0 * sum / visible.len() as f64,
            100.0 * visible.quantile(0.5)
        );
    }
    let facts = [&report.name_and_version, &report.published, &report.creator, &report.license];
    let facts: Vec<String> = facts.into_iter().filter(|it| !it.is_empty()).map(|it| escaped(it)).collect();
    let _ = write!(html, "<p class=\"facts\">{}</p></div>", facts.join("<span aria-hidden=\"true\"> · </span>"));
    let mut gallery = String::new();
    for (sketch, frame) in moments::gallery(&report.figures.drawn(), GALLERY) {
        let Some(jpeg) = pictures(sketch, frame)? else { continue };
        let alternative = format!("A target from the air: {}, frame {frame}, {}", sketch.id, sketch.weather);
        let _ = write!(gallery, "<li>{}</li>", image(&jpeg, sketch, frame, &alternative));
    }
    if !gallery.is_empty() {
        let _ = write!(html, "<ul class=\"gallery\" aria-label=\"Frames of some flights\">{gallery}</ul>");
    }
    html.push_str("</header>\n");
    Ok(html)
}

fn foot(report: &Report) -> String {
    let languages = if report.languages.is_empty() {
        String::new()
    } else {
        format!(" Instructions in {}.", escaped(&report.languages.join(", ")))
    };
    format!(
        "<footer><p>Written by cosfly while it published the dataset, from the same records as the tables.{languages} \
         World frame: x east, y south, z up, metres.</p>\
         <p>Check it: <code>cosfly verify .</code> compares every file with its hash and every number with the others; \
         <code>README.md</code> explains all columns.</p></footer>\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figures::Figures;
    use crate::model::{BoxSketch, PlannerRow, RejectionSketch, TownSketch};
    use crate::sketch::{FlightSketch, TextSketch};
    use cosfly_metrics::shortcuts::{Looks, Seen, ShortcutFigures, Shortcuts};
    use std::convert::Infallible;

    fn flight(number: usize, is_perturbed: bool) -> FlightSketch {
        let place = |frame: usize| [frame as f32, number as f32, 20.0];
        FlightSketch {
            id: format!("flight-{number}<{is_perturbed}>"),
            is_perturbed,
            pedestrian: format!("p{number}"),
            town: "plain".into(),
            weather: "ClearNoon".into(),
            split: "train".into(),
            dt_s: 0.5,
            image_px: [64, 48],
            drone_m: (0..20).map(place).collect(),
            feet_m: (0..20).map(|frame| [frame as f32 + 20.0, 0.0, 0.0]).collect(),
            visible: (0..20).map(|frame| (frame % 6) as f32 / 5.0).collect(),
            clearance_m: vec![3.0; 20],
            box_px: vec![Some([30.0, 10.0, 40.0, 30.0]); 20],
            holds: true,
            convergence: if is_perturbed { vec![] } else { vec![10.0, 4.0, 5.0] },
            term_costs: vec![("visibility".into(), 3.0), ("jerk".into(), 1.0)],
            ..FlightSketch::default()
        }
    }

    fn figures() -> Figures {
        let mut figures = Figures::default();
        for number in 0..4 {
            figures.add(FlightSketch { number: number as u64, ..flight(number / 2, number % 2 == 1) });
        }
        figures
    }

    fn shortcuts() -> ShortcutFigures {
        let mut shortcuts = Shortcuts::default();
        let at = |x: f64| Seen {
            edges_px: [x, 10.0, x + 10.0, 30.0],
            crown_and_feet_px: Some([10.0, 30.0]),
            distance_m: 20.0,
            height_m: 1.7,
        };
        shortcuts.add_flight([64.0, 48.0], [(at(30.0), vec![at(32.0)])].into_iter());
        shortcuts.add_target("p1", Looks::of_words([0.5, 0.1, 0.1], 1.7, ["none", "slim", "short"]));
        shortcuts.add_other("p2", Looks::of_words([0.2, 0.2, 0.2], 1.7, ["none", "slim", "short"]));
        shortcuts.figures()
    }

    fn report() -> Report {
        let shape =
            BoxSketch { instance: 3, kind: "building".into(), center_m: [5.0, 5.0], half_m: [4.0, 2.0], yaw_rad: 0.3 };
        Report {
            title: "A <dataset>".into(),
            towns: vec![TownSketch { name: "plain".into(), boxes: vec![shape] }],
            figures: figures(),
            shortcuts: Some(shortcuts()),
            rejections: vec![RejectionSketch { id: "p9".into(), stage: "expert".into(), reason: "no way".into() }],
            ..Report::default()
        }
    }

    fn written(report: &Report) -> String {
        let Ok(html) = page::<Infallible>(report, &mut |_, _| Ok(Some(vec![0xff, 0xd8])));
        html
    }

    #[test]
    fn everything_is_inside_and_nothing_runs() {
        let html = written(&report());
        for outside in ["http:", "https:", "<script", "src=\"/", "@import", "url("] {
            assert!(!html.contains(outside), "{outside}");
        }
        assert!(html.contains("data:image/jpeg;base64,/9g="));
    }

    #[test]
    fn every_element_that_is_opened_is_closed_and_text_is_escaped() {
        let html = written(&report());
        for name in ["section", "figure", "table", "tr", "svg", "g", "ul", "li", "div", "p", "article", "dl", "details"]
        {
            let opened = html.matches(&format!("<{name}>")).count() + html.matches(&format!("<{name} ")).count();
            assert_eq!(opened, html.matches(&format!("</{name}>")).count(), "{name}");
        }
        assert!(html.contains("A &lt;dataset&gt;") && !html.contains("flight-0<"));
    }

    #[test]
    fn text_of_others_is_text_and_absurd_numbers_make_a_small_page() {
        let foreign = "<script>alert(1)</script>\" onload=\"x\">&\u{1b}[31m\u{202e}|`#\n- y";
        let text = || foreign.to_owned();
        for value in [1e9, -3e38, f32::INFINITY, f32::NAN, 1e-30] {
            let absurd = |number: u64| FlightSketch {
                number,
                id: text(),
                pedestrian: text(),
                town: text(),
                weather: text(),
                split: text(),
                drone_m: vec![[value; 3]; 20],
                clearance_m: vec![value; 20],
                visible: vec![value; 20],
                box_px: vec![Some([value; 4]); 20],
                holds: false,
                violations: vec![text()],
                max_jerk_mps3: f64::from(value),
                convergence: vec![f64::MAX, 1e-300, f64::from(value).abs()],
                term_costs: vec![(text(), f64::from(value)), ("jerk".into(), f64::MAX)],
                texts: vec![TextSketch {
                    language: "en".into(),
                    kind: text(),
                    text: text(),
                    subjects: vec![text()],
                    ..TextSketch::default()
                }],
                ..flight(0, number % 2 == 1)
            };
            let mut figures = figures();
            (10..14).for_each(|number| figures.add(absurd(number)));
            let shape = BoxSketch {
                instance: 3,
                kind: text(),
                center_m: [f64::from(value); 2],
                half_m: [4.0, 2.0],
                yaw_rad: 0.3,
            };
            let planner = PlannerRow {
                planner: text(),
                asked: 2,
                costs: vec![(text(), 1.0)],
                refusal: Some(text()),
                ..PlannerRow::default()
            };
            let html = written(&Report {
                title: text(),
                description: text(),
                creator: text(),
                license: text(),
                languages: vec![text()],
                towns: vec![TownSketch { name: text(), boxes: vec![shape] }],
                rejections: vec![RejectionSketch { id: text(), stage: text(), reason: text() }],
                planners: vec![planner],
                figures,
                ..report()
            });
            for harm in ["<script", "\" onload", "\u{1b}", "\u{202e}"] {
                assert!(!html.contains(harm), "{value}: {harm:?}");
            }
            assert!(html.len() < 400_000, "{value}: {} bytes", html.len());
        }
    }

    #[test]
    fn the_same_data_give_the_same_bytes_and_none_give_a_page() {
        assert!(written(&report()) == written(&report()));
        let empty = written(&Report::default());
        assert!(empty.contains("<main") && !empty.contains("NaN") && !empty.contains("inf"), "{empty}");
    }

    #[test]
    fn shortcuts_have_a_section_where_targets_are_seen() {
        let html = written(&report());
        assert!(html.contains("What gives the target away") && html.contains("of 1 expert frames"), "{html}");
        assert!(!written(&Report::default()).contains("What gives the target away"));
    }

    #[test]
    fn every_picture_has_words() {
        let html = written(&report());
        assert_eq!(html.matches("<img ").count(), html.matches(" alt=\"").count());
        assert_eq!(html.matches("<svg ").count(), html.matches("role=\"img\" aria-label=").count());
    }
}
