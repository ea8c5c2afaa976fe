//! [`Notes`]: what the maker of an entry says of it, in a file in TOML beside its bundle.

use cosfly_diagnose::nearest_name;
use cosfly_domain::channels;
use serde_json::Value;
use std::path::Path;

/// Keys of the file, sorted.
const KEYS: [&str; 6] = ["about", "core_seconds", "licence", "link", "seconds", "sees"];
/// Most letters of a text.
const MOST_LETTERS: usize = 300;

/// Longest time of an episode, seconds.
const MOST_SECONDS: f64 = 1e6;

/// Notes of an entry's maker.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Notes {
    /// A sentence.
    pub about: Option<String>,
    /// Core-seconds of an episode, as measured by the maker.
    pub core_seconds: Option<f64>,
    /// Licence of the policy.
    pub licence: Option<String>,
    /// Address of the policy: `https://` or `http://`.
    pub link: Option<String>,
    /// Seconds of an episode by the clock, as measured by the maker.
    pub seconds: Option<f64>,
    /// Inputs of the policy: `world`, or `state` and channels. Empty: what it was sent.
    pub sees: Vec<String>,
}

impl Notes {
    /// Reads the text of the file `name`.
    ///
    /// # Errors
    /// The fault, in words.
    pub fn of_text(name: &str, text: &str) -> Result<Self, String> {
        let table = cosfly_recipe::table(Path::new(name), text);
        let table = table.map_err(|problems| {
            let messages: Vec<&str> = problems.iter().map(|problem| problem.message.as_str()).collect();
            format!("`{name}` is no TOML: {}", messages.join("; "))
        })?;
        let mut notes = Self::default();
        for (key, value) in &table {
            match key.as_str() {
                "about" => notes.about = Some(words(name, key, value)?),
                "core_seconds" => notes.core_seconds = Some(seconds(name, key, value)?),
                "licence" => notes.licence = Some(words(name, key, value)?),
                "link" => notes.link = Some(address(name, value)?),
                "seconds" => notes.seconds = Some(seconds(name, key, value)?),
                "sees" => notes.sees = seen(name, value)?,
                _ => return Err(format!("`{key}` is no key of `{name}`{}", near(key, &KEYS))),
            }
        }
        Ok(notes)
    }
}

/// The nearest of the names that are allowed, and all of them.
fn near(given: &str, allowed: &[&str]) -> String {
    let near = nearest_name(given, allowed.iter().copied());
    let near = near.map_or(".".to_owned(), |near| format!("; did you mean `{near}`?"));
    format!("{near} Allowed are {}", allowed.join(", "))
}

fn words(name: &str, key: &str, value: &Value) -> Result<String, String> {
    let text = value.as_str().ok_or_else(|| format!("`{key}` of `{name}` must be a text"))?;
    match text.chars().count() {
        count if count > MOST_LETTERS => {
            Err(format!("`{key}` of `{name}` has {count} letters; it may have {MOST_LETTERS}"))
        }
        _ => Ok(text.to_owned()),
    }
}

fn seconds(name: &str, key: &str, value: &Value) -> Result<f64, String> {
    let number = value.as_f64().filter(|number| (0.0..=MOST_SECONDS).contains(number));
    number.ok_or_else(|| format!("`{key}` of `{name}` must be a number of seconds from 0 to {MOST_SECONDS}"))
}

fn address(name: &str, value: &Value) -> Result<String, String> {
    let text = words(name, "link", value)?;
    let is_address = ["https://", "http://"].iter().any(|start| text.starts_with(start));
    let is_whole = text.chars().all(|letter| !letter.is_whitespace() && !letter.is_control());
    match is_address && is_whole {
        true => Ok(text),
        false => Err(format!("`link` of `{name}` must begin with https:// or http:// and have no spaces")),
    }
}

fn seen(name: &str, value: &Value) -> Result<Vec<String>, String> {
    let given: Vec<Value> = value.as_array().cloned().unwrap_or_else(|| vec![value.clone()]);
    let given = given.iter().map(|value| words(name, "sees", value)).collect::<Result<Vec<String>, String>>()?;
    let allowed: Vec<&str> = ["world", "state"].into_iter().chain(channels::of_moments().map(|it| it.name)).collect();
    let allowed: Vec<&str> = allowed.into_iter().chain(cosfly_sensors::ALL.iter().map(|it| it.name)).collect();
    if let Some(wrong) = given.iter().find(|it| !allowed.contains(&it.as_str())) {
        return Err(format!("`sees` of `{name}` has `{wrong}`{}", near(wrong, &allowed)));
    }
    match given.len() > 1 && given.iter().any(|it| it == "world") {
        true => Err(format!("`sees` of `{name}`: `world` stands alone: who knows the world needs nothing else")),
        false => Ok(given),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Notes, String> {
        Notes::of_text("mine.toml", text)
    }

    #[test]
    fn notes_are_read_and_what_is_wrong_is_told() {
        let notes = read("licence = \"MIT\"\nlink = \"https://example.org/x\"\nsees = \"rgb\"\n").expect("notes");
        assert_eq!((notes.licence.as_deref(), notes.sees), (Some("MIT"), vec!["rgb".to_owned()]));
        assert_eq!(read("sees = [\"state\", \"depth\"]").expect("notes").sees.len(), 2);
        let timed = read("seconds = 3\ncore_seconds = 4.5").expect("notes");
        assert_eq!((timed.seconds, timed.core_seconds), (Some(3.0), Some(4.5)));
        assert_eq!(read("").expect("notes"), Notes::default());
        for (text, words) in [
            ("license = \"MIT\"", "did you mean `licence`?"),
            ("link = \"javascript:alert(1)\"", "must begin with https://"),
            ("link = \"https://a b\"", "no spaces"),
            ("sees = \"rbg\"", "did you mean `rgb`?"),
            ("sees = [\"world\", \"rgb\"]", "stands alone"),
            ("seconds = 1e300", "a number of seconds from 0"),
            ("core_seconds = -1", "a number of seconds from 0"),
            ("seconds = \"3\"", "a number of seconds from 0"),
            ("sees = 3", "must be a text"),
            ("about = ", "is no TOML"),
        ] {
            let wrong = read(text).expect_err(text);
            assert!(wrong.contains(words), "{text}: {wrong}");
        }
        assert!(read(&format!("about = \"{}\"", "a".repeat(301))).is_err());
    }
}
