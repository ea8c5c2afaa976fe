//! [`Blobs`]: the blobs of one item by name.

use cosfly_blobs::BlobRef;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::collections::BTreeMap;
use std::ops::Index;

/// Blobs of one item by name, sorted. A run holds those of every item: a list takes the room of its entries, a tree map
/// eleven times that for an item of one blob.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Blobs(Box<[(String, BlobRef)]>);

impl Blobs {
    /// The blob called `name`.
    pub fn get(&self, name: &str) -> Option<&BlobRef> {
        self.0.binary_search_by(|(known, _)| known.as_str().cmp(name)).ok().map(|at| &self.0[at].1)
    }

    /// Whether there is a blob called `name`.
    pub fn contains_key(&self, name: &str) -> bool {
        self.get(name).is_some()
    }

    /// Names and blobs, by name.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (&String, &BlobRef)> {
        self.0.iter().map(|(name, blob)| (name, blob))
    }

    /// Names, in order.
    pub fn keys(&self) -> impl ExactSizeIterator<Item = &String> {
        self.0.iter().map(|(name, _)| name)
    }

    /// Blobs, by name.
    pub fn values(&self) -> impl ExactSizeIterator<Item = &BlobRef> {
        self.0.iter().map(|(_, blob)| blob)
    }

    /// Number of blobs.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether there is no blob.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

impl Index<&str> for Blobs {
    type Output = BlobRef;

    fn index(&self, name: &str) -> &BlobRef {
        self.get(name).unwrap_or_else(|| panic!("there is no blob `{name}`"))
    }
}

impl From<BTreeMap<String, BlobRef>> for Blobs {
    fn from(blobs: BTreeMap<String, BlobRef>) -> Self {
        Self(blobs.into_iter().collect())
    }
}

impl<const N: usize> From<[(String, BlobRef); N]> for Blobs {
    fn from(blobs: [(String, BlobRef); N]) -> Self {
        blobs.into_iter().collect()
    }
}

impl FromIterator<(String, BlobRef)> for Blobs {
    /// The last one of several blobs of one name stays.
    fn from_iter<T: IntoIterator<Item = (String, BlobRef)>>(blobs: T) -> Self {
        BTreeMap::from_iter(blobs).into()
    }
}

impl<'b> IntoIterator for &'b Blobs {
    type Item = (&'b String, &'b BlobRef);
    type IntoIter =
        std::iter::Map<std::slice::Iter<'b, (String, BlobRef)>, fn(&(String, BlobRef)) -> (&String, &BlobRef)>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.iter().map(|(name, blob)| (name, blob))
    }
}

impl IntoIterator for Blobs {
    type Item = (String, BlobRef);
    type IntoIter = std::vec::IntoIter<(String, BlobRef)>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.into_vec().into_iter()
    }
}

impl Serialize for Blobs {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self)
    }
}

impl<'de> Deserialize<'de> for Blobs {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        BTreeMap::deserialize(deserializer).map(Self::from)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_fingerprint::Digest;

    #[test]
    fn blobs_are_those_of_a_map() {
        let blob = |text: &str| BlobRef { digest: Digest::of(text.as_bytes()), bytes: text.len() as u64 };
        let map: BTreeMap<String, BlobRef> =
            ["mcap", "index", "a/b"].map(|name| (name.to_owned(), blob(name))).into_iter().collect();
        let blobs = Blobs::from(map.clone());
        assert!(blobs.iter().eq(map.iter()) && blobs.keys().eq(map.keys()) && blobs.values().eq(map.values()));
        assert_eq!(blobs.get("index"), map.get("index"));
        assert_eq!((blobs.get("inde"), blobs.contains_key("mcap"), blobs["a/b"]), (None, true, map["a/b"]));
        let text = serde_json::to_string(&map).expect("JSON");
        assert_eq!(serde_json::to_string(&blobs).expect("JSON"), text);
        assert_eq!(serde_json::from_str::<Blobs>(&text).expect("blobs"), blobs);
        let twice: Blobs =
            [("x", "one"), ("x", "two")].map(|(name, text)| (name.to_owned(), blob(text))).into_iter().collect();
        assert_eq!((twice.len(), twice["x"]), (1, blob("two")));
    }
}
