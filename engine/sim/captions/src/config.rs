//! Parameters of captions.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Captions: which styles, how many wordings of each. Every caption is written in Chinese and in English.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct CaptionConfig {
    /// Different wordings per style and language. Default 2.
    #[schemars(range(min = 1, max = 6))]
    pub variants_per_style: u32,
    /// Name the target's clothes. Default true; set it to false where `target_stands_out` of the pictures is above 0, which
    /// dresses targets in other clothes than their walk's.
    pub clothes: bool,
    /// Writer of the texts. Default `template`.
    pub writer: Writer,
    /// Styles to write. Default `["instruction", "description"]`.
    #[schemars(length(min = 1, max = 2), extend("uniqueItems" = true))]
    pub styles: Vec<Style>,
}

impl Default for CaptionConfig {
    fn default() -> Self {
        Self { variants_per_style: 2, clothes: true, writer: Writer::Template, styles: Style::ALL.to_vec() }
    }
}

/// Writer of texts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Writer {
    /// Templates of cosfly.
    #[default]
    Template,
    /// A language model; key `teacher` says which.
    Teacher,
}

impl Writer {
    /// The name in recipes and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Template => "template",
            Self::Teacher => "teacher",
        }
    }
}

/// Kind of text.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Style {
    /// One sentence that tells the pilot what to do: whom to follow, at which distance and angle. It holds in every part of
    /// the flight.
    Instruction,
    /// Several sentences: the route with turns and stops, its length and time, and how the drone flies.
    Description,
}

impl Style {
    /// All styles.
    pub const ALL: [Self; 2] = [Self::Instruction, Self::Description];

    /// The name in recipes and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Instruction => "instruction",
            Self::Description => "description",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_schema_lists_the_styles() {
        let schema = serde_json::to_value(schemars::schema_for!(CaptionConfig)).unwrap();
        assert_eq!(schema["properties"]["styles"]["default"], serde_json::json!(["instruction", "description"]));
        assert_eq!(schema["properties"]["variants_per_style"]["maximum"], 6);
        for style in Style::ALL {
            assert_eq!(serde_json::to_value(style).unwrap(), style.name());
        }
    }
}
