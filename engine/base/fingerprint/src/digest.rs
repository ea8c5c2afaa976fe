//! [`Digest`]: BLAKE3 of bytes, and of values as canonical JSON.

use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error as _};
use std::fmt;
use std::str::FromStr;

/// A BLAKE3 digest, printed as 64 lower-case hex digits.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Digest(pub [u8; 32]);

impl Digest {
    /// Digest of `bytes`.
    pub fn of(bytes: &[u8]) -> Self {
        Self(*blake3::hash(bytes).as_bytes())
    }

    /// First twelve hex digits, for display.
    pub fn short(&self) -> String {
        let mut hex = self.to_string();
        hex.truncate(12);
        hex
    }
}

/// A digest of bytes that come piece by piece.
#[derive(Default)]
pub struct DigestOfPieces(blake3::Hasher);

impl DigestOfPieces {
    /// Appends bytes.
    pub fn add(&mut self, bytes: &[u8]) {
        self.0.update(bytes);
    }

    /// Digest of all bytes so far, as [`Digest::of`] has it of them together.
    pub fn digest(&self) -> Digest {
        Digest(*self.0.finalize().as_bytes())
    }
}

impl fmt::Display for Digest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(blake3::Hash::from_bytes(self.0).to_hex().as_str())
    }
}

impl fmt::Debug for Digest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.short())
    }
}

impl FromStr for Digest {
    type Err = blake3::HexError;

    fn from_str(hex: &str) -> Result<Self, Self::Err> {
        Ok(Self(*blake3::Hash::from_hex(hex)?.as_bytes()))
    }
}

impl Serialize for Digest {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for Digest {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let hex = std::borrow::Cow::<'de, str>::deserialize(deserializer)?;
        hex.parse().map_err(|_| D::Error::custom(format!("`{hex}` is not a digest of 64 hex digits")))
    }
}

/// Canonical JSON: sorted keys, no spaces. Equal values give equal bytes, whatever the order of keys in a file. Relies
/// on `serde_json::Value` keeping objects in a sorted map (the crate's default).
pub fn canonical_json<T: Serialize>(value: &T) -> String {
    let tree = serde_json::to_value(value).expect("configs and plan documents are plain JSON values");
    serde_json::to_string(&tree).expect("a JSON tree always prints")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn key_order_does_not_change_a_digest() {
        let a: serde_json::Value = serde_json::from_str(r#"{"b":1,"a":{"d":2.5,"c":[1,2]}}"#).unwrap();
        let b: serde_json::Value = serde_json::from_str(r#"{ "a":{"c":[1,2],"d":2.5},"b":1 }"#).unwrap();
        assert_eq!(canonical_json(&a), canonical_json(&b));
        assert_eq!(canonical_json(&a), r#"{"a":{"c":[1,2],"d":2.5},"b":1}"#);
    }

    #[test]
    fn pieces_have_the_digest_of_the_whole() {
        let mut pieces = DigestOfPieces::default();
        [&b"cos"[..], b"", b"fly"].iter().for_each(|piece| pieces.add(piece));
        assert_eq!(pieces.digest(), Digest::of(b"cosfly"));
    }

    #[test]
    fn digests_round_trip_through_text() {
        let digest = Digest::of(b"cosfly");
        assert_eq!(digest.to_string().parse::<Digest>().unwrap(), digest);
        assert_eq!(serde_json::from_str::<Digest>(&serde_json::to_string(&digest).unwrap()).unwrap(), digest);
    }
}
