//! [`Secrets`]: secrets that are known by their values.

use crate::address::without_secrets;
use std::ffi::OsString;

/// Parts of names of environment variables whose values are secrets.
const SECRET_NAMES: [&str; 6] = ["KEY", "TOKEN", "SECRET", "PASSW", "CREDENTIAL", "AUTH"];
/// Shortest value of the environment that is taken for a secret, bytes.
const SHORTEST_OF_ENVIRONMENT: usize = 8;
/// Shortest secret that is given, bytes: shorter ones occur in any text.
const SHORTEST: usize = 4;
/// Text in the place of a secret.
const HIDDEN: &str = "***";

/// Secrets that are hidden wherever a text repeats them.
#[derive(Clone, Default)]
pub struct Secrets {
    values: Vec<String>,
}

impl Secrets {
    /// Secrets of these values.
    pub fn of(values: impl IntoIterator<Item = String>) -> Self {
        let mut values: Vec<String> = values.into_iter().filter(|value| value.len() >= SHORTEST).collect();
        // A secret that begins another one would leave the end of that one.
        values.sort_by_key(|value| std::cmp::Reverse(value.len()));
        Self { values }
    }

    /// Secrets of before, and the values of the variables of an environment that are called like secrets: `AWS_SECRET_ACCESS_KEY`, `HF_TOKEN`.
    pub fn with_environment(self, variables: impl IntoIterator<Item = (OsString, OsString)>) -> Self {
        let secret = |(name, value): (OsString, OsString)| {
            let (name, value) = (name.to_string_lossy().to_uppercase(), value.into_string().ok()?);
            let is_secret = SECRET_NAMES.iter().any(|part| name.contains(part));
            // Not the place of a file with a secret, and not words.
            let is_value = value.len() >= SHORTEST_OF_ENVIRONMENT && value.bytes().all(|byte| byte.is_ascii_graphic());
            (is_secret && is_value && !value.starts_with(['/', '.', '~'])).then_some(value)
        };
        Self::of(self.values.into_iter().chain(variables.into_iter().filter_map(secret)))
    }

    /// `text` without these secrets, and without those that [`without_secrets`] finds.
    pub fn hidden(&self, text: &str) -> String {
        let known = |text: String, value: &String| text.replace(value.as_str(), HIDDEN);
        without_secrets(&self.values.iter().fold(text.to_owned(), known))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn given_keys_and_those_of_the_environment_are_hidden() {
        let variables = [("HF_TOKEN", "hf_abcdefgh"), ("HOME", "/home/someone"), ("API_KEY_FILE", "/run/secrets/key")];
        let variables = variables.map(|(name, value)| (OsString::from(name), OsString::from(value)));
        let secrets = Secrets::of(["abcd".to_owned(), "abcdefgh-long".to_owned(), "x".to_owned()]);
        let secrets = secrets.with_environment(variables);
        let text = "abcd, abcdefgh-long, hf_abcdefgh, /home/someone, /run/secrets/key, x";
        assert_eq!(secrets.hidden(text), "***, ***, ***, /home/someone, /run/secrets/key, x");
    }
}
