//! Paths and their answers.

use crate::page::{PAGE, SCRIPTS, STYLE};
use crate::server::{Request, Response};
use crate::subject::ViewSubject;
use cosfly_diagnose::{Diagnostic, Result, contained};
use cosfly_secrets::without_secrets;
use serde_json::{Value, json};

/// The answer to a request that may be answered.
pub fn answer(request: &Request, subject: &dyn ViewSubject) -> Response {
    let assets = SCRIPTS.iter().chain([&PAGE, &STYLE]);
    if let Some(asset) = assets.into_iter().find(|asset| asset.path == request.path) {
        return Response::file(asset.media_type, asset.text);
    }
    // A damaged file may lead a decoder astray; the server goes on.
    match contained(|| data(&request.path, subject)) {
        Some(Ok(Some(response))) => response,
        Some(Ok(None)) => Response::refusal(404, "there is nothing here"),
        Some(Err(refusal)) => {
            let status = if refusal.code == "view-unknown" { 404 } else { 422 };
            Response::json(&told(&refusal)).with_status(status)
        }
        None => Response::json(&json!({ "message": "a file cannot be read: its reader stopped" })).with_status(422),
    }
}

/// Data at a path; none where the path is of nothing.
fn data(path: &str, subject: &dyn ViewSubject) -> Result<Option<Response>> {
    let parts: Vec<&str> = path.split('/').skip(1).collect();
    let response = match parts[..] {
        ["picture", flight, frame, channel] => {
            let (Some(flight), Some(frame)) = (number(flight), number(frame)) else { return Ok(None) };
            let picture = subject.picture(flight, frame, channel)?;
            Some(Response::file(picture.media_type, picture.bytes).kept())
        }
        _ => value(path, subject)?.map(|value| Response::json(&value)),
    };
    Ok(response)
}

/// The value at a path below `/api`; none where the path is of nothing.
///
/// # Errors
/// Those of the subject.
pub fn value(path: &str, subject: &dyn ViewSubject) -> Result<Option<Value>> {
    let parts: Vec<&str> = path.split('/').skip(1).collect();
    let (kind, number) = match parts[..] {
        ["api", "about"] => return subject.about().map(Some),
        ["api", "index"] => return subject.index().map(|index| Some(index.json())),
        ["api", "progress"] => return subject.progress().map(|progress| Some(progress.unwrap_or(Value::Null))),
        ["api", kind, flight] => (kind, number(flight)),
        _ => return Ok(None),
    };
    match (kind, number) {
        ("flight", Some(number)) => subject.flight(number).map(Some),
        ("bodies", Some(number)) => subject.bodies(number).map(Some),
        ("town", Some(number)) => subject.town(number).map(Some),
        ("paths", Some(number)) => subject.paths(number).map(Some),
        _ => Ok(None),
    }
}

/// A number of decimal digits, nothing else.
fn number(text: &str) -> Option<usize> {
    let is_number = (1..=9).contains(&text.len()) && text.bytes().all(|byte| byte.is_ascii_digit());
    text.parse().ok().filter(|_| is_number)
}

/// An error for the page.
pub fn told(refusal: &Diagnostic) -> Value {
    let shown = |texts: &[String]| texts.iter().map(|text| without_secrets(text)).collect::<Vec<_>>();
    json!({
        "code": refusal.code, "message": without_secrets(&refusal.message),
        "causes": shown(&refusal.causes), "hints": shown(&refusal.hints),
    })
}
