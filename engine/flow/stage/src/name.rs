//! Identity of stages and items. Names are built here, compared as values and stored as structure; the text of an item's name
//! is never split.

use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::borrow::Cow;
use std::cell::RefCell;
use std::fmt;
use std::sync::Arc;

/// Most names of stages that a thread remembers while it reads documents.
const MOST_REMEMBERED: usize = 64;

/// Name of a stage of a recipe, such as `walkers`, or of one part of it, such as `dataset.logs`.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct StageName {
    text: Arc<str>,
    /// Number of bytes of `text` that are the stage's name in the recipe.
    recipe_bytes: usize,
}

/// Name of an item among the items of a stage, as text:
///
/// * `all` or `p00003`, the name in the stage where the item begins,
/// * `expert-p00003` at a port that names items after their stages,
/// * `expert-p00003-HardRainNoon` for a variant of it.
///
/// Clones share their memory. Documents hold the structure, such as `{"of":["expert",{"numbered":["p",3]}]}`.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(transparent)]
pub struct ItemName(Form);

#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
enum Form {
    #[serde(rename = "own")]
    Own(Arc<str>),
    #[serde(rename = "numbered")]
    Numbered(Arc<str>, u64),
    #[serde(rename = "of")]
    OfStage(Arc<(StageName, ItemName)>),
    #[serde(rename = "variant")]
    Variant(Arc<(ItemName, Arc<str>)>),
}

/// Identity of an item in a recipe, `expert/p00003` as text.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ItemId {
    /// Stage that makes the item.
    pub stage: StageName,
    /// Name among the items of that stage.
    pub item: ItemName,
}

impl StageName {
    /// Name of the part `part` of the recipe's stage `recipe_name`; an empty part is the stage itself.
    pub fn new(recipe_name: &str, part: &str) -> Self {
        let text = if part.is_empty() { recipe_name.into() } else { format!("{recipe_name}.{part}").into() };
        Self { text, recipe_bytes: recipe_name.len() }
    }

    /// Parses a name from a stored document. Names in recipes have no dot. A document has hundreds of thousands of names of a
    /// few stages: equal ones share their memory.
    pub fn read(text: &str) -> Self {
        thread_local! {
            static REMEMBERED: RefCell<Vec<StageName>> = const { RefCell::new(Vec::new()) };
        }
        REMEMBERED.with_borrow_mut(|remembered| {
            if let Some(name) = remembered.iter().find(|name| name.as_str() == text) {
                return name.clone();
            }
            let name = Self { text: text.into(), recipe_bytes: text.find('.').unwrap_or(text.len()) };
            remembered.truncate(MOST_REMEMBERED - 1);
            remembered.push(name.clone());
            name
        })
    }

    /// The whole name.
    pub fn as_str(&self) -> &str {
        &self.text
    }

    /// Name of the stage in the recipe, without the part.
    pub fn recipe_name(&self) -> &str {
        &self.text[..self.recipe_bytes]
    }

    /// Name of the part; empty for the stage itself.
    pub fn part(&self) -> &str {
        self.text.get(self.recipe_bytes + 1..).unwrap_or_default()
    }
}

impl ItemName {
    /// Name of the only item of a stage: `all`.
    pub fn only() -> Self {
        Self::own("all")
    }

    /// Name of item number `number` of a stage that counts its items: `<prefix>00003`.
    pub fn numbered(prefix: &str, number: u64) -> Self {
        Self(Form::Numbered(prefix.into(), number))
    }

    /// Name of an item in the stage where it begins, from its text.
    pub fn own(text: impl Into<Arc<str>>) -> Self {
        Self(Form::Own(text.into()))
    }

    /// Number of an item of a stage that counts its items (see [`Self::numbered`]).
    pub fn number(&self) -> Option<u64> {
        match &self.0 {
            Form::Own(_) => None,
            Form::Numbered(_, number) => Some(*number),
            Form::OfStage(named) => named.1.number(),
            Form::Variant(variant) => variant.0.number(),
        }
    }

    /// Name of this item of `stage` at a port that names items after their stages.
    pub fn of_stage(&self, stage: &StageName) -> Self {
        Self(Form::OfStage(Arc::new((stage.clone(), self.clone()))))
    }

    /// Name of the variant `variant` of this item.
    pub fn with_variant(&self, variant: impl Into<Arc<str>>) -> Self {
        Self(Form::Variant(Arc::new((self.clone(), variant.into()))))
    }

    /// Stage that the item is named after; the last one where there are several.
    pub fn stage(&self) -> Option<&StageName> {
        match &self.0 {
            Form::Own(_) | Form::Numbered(..) => None,
            Form::OfStage(named) => Some(&named.0),
            Form::Variant(variant) => variant.0.stage(),
        }
    }

    /// Variant of the item; the last one where there are several.
    pub fn variant(&self) -> Option<&str> {
        match &self.0 {
            Form::Own(_) | Form::Numbered(..) => None,
            Form::OfStage(named) => named.1.variant(),
            Form::Variant(variant) => Some(&variant.1),
        }
    }

    /// Names of the stages that the item is named after, the last one first, and its name in the stage where it began,
    /// without variants.
    pub fn origin(&self) -> (Vec<&str>, Self) {
        let (mut stages, mut form) = (vec![], self);
        loop {
            match &form.0 {
                Form::Own(_) | Form::Numbered(..) => return (stages, form.clone()),
                Form::OfStage(named) => {
                    stages.push(named.0.as_str());
                    form = &named.1;
                }
                Form::Variant(variant) => form = &variant.0,
            }
        }
    }

    /// Name of the item that this one is a variant of, without its last variant.
    pub fn without_variant(&self) -> Option<Self> {
        match &self.0 {
            Form::Own(_) | Form::Numbered(..) => None,
            Form::OfStage(named) => Some(named.1.without_variant()?.of_stage(&named.0)),
            Form::Variant(variant) => Some(variant.0.clone()),
        }
    }
}

impl fmt::Display for StageName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&self.text)
    }
}

impl fmt::Display for ItemName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.0 {
            Form::Own(text) => f.write_str(text),
            Form::Numbered(prefix, number) => write!(f, "{prefix}{number:05}"),
            Form::OfStage(named) => write!(f, "{}-{}", named.0, named.1),
            Form::Variant(variant) => write!(f, "{}-{}", variant.0, variant.1),
        }
    }
}

impl fmt::Display for ItemId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.stage, self.item)
    }
}

impl fmt::Debug for StageName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}", &*self.text)
    }
}

impl fmt::Debug for ItemName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{self}`")
    }
}

impl fmt::Debug for ItemId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{self}`")
    }
}

impl Serialize for StageName {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.text)
    }
}

impl<'de> Deserialize<'de> for StageName {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Cow::<'de, str>::deserialize(deserializer).map(|text| Self::read(&text))
    }
}

impl PartialEq<str> for StageName {
    fn eq(&self, text: &str) -> bool {
        &*self.text == text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_show_how_an_item_came_about() {
        let (expert, extras) = (StageName::new("expert", ""), StageName::new("extras", ""));
        let walker = ItemName::numbered("p", 3);
        let seen = walker.of_stage(&expert).with_variant("HardRainNoon");
        let gathered = seen.of_stage(&extras);
        assert_eq!(seen.to_string(), "expert-p00003-HardRainNoon");
        assert_eq!(gathered.to_string(), "extras-expert-p00003-HardRainNoon");
        assert_eq!((seen.stage(), gathered.stage(), walker.stage()), (Some(&expert), Some(&extras), None));
        assert_eq!((gathered.variant(), walker.variant()), (Some("HardRainNoon"), None));
        assert_eq!(seen.without_variant(), Some(walker.of_stage(&expert)));
        assert_eq!(gathered.without_variant().unwrap().to_string(), "extras-expert-p00003");
        assert_eq!(walker.of_stage(&expert).without_variant(), None);
        assert_eq!(ItemId { stage: expert, item: walker }.to_string(), "expert/p00003");
    }

    #[test]
    fn names_are_stored_as_structure() {
        let seen = ItemName::numbered("p", 3).of_stage(&StageName::new("expert", "")).with_variant("Noon");
        let id = ItemId { stage: StageName::new("dataset", "logs"), item: seen };
        let text = serde_json::to_string(&id).expect("JSON");
        let stored = r#"{"variant":[{"of":["expert",{"numbered":["p",3]}]},"Noon"]}"#;
        assert_eq!(text, format!(r#"{{"stage":"dataset.logs","item":{stored}}}"#));
        assert_eq!(serde_json::from_str::<ItemId>(&text).expect("an id"), id);
        let only = serde_json::to_string(&ItemName::only()).expect("JSON");
        assert_eq!((only.as_str(), serde_json::from_str(&only).ok()), (r#"{"own":"all"}"#, Some(ItemName::only())));
    }

    #[test]
    fn parts_of_stages_are_told_from_the_stage_itself() {
        let (whole, part) = (StageName::new("dataset", ""), StageName::new("dataset", "logs"));
        assert_eq!((part.as_str(), part.recipe_name(), part.part()), ("dataset.logs", "dataset", "logs"));
        assert_eq!((whole.as_str(), whole.recipe_name(), whole.part()), ("dataset", "dataset", ""));
        assert_eq!([StageName::read("dataset.logs"), StageName::read("dataset")], [part, whole]);
    }
}
