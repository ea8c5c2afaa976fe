//! Identity of stages and items. Names are built here and compared as values; their text is never split.

use std::fmt;
use std::sync::Arc;

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
/// Clones share their memory.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ItemName(Form);

#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
enum Form {
    Own(Arc<str>),
    OfStage(Arc<(StageName, ItemName)>),
    Variant(Arc<(ItemName, Arc<str>)>),
}

/// Identity of an item in a recipe, `expert/p00003` as text.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
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

    /// Parses a name from a stored document. Names in recipes have no dot.
    pub fn read(text: &str) -> Self {
        Self { text: text.into(), recipe_bytes: text.find('.').unwrap_or(text.len()) }
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
        Self::own(format!("{prefix}{number:05}"))
    }

    /// Name of an item in the stage where it begins, from its text.
    pub fn own(text: impl Into<Arc<str>>) -> Self {
        Self(Form::Own(text.into()))
    }

    /// Number of an item of a stage that counts its items (see [`Self::numbered`]).
    pub fn number(&self) -> Option<u64> {
        let text = self.origin().1;
        let digits = text.trim_start_matches(|letter: char| !letter.is_ascii_digit());
        digits.parse().ok()
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
            Form::Own(_) => None,
            Form::OfStage(named) => Some(&named.0),
            Form::Variant(variant) => variant.0.stage(),
        }
    }

    /// Variant of the item; the last one where there are several.
    pub fn variant(&self) -> Option<&str> {
        match &self.0 {
            Form::Own(_) => None,
            Form::OfStage(named) => named.1.variant(),
            Form::Variant(variant) => Some(&variant.1),
        }
    }

    /// Names of the stages that the item is named after, the last one first, and its name in the stage where it began,
    /// without variants.
    pub fn origin(&self) -> (Vec<&str>, &str) {
        let (mut stages, mut form) = (vec![], self);
        loop {
            match &form.0 {
                Form::Own(text) => return (stages, text),
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
            Form::Own(_) => None,
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
    fn parts_of_stages_are_told_from_the_stage_itself() {
        let (whole, part) = (StageName::new("dataset", ""), StageName::new("dataset", "logs"));
        assert_eq!((part.as_str(), part.recipe_name(), part.part()), ("dataset.logs", "dataset", "logs"));
        assert_eq!((whole.as_str(), whole.recipe_name(), whole.part()), ("dataset", "dataset", ""));
        assert_eq!([StageName::read("dataset.logs"), StageName::read("dataset")], [part, whole]);
    }
}
