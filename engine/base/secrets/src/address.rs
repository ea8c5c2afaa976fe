//! Secrets that a text itself shows to be some: parts of addresses, keys of headers.

/// Parts of names of parameters whose values are secrets.
const SECRET_PARAMETERS: [&str; 9] =
    ["key", "token", "secret", "passw", "pwd", "credential", "signature", "sig", "auth"];
/// Words of headers before a key.
const BEFORE_KEYS: [&str; 3] = ["bearer ", "api-key ", "basic "];
/// Longest address that is looked at, characters.
const LONGEST_ADDRESS: usize = 4096;
/// Shortest word after such a word that is taken for a key, bytes: the words occur in sentences too.
const SHORTEST_KEY: usize = 8;

/// `text` with `*` for each character of a secret: names and passwords before the `@` of an address, values of parameters such as
/// `?key=`, keys after `Bearer` and `Api-Key`.
pub fn without_secrets(text: &str) -> String {
    let mut is_hidden = vec![false; text.len()];
    let mut hide = |from: usize, to: usize| is_hidden[from..to].fill(true);
    for (at, _) in text.match_indices("://") {
        secrets_of_address(text, at + 3, &mut hide);
    }
    // Letters of ASCII keep their places.
    let lower = text.to_ascii_lowercase();
    for word in BEFORE_KEYS {
        for (at, _) in lower.match_indices(word) {
            let from = at + word.len();
            let key = text[from..].split(|c: char| !c.is_ascii_graphic() || "\"'`,".contains(c)).next().unwrap_or("");
            if key.len() >= SHORTEST_KEY {
                hide(from, from + key.len());
            }
        }
    }
    text.char_indices().map(|(at, character)| if is_hidden[at] { '*' } else { character }).collect()
}

/// Whether a text holds a secret that [`without_secrets`] hides.
pub fn has_secret(text: &str) -> bool {
    without_secrets(text) != text
}

/// Finds the secrets of the address whose name of a server begins at `from`.
fn secrets_of_address(text: &str, from: usize, hide: &mut impl FnMut(usize, usize)) {
    let ends = |c: char| c.is_whitespace() || c.is_control() || "\"'`<>(){}|\\".contains(c);
    let end = text[from..].char_indices().take(LONGEST_ADDRESS).find(|(_, c)| ends(*c)).map(|(at, _)| at);
    let longest = text[from..].char_indices().nth(LONGEST_ADDRESS).map_or(text.len() - from, |(at, _)| at);
    let address = &text[from..from + end.unwrap_or(longest)];
    let server = address.split(['/', '?', '#']).next().unwrap_or("");
    if let Some(at) = server.rfind('@') {
        hide(from, from + at);
    } else if let Some(at) = address.rfind('@') {
        // A password with a slash or a question mark in it ends where the `@` is.
        let is_password = address[..at].split(['/', '?', '#']).next().is_some_and(|start| {
            start.split_once(':').is_some_and(|(_, port)| !port.is_empty() && port.parse::<u16>().is_err())
        });
        if is_password {
            hide(from, from + at);
        }
    }
    let Some(query) = address.find(['?', '#']) else { return };
    let mut place = from + query + 1;
    for parameter in address[query + 1..].split(['&', ';', '#', '?']) {
        if let Some((name, value)) = parameter.split_once('=') {
            let name = name.to_ascii_lowercase();
            if SECRET_PARAMETERS.iter().any(|part| name.contains(part)) {
                hide(place + parameter.len() - value.len(), place + parameter.len());
            }
        }
        place += parameter.len() + 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn secrets_of_addresses_and_headers_are_hidden_and_all_else_stays() {
        for (text, shown) in [
            ("no connection to ws://me:pa55@host:80/x: refused", "no connection to ws://*******@host:80/x: refused"),
            ("`http://token@host/v1`", "`http://*****@host/v1`"),
            ("http://h/v1?model=a&api_key=abc&x=1", "http://h/v1?model=a&api_key=***&x=1"),
            ("https://h?X-Amz-Signature=12ab#access_token=cd", "https://h?X-Amz-Signature=****#access_token=**"),
            ("s3://KEY:se/cr+et@bucket/prefix", "s3://************@bucket/prefix"),
            ("Authorization: Bearer sk-12345678, and so on", "Authorization: Bearer ***********, and so on"),
            ("api-key 0123456789", "api-key **********"),
            ("ü://ä:ö@ü é", "ü://***@ü é"),
        ] {
            assert_eq!(without_secrets(text), shown);
            assert!(has_secret(text));
        }
        for text in [
            "ws://127.0.0.1:8000",
            "Authorization: Api-Key KEY",
            "mail me@host, see http://host:80/a@b?size=3",
            "a basic fault of this kind",
            "://",
            "",
        ] {
            assert_eq!(without_secrets(text), text);
        }
    }
}
