//! The page with its data in one file, for a colleague.

use crate::page::{PAGE, SCRIPTS, STYLE};
use crate::routes::value;
use crate::subject::ViewSubject;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use cosfly_diagnose::{Diagnostic, Fault, Result, Stop};
use serde_json::{Map, Value, json};
use sha2::{Digest, Sha256};

/// Most bytes of the file.
const MOST_BYTES: usize = 50_000_000;
/// Most pictures of a flight.
const MOST_PICTURES: usize = 60;

/// The page with the flights `numbers`, worst first, as many as fit into 50 MB: all their frames, and up to 60 colour pictures of
/// each. Returns the file and the number of flights in it.
///
/// # Errors
/// Those of the subject; `view-size` where not even one flight fits; `stopped`.
pub fn export(subject: &dyn ViewSubject, numbers: &[usize], stop: &Stop) -> Result<(String, usize)> {
    let mut data = Map::new();
    for path in ["/api/about", "/api/index"] {
        data.insert(path.to_owned(), value(path, subject)?.unwrap_or_default());
    }
    let mut bytes = shell("").len() + text(&data).len();
    let mut held = vec![];
    for number in numbers {
        stop.check("exporting")?;
        let part = flight(subject, *number, &data)?;
        let more = text(&part).len();
        if bytes + more > MOST_BYTES {
            break;
        }
        bytes += more;
        data.extend(part);
        held.push(*number);
    }
    if held.is_empty() && !numbers.is_empty() || bytes > MOST_BYTES {
        let message = format!("the page would have more than {} MB", MOST_BYTES / 1_000_000);
        return Err(Diagnostic::new("view-size", Fault::Recipe, message)
            .hint("show it with `cosfly view` instead, or make a smaller dataset"));
    }
    data.insert("held".to_owned(), json!(held));
    Ok((shell(&text(&data)), held.len()))
}

/// Paths and values of a flight that are not among `known`.
fn flight(subject: &dyn ViewSubject, number: usize, known: &Map<String, Value>) -> Result<Map<String, Value>> {
    let mut data = Map::new();
    let whole = subject.flight(number)?;
    for path in [format!("/api/bodies/{number}"), format!("/api/town/{number}")] {
        let found = value(&path, subject)?.unwrap_or_default();
        // Towns of many flights are held once: the page looks for them by their names.
        let key = found.get("name").and_then(Value::as_str).map_or(path, |name| format!("town {name}"));
        if !known.contains_key(&key) {
            data.insert(key, found);
        }
    }
    let frames = whole["x"].as_array().map_or(0, Vec::len);
    let has_pictures = whole["channels"].as_array().is_some_and(|channels| channels.contains(&json!("rgb")));
    for frame in (0..frames).step_by(frames.div_ceil(MOST_PICTURES).max(1)).filter(|_| has_pictures) {
        let Ok(picture) = subject.picture(number, frame, "rgb") else { continue };
        let address = format!("data:{};base64,{}", picture.media_type, STANDARD.encode(&picture.bytes));
        data.insert(format!("/picture/{number}/{frame}/rgb"), Value::String(address));
    }
    data.insert(format!("/api/flight/{number}"), whole);
    Ok(data)
}

/// Data as text that ends no script element.
fn text(data: &Map<String, Value>) -> String {
    serde_json::to_string(data).unwrap_or_default().replace('<', "\\u003c").replace('\u{2028}', "\\u2028")
}

/// The page with `data` inside; its policy allows its own scripts alone, by their hashes.
fn shell(data: &str) -> String {
    let script = SCRIPTS.iter().map(|script| script.text).collect::<Vec<_>>().join("\n");
    let hash = |text: &str| format!("'sha256-{}'", STANDARD.encode(Sha256::digest(text.as_bytes())));
    let policy = format!(
        "default-src 'none'; script-src {}; style-src {}; img-src data:; base-uri 'none'; form-action 'none'",
        hash(&script),
        hash(STYLE.text)
    );
    let mut page = PAGE.text.replace(
        "<link rel=\"stylesheet\" href=\"style.css\">",
        &format!("<meta http-equiv=\"Content-Security-Policy\" content=\"{policy}\">\n<style>{}</style>", STYLE.text),
    );
    for asset in &SCRIPTS {
        page = page.replace(&format!("<script src=\"{}\"></script>\n", &asset.path[1..]), "");
    }
    let inside =
        format!("<script type=\"application/json\" id=\"data\">{data}</script>\n<script>{script}</script>\n</body>");
    page.replace("</body>", &inside)
}
