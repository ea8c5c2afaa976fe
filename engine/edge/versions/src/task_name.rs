//! Name of a task in a manifest.

use cosfly_stage::{ItemId, StageName};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};
use std::borrow::Cow;
use std::cell::RefCell;
use std::cmp::Ordering;
use std::fmt;

/// Most names of stages that are kept for sharing.
const MOST_SHARED: usize = 64;

/// Name of a task, `expert/p00003` as text. The item is known by its text only.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TaskName {
    /// Stage of the task.
    pub stage: StageName,
    /// Name of the item that the task makes.
    pub item: String,
}

impl From<&ItemId> for TaskName {
    fn from(id: &ItemId) -> Self {
        Self { stage: id.stage.clone(), item: id.item.to_string() }
    }
}

impl TaskName {
    fn bytes(&self) -> impl Iterator<Item = u8> {
        self.stage.as_str().bytes().chain([b'/']).chain(self.item.bytes())
    }
}

/// Orders by text, the order of tasks in manifests.
impl Ord for TaskName {
    fn cmp(&self, other: &Self) -> Ordering {
        self.bytes().cmp(other.bytes())
    }
}

impl PartialOrd for TaskName {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl fmt::Display for TaskName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.stage, self.item)
    }
}

impl Serialize for TaskName {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for TaskName {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = Cow::<'de, str>::deserialize(deserializer)?;
        match text.split_once('/') {
            Some((stage, item)) => Ok(Self { stage: shared(stage), item: item.to_owned() }),
            None => Err(D::Error::custom(format!("`{text}` does not name a task: it has no `/`"))),
        }
    }
}

/// The name of a stage, in the memory of the name that was read before: a manifest has hundreds of thousands of tasks of a few
/// stages.
fn shared(stage: &str) -> StageName {
    thread_local! {
        static KNOWN: RefCell<Vec<StageName>> = const { RefCell::new(Vec::new()) };
    }
    KNOWN.with_borrow_mut(|known| {
        if let Some(name) = known.iter().find(|name| name.as_str() == stage) {
            return name.clone();
        }
        if known.len() == MOST_SHARED {
            known.clear();
        }
        let name = StageName::read(stage);
        known.push(name.clone());
        name
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_reads_back_from_its_text() {
        let name = TaskName { stage: StageName::new("dataset", "logs"), item: "expert-p00003".to_owned() };
        let text = serde_json::to_string(&name).unwrap();
        assert_eq!(text, "\"dataset.logs/expert-p00003\"");
        assert_eq!(serde_json::from_str::<TaskName>(&text).unwrap(), name);
        assert!(serde_json::from_str::<TaskName>("\"dataset\"").is_err());
        let whole = TaskName { stage: StageName::new("dataset", ""), item: "all".to_owned() };
        assert!(name < whole, "as `dataset.logs/expert-p00003` and `dataset/all`");
    }
}
