//! Weights of the nine cost terms: two presets and single overrides.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A named set of weights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Preset {
    /// Visibility first: an unseen target costs more than any viewpoint.
    #[default]
    Cosfly,
    /// The paper's weights (appendix B).
    Paper,
}

macro_rules! weights {
    ($($(#[$doc:meta])* $name:ident: cosfly $cosfly:literal, paper $paper:literal;)*) => {
        /// Weights that replace those of the preset; what is left out keeps the preset's value.
        #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
        #[serde(default, deny_unknown_fields)]
        pub struct WeightOverrides {$(
            $(#[$doc])*
            #[schemars(range(min = 0.0))]
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
                        Preset::Cosfly => $cosfly,
                        Preset::Paper => $paper,
                    }),
                )*}
            }

            /// (name, weight) of every term, in the order of the paper's equation.
            pub fn named(&self) -> Vec<(&'static str, f64)> {
                vec![$((stringify!($name), self.$name)),*]
            }
        }
    };
}

weights! {
    /// Distance from the best observation distance (lambda 1); cosfly 0.05, paper 1.
    tracking: cosfly 0.05, paper 1.0;
    /// Acceleration (lambda 2); 0.5 in both.
    smoothness: cosfly 0.5, paper 0.5;
    /// Jerk (lambda 3); 0.3 in both.
    jerk: cosfly 0.3, paper 0.3;
    /// Nearness of obstacles (lambda 4); 2 in both.
    safety: cosfly 2.0, paper 2.0;
    /// Hidden body points (lambda 5); cosfly 60, paper 3.
    visibility: cosfly 60.0, paper 3.0;
    /// Not being behind the walker (lambda 6); cosfly 0.3, paper 1.
    viewpoint: cosfly 0.3, paper 1.0;
    /// Pitch away from the target pitch (lambda 7); cosfly 0.1, paper 0.5.
    pitch: cosfly 0.1, paper 0.5;
    /// Altitude out of its band, and its oscillation (lambda 8); 1 in both.
    altitude: cosfly 1.0, paper 1.0;
    /// Length of the flight (lambda 9); 0.1 in both.
    length: cosfly 0.1, paper 0.1;
}
