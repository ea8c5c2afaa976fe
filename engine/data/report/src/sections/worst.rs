//! The worst flights, with pictures.

use crate::model::Report;
use crate::moments;
use crate::pictures::{Source, image};
use cosfly_plot::strip::strip;
use cosfly_plot::text::escaped;
use std::fmt::Write;

/// The section.
pub fn section<E>(report: &Report, pictures: Source<'_, E>) -> Result<String, E> {
    let mut text = String::from("<div class=\"grid cases\">");
    for case in moments::worst(&report.figures.worst) {
        let flight = case.flight;
        let _ = write!(text, "<article class=\"card\"><h3>{}</h3>", capitalised(case.what));
        let _ = write!(
            text,
            "<p><b>{}</b><br>{}, {}, {}</p><div class=\"pair\">",
            escaped(&case.figure),
            escaped(&flight.id),
            escaped(&flight.town),
            escaped(&flight.weather)
        );
        for (frame, what) in &case.frames {
            let share = 100.0 * f64::from(flight.visible.get(*frame).copied().unwrap_or_default());
            let words = format!("frame {frame}: {what}, {share:.0} % visible");
            if let Some(jpeg) = pictures(flight, *frame)? {
                let alternative = format!("{} of {}", words, flight.id);
                let _ = write!(
                    text,
                    "<figure>{}<figcaption>{words}</figcaption></figure>",
                    image(&jpeg, flight, *frame, &alternative)
                );
            } else {
                let _ = write!(text, "<p class=\"note\">{words}</p>");
            }
        }
        let name = format!("{}: visibility over time", flight.id);
        let _ = write!(text, "</div>{}</article>", strip(&flight.visible, flight.len().max(1), &name));
    }
    text.push_str("</div>");
    Ok(text)
}

fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}
