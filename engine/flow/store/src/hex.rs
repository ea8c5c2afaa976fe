//! Hex digits of digests, for files that name hundreds of thousands of them.

use cosfly_fingerprint::Digest;

const DIGITS: &[u8; 16] = b"0123456789abcdef";

/// Appends the 64 hex digits of a digest.
pub(crate) fn push_digest(text: &mut String, digest: &Digest) {
    let mut hex = [0; 64];
    for (pair, byte) in hex.as_chunks_mut::<2>().0.iter_mut().zip(digest.0) {
        *pair = [DIGITS[usize::from(byte >> 4)], DIGITS[usize::from(byte & 15)]];
    }
    text.push_str(std::str::from_utf8(&hex).unwrap_or_default());
}

/// The digest of 64 hex digits in lower case; `None` for any other text.
pub(crate) fn digest_of_hex(text: &str) -> Option<Digest> {
    let (pairs, rest) = text.as_bytes().as_chunks::<2>();
    let mut digest = Digest([0; 32]);
    if pairs.len() != digest.0.len() || !rest.is_empty() {
        return None;
    }
    for (byte, [high, low]) in digest.0.iter_mut().zip(pairs) {
        *byte = value(*high)? << 4 | value(*low)?;
    }
    Some(digest)
}

fn value(digit: u8) -> Option<u8> {
    match digit {
        b'0'..=b'9' => Some(digit - b'0'),
        b'a'..=b'f' => Some(digit - b'a' + 10),
        _ => None,
    }
}

/// Appends a value as a JSON string. Names are almost always plain.
pub(crate) fn push_quoted(text: &mut String, name: &str) {
    let is_plain = |byte| (b' '..0x7f).contains(&byte) && byte != b'"' && byte != b'\\';
    if name.bytes().all(is_plain) {
        text.push('"');
        text.push_str(name);
        text.push('"');
    } else {
        text.push_str(&serde_json::Value::from(name).to_string());
    }
}

/// The text of a JSON string; `None` for anything else.
pub(crate) fn unquoted(json: &str) -> Option<String> {
    let inner = json.strip_prefix('"').and_then(|rest| rest.strip_suffix('"'));
    let is_plain = |byte| (b' '..0x7f).contains(&byte) && byte != b'"' && byte != b'\\';
    match inner.filter(|inner| inner.bytes().all(is_plain)) {
        Some(plain) => Some(plain.to_owned()),
        None => serde_json::from_str(json).ok(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digests_read_back_and_other_texts_are_refused() {
        let digest = Digest::of(b"x");
        let mut text = String::new();
        push_digest(&mut text, &digest);
        assert_eq!(text, digest.to_string());
        assert_eq!(digest_of_hex(&text), Some(digest));
        for wrong in ["", "0", &text[1..], &format!("{text}0"), &text.to_uppercase(), &"g".repeat(64), &"é".repeat(32)]
        {
            assert_eq!(digest_of_hex(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn quoted_names_are_json_and_read_back() {
        for name in ["", "data/a-1.parquet", "a \"b\"", "\\", "é\n", "\u{7f}"] {
            let mut text = String::new();
            push_quoted(&mut text, name);
            assert_eq!(text, serde_json::Value::from(name).to_string());
            assert_eq!(unquoted(&text).as_deref(), Some(name));
        }
        for wrong in ["", "\"", "x", "\"\"\"", "\"\\\"", "1"] {
            assert_eq!(unquoted(wrong), None, "{wrong}");
        }
    }
}
