//! Encoding of models as blobs: one header line with kind and format version, then postcard.

use cosfly_diagnose::{Diagnostic, Fault, Result};
use serde::{Serialize, de::DeserializeOwned};

/// `value` as a blob of `artifact`, such as `town/1`.
pub fn encode<T: Serialize>(artifact: &str, value: &T) -> Result<Vec<u8>> {
    let mut bytes = format!("cosfly {artifact}\n").into_bytes();
    let body = postcard::to_stdvec(value).map_err(|error| {
        Diagnostic::new("artifact-encode", Fault::Bug, format!("could not encode a `{artifact}`")).because(error)
    })?;
    bytes.extend_from_slice(&body);
    Ok(bytes)
}

/// Value in a blob of `artifact`; another kind or format version is refused by name.
pub fn decode<T: DeserializeOwned>(artifact: &str, bytes: &[u8]) -> Result<T> {
    let header = format!("cosfly {artifact}\n");
    let Some(body) = bytes.strip_prefix(header.as_bytes()) else {
        let found: Vec<u8> = bytes.iter().copied().take(40).take_while(|byte| *byte != b'\n').collect();
        return Err(Diagnostic::new(
            "artifact-kind",
            Fault::Input,
            format!("expected a `{artifact}` blob but found `{}`", String::from_utf8_lossy(&found)),
        )
        .hint("it was written by another version of cosfly: run with a fresh `--store`"));
    };
    postcard::from_bytes(body).map_err(|error| {
        Diagnostic::new("artifact-decode", Fault::Input, format!("could not decode a `{artifact}` blob")).because(error)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_kind_is_refused_by_name() {
        let bytes = encode("track/1", &vec![1.5f64]).unwrap();
        assert_eq!(decode::<Vec<f64>>("track/1", &bytes).unwrap(), [1.5]);
        assert!(decode::<Vec<f64>>("track/2", &bytes).unwrap_err().message.contains("found `cosfly track/1`"));
    }
}
