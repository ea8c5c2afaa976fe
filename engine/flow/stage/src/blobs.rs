//! [`Blobs`]: the blobs of one item by name.

use cosfly_blobs::BlobRef;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::iter::Zip;
use std::ops::Index;
use std::slice;
use std::sync::{Arc, Mutex, PoisonError};

/// Most names of a list that items share; longer lists, such as the files of a dataset, are of one item only.
const MOST_SHARED_NAMES: usize = 16;
/// Most lists of names that are kept for sharing: one for each kind of item, and a few for rare ones.
const MOST_SHARED_LISTS: usize = 4096;

/// Blobs of one item by name, sorted. A run holds those of every item: items of one stage share the list of names, so that
/// a blob takes the room of its digest and size.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Blobs {
    names: Arc<[String]>,
    blobs: Box<[BlobRef]>,
}

impl Blobs {
    /// Blobs and their names, in order; `None` where the names are not in order.
    pub fn in_order(names: &[&str], blobs: Vec<BlobRef>) -> Option<Self> {
        let is_sound = names.len() == blobs.len() && names.windows(2).all(|pair| pair[0] < pair[1]);
        is_sound.then(|| Self { names: recent(names), blobs: blobs.into() })
    }

    /// The blob called `name`.
    pub fn get(&self, name: &str) -> Option<&BlobRef> {
        self.names.binary_search_by(|known| known.as_str().cmp(name)).ok().map(|at| &self.blobs[at])
    }

    /// Whether there is a blob called `name`.
    pub fn contains_key(&self, name: &str) -> bool {
        self.get(name).is_some()
    }

    /// Names and blobs, by name.
    pub fn iter(&self) -> Entries<'_> {
        self.names.iter().zip(&self.blobs)
    }

    /// Names, in order.
    pub fn keys(&self) -> impl ExactSizeIterator<Item = &String> {
        self.names.iter()
    }

    /// Blobs, by name.
    pub fn values(&self) -> impl ExactSizeIterator<Item = &BlobRef> {
        self.blobs.iter()
    }

    /// Number of blobs.
    pub fn len(&self) -> usize {
        self.blobs.len()
    }

    /// Whether there is no blob.
    pub fn is_empty(&self) -> bool {
        self.blobs.is_empty()
    }
}

/// Names and blobs of an item.
pub type Entries<'b> = Zip<slice::Iter<'b, String>, slice::Iter<'b, BlobRef>>;

/// The list of names, in the memory of an equal one where there is one.
fn shared(names: Vec<String>) -> Arc<[String]> {
    static LISTS: Mutex<BTreeSet<Arc<[String]>>> = Mutex::new(BTreeSet::new());
    if names.len() > MOST_SHARED_NAMES {
        return names.into();
    }
    let mut lists = LISTS.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = lists.get(names.as_slice()) {
        return Arc::clone(known);
    }
    let names: Arc<[String]> = names.into();
    if lists.len() < MOST_SHARED_LISTS {
        lists.insert(Arc::clone(&names));
    }
    names
}

/// Lists of names that a thread remembers.
const MOST_RECENT: usize = 8;

/// List as of [`shared`], without a copy of the names where this thread had the same list not long ago.
fn recent(names: &[&str]) -> Arc<[String]> {
    thread_local! {
        static RECENT: RefCell<Vec<Arc<[String]>>> = const { RefCell::new(Vec::new()) };
    }
    RECENT.with_borrow_mut(|lists| {
        if let Some(known) = lists.iter().find(|list| list.iter().eq(names)) {
            return Arc::clone(known);
        }
        let list = shared(names.iter().map(|name| (*name).to_owned()).collect());
        if names.len() <= MOST_SHARED_NAMES {
            lists.truncate(MOST_RECENT - 1);
            lists.insert(0, Arc::clone(&list));
        }
        list
    })
}

impl Default for Blobs {
    fn default() -> Self {
        Self { names: shared(vec![]), blobs: Box::default() }
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
        let (names, blobs): (Vec<String>, Vec<BlobRef>) = blobs.into_iter().unzip();
        Self { names: shared(names), blobs: blobs.into() }
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
    type IntoIter = Entries<'b>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
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
        let (names, refs): (Vec<&str>, Vec<BlobRef>) = map.iter().map(|(name, blob)| (name.as_str(), *blob)).unzip();
        let ordered = Blobs::in_order(&names, refs.clone()).expect("in order");
        assert!(ordered == blobs && Arc::ptr_eq(&ordered.names, &blobs.names));
        let reversed: Vec<&str> = names.iter().rev().copied().collect();
        assert!(Blobs::in_order(&reversed, refs.clone()).is_none() && Blobs::in_order(&names[1..], refs).is_none());
        let others: Blobs = map.keys().map(|name| (name.clone(), blob("other"))).collect();
        assert!(Arc::ptr_eq(&others.names, &blobs.names) && others != blobs);
        let twice: Blobs =
            [("x", "one"), ("x", "two")].map(|(name, text)| (name.to_owned(), blob(text))).into_iter().collect();
        assert_eq!((twice.len(), twice["x"]), (1, blob("two")));
    }
}
