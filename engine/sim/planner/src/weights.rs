//! Weight presets, and the macro that turns the one list of cost terms into everything that names them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A named set of weights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Preset {
    /// Visibility first, at a calm pace: a restless flight must show much more. Its future follows from its past.
    #[default]
    Cosfly,
    /// Visibility at any pace: dashes round obstacles, hard to learn from.
    Agile,
    /// `cosfly`, but behind the walker wherever that costs little visibility.
    Rear,
    /// `cosfly`, but with short flights: moving costs more.
    Short,
    /// The paper's weights (appendix B) and its own pipeline.
    Paper,
}

impl Preset {
    /// Factor on the cost of motion in the global search.
    pub fn motion_factor(self) -> f64 {
        match self {
            Self::Agile | Self::Paper => 1.0,
            Self::Cosfly | Self::Rear => 2.0,
            Self::Short => 16.0,
        }
    }

    /// Whether smoothing to the limits flattens a flight beyond what they ask.
    pub fn is_calm(self) -> bool {
        !matches!(self, Self::Agile | Self::Paper)
    }
}

/// From the one list of cost terms (in `terms/mod.rs`): weights, their overrides in recipes, and the terms themselves.
macro_rules! cost_terms {
    (@first $first:literal $($rest:literal)*) => { $first };
    ($($(#[$doc:meta])* $name:ident: $term:expr, cosfly $cosfly:literal, paper $paper:literal $(, rear $rear:literal)? $(, agile $agile:literal)?;)*) => {
        /// Weights that replace those of the preset; what is left out keeps the preset's value.
        #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
        #[serde(default, deny_unknown_fields)]
        pub struct WeightOverrides {$(
            $(#[$doc])*
            #[schemars(range(min = 0.0, max = 1_000_000.0))]
            pub $name: Option<f64>,
        )*}

        /// The weights in force, one per term.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct Weights {$(
            $(#[$doc])*
            pub $name: f64,
        )*}

        impl Weights {
            /// The preset's weights with the overrides in their place.
            pub fn resolve(preset: Preset, overrides: &WeightOverrides) -> Self {
                Self {$(
                    $name: overrides.$name.unwrap_or(match preset {
                        Preset::Cosfly | Preset::Short => $cosfly,
                        Preset::Rear => crate::weights::cost_terms!(@first $($rear)? $cosfly),
                        Preset::Agile => crate::weights::cost_terms!(@first $($agile)? $cosfly),
                        Preset::Paper => $paper,
                    }),
                )*}
            }

            /// (name, weight) of every term, in the order of the list.
            pub fn named(&self) -> Vec<(&'static str, f64)> {
                vec![$((stringify!($name), self.$name)),*]
            }
        }

        impl From<Weights> for WeightOverrides {
            fn from(weights: Weights) -> Self {
                Self { $($name: Some(weights.$name)),* }
            }
        }

        /// The built-in terms with their weights, in the order of the list.
        pub fn built_in_terms(weights: &Weights) -> Vec<WeightedTerm> {
            vec![$(WeightedTerm { term: Box::new($term), weight: weights.$name }),*]
        }
    };
}
pub(crate) use cost_terms;
