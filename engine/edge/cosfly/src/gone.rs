//! Former words of the command line: each is an error that names the new one.

use clap::error::{ContextKind, ContextValue, ErrorKind};

/// Command, its former word, and what to write instead.
const GONE: &[(&str, &str, &str)] = &[
    ("", "plan-from", "the command is `cosfly ask-expert`"),
    ("doctor", "--imperfect", "write `--imperfect-share`, a share from 0 to 1"),
    ("eval", "--dataset", "the dataset comes first: `cosfly eval DATASET PREDICTIONS`"),
    ("eval", "--from", "write `--origin`"),
    ("eval", "--max-depth", "write `--max-depth-m`"),
    ("export", "--shard-size", "write `--shard-mb`"),
    ("export", "--width", "write `--width-px`"),
    ("init", "--from", "write `--template`"),
    ("fly", "--api-key", "write the key into a file, `--api-key-file FILE`, or into COSFLY_API_KEY"),
    ("fly", "--size", "write `--size-px`"),
    ("fly", "--timeout", "write `--timeout-s`"),
    ("fly", "--wait", "write `--wait-s`"),
    ("dagger", "--expert", "write `--expert-share`"),
    ("dagger", "--api-key", "write the key into a file, `--api-key-file FILE`, or into COSFLY_API_KEY"),
    ("dagger", "--size", "write `--size-px`"),
    ("dagger", "--timeout", "write `--timeout-s`"),
    ("dagger", "--wait", "write `--wait-s`"),
    ("ask-expert", "--horizon", "write `--horizon-s`"),
    ("ask-expert", "--position", "write `--position-m`"),
    ("ask-expert", "--velocity", "write `--velocity-mps`"),
];

/// Replacement of a file behind `--json` of `cosfly doctor`.
const DOCTOR_FILE: &str = "`--json` prints; write `--out FILE` for a file";

/// The error of a command line with the way out, where it is about a former word. `command` is the first word of the line.
pub fn explained(command: &str, error: clap::Error) -> clap::Error {
    match replacement(command, &error) {
        Some(advice) => clap::Error::raw(error.kind(), format!("{}\n\n  help: {advice}\n", first_line(&error))),
        None => error,
    }
}

/// First line of an error of the command line, without its "error: ".
fn first_line(error: &clap::Error) -> String {
    let text = error.to_string();
    let line = text.lines().next().unwrap_or_default();
    line.strip_prefix("error: ").unwrap_or(line).to_owned()
}

/// Replacement of the word that an error is about, where the word is a former one. `command` is the first word of the
/// line.
fn replacement(command: &str, error: &clap::Error) -> Option<&'static str> {
    let kind = match error.kind() {
        ErrorKind::UnknownArgument => ContextKind::InvalidArg,
        ErrorKind::InvalidSubcommand => ContextKind::InvalidSubcommand,
        _ => return None,
    };
    let Some(ContextValue::String(word)) = error.get(kind) else { return None };
    let word = word.split(['=', ' ']).next()?;
    if (command, word.starts_with('-')) == ("doctor", false) && error.kind() == ErrorKind::UnknownArgument {
        return Some(DOCTOR_FILE);
    }
    let of = if error.kind() == ErrorKind::InvalidSubcommand { "" } else { command };
    GONE.iter().find(|(command, former, _)| (*command, *former) == (of, word)).map(|entry| entry.2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::cli;

    #[test]
    fn former_words_are_refused_with_the_new_ones() {
        for (command, former, advice) in GONE {
            let line = ["cosfly", command, former].into_iter().filter(|word| !word.is_empty());
            let error = cli().try_get_matches_from(line).unwrap_err();
            assert_eq!(replacement(command, &error), Some(*advice), "{command} {former}: {error}");
        }
        let error = cli().try_get_matches_from(["cosfly", "doctor", "data", "--json", "found.json"]).unwrap_err();
        assert_eq!(replacement("doctor", &error), Some(DOCTOR_FILE));
        let error = cli().try_get_matches_from(["cosfly", "fly", "--never"]).unwrap_err();
        assert_eq!(replacement("fly", &error), None);
    }
}
