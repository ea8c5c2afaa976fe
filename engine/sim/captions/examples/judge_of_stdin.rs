//! Judges texts: lines of JSON with `facts`, `language` and `text` on the standard input, a line of contradictions for each on the standard output.

use cosfly_captions::teaching::foreign_words;
use cosfly_captions::{Facts, Language, check};
use std::io::{BufRead as _, Write as _};

#[derive(serde::Deserialize)]
struct Line {
    facts: Facts,
    language: String,
    text: String,
}

fn main() -> std::io::Result<()> {
    let mut out = std::io::stdout().lock();
    for line in std::io::stdin().lock().lines() {
        let line: Line = serde_json::from_str(&line?)?;
        let language = Language::of_code(&line.language);
        let language = language.ok_or_else(|| std::io::Error::other("`language` is `en` or `zh`"))?;
        let mut wrong = check(&line.text, language, &line.facts).err().unwrap_or_default();
        wrong.extend(foreign_words(&line.text, language));
        let told: Vec<String> = wrong.iter().map(ToString::to_string).collect();
        writeln!(out, "{}", serde_json::to_string(&told)?)?;
    }
    Ok(())
}
