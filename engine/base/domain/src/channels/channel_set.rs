//! The channels of a rendering: a list of names in recipes and packs.

use super::{self as channels, Channel};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::borrow::Cow;

/// Channels in the order of [`channels::ALL`], each once.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ChannelSet(Vec<&'static Channel>);

impl ChannelSet {
    /// The channels that `is_chosen` takes.
    pub fn of(is_chosen: impl Fn(&Channel) -> bool) -> Self {
        Self(channels::ALL.iter().copied().filter(|channel| is_chosen(channel)).collect())
    }

    /// The channels but one.
    pub fn without(&self, left_out: &Channel) -> Self {
        Self::of(|channel| channel != left_out && self.contains(channel))
    }

    /// Whether these are the channels of every frame and no other.
    pub fn is_default(&self) -> bool {
        *self == Self::default()
    }

    /// The channels.
    pub fn iter(&self) -> impl Iterator<Item = &'static Channel> {
        self.0.iter().copied()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether a channel is among them.
    pub fn contains(&self, channel: &Channel) -> bool {
        self.iter().any(|own| own == channel)
    }

    /// The first channel of every frame that is not among them.
    pub fn missing(&self) -> Option<&'static Channel> {
        Self::default().iter().find(|channel| !self.contains(channel))
    }
}

impl Default for ChannelSet {
    /// The channels of every frame.
    fn default() -> Self {
        Self::of(|channel| !channel.is_on_request())
    }
}

impl Serialize for ChannelSet {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.iter().map(|channel| channel.name))
    }
}

impl<'de> Deserialize<'de> for ChannelSet {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let names = Vec::<String>::deserialize(deserializer)?;
        match names.iter().find(|name| channels::called(name).is_none()) {
            Some(unknown) => Err(serde::de::Error::custom(format!("there is no channel `{unknown}`"))),
            None => Ok(Self::of(|channel| names.iter().any(|name| name == channel.name))),
        }
    }
}

impl JsonSchema for ChannelSet {
    fn schema_name() -> Cow<'static, str> {
        "ChannelSet".into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let names: Vec<&str> = channels::ALL.iter().map(|channel| channel.name).collect();
        json_schema!({
            "type": "array",
            "items": { "type": "string", "enum": names },
            "default": Self::default(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_channels_in_the_order_of_the_list() {
        let names: Vec<&str> = channels::ALL.iter().rev().map(|channel| channel.name).collect();
        let set: ChannelSet = serde_json::from_value(serde_json::json!(names)).expect("all are listed");
        assert!(set.iter().eq(channels::ALL.iter().copied()) && set.missing().is_none() && !set.is_default());
        assert!(serde_json::from_str::<ChannelSet>("[\"rgb\", \"sound\"]").is_err());
        let few: ChannelSet = serde_json::from_str("[\"instance\", \"rgb\"]").expect("both are listed");
        assert_eq!(few.missing().map(|channel| channel.name), Some("depth"));
    }
}
