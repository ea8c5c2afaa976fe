//! Parameters of models in a recipe.

use cosfly_domain::ObstacleKind;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A model for all things of a kind. Several models of one kind take turns by the things' own seeds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ModelConfig {
    /// Kind of the things that are drawn with the model.
    pub kind: ModelKind,
    /// Path of a GLB file, or of a glTF file with embedded data, relative to the recipe.
    pub source: String,
    /// Size of the model.
    #[serde(default)]
    pub fit: ModelFit,
    /// Turn of the model about the vertical before it is placed, degrees. Without a turn the model's front, +z in glTF, looks
    /// along the thing's own x axis.
    #[serde(default)]
    #[schemars(range(min = -360, max = 360))]
    pub turn_deg: f64,
}

/// Kinds of things that models can be drawn for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ModelKind {
    /// A parked car of the town.
    Car,
    /// A tree: trunk and crown.
    Tree,
    /// A bush or hedge.
    Bush,
    /// A street lamp.
    Lamp,
    /// A plain pole.
    Pole,
    /// A traffic light.
    TrafficLight,
    /// A traffic sign.
    TrafficSign,
    /// A bench, bin, stop, stall or box.
    Static,
}

impl ModelKind {
    /// Whether a thing with a part of `kind` is of this kind.
    pub fn has_part(self, kind: ObstacleKind) -> bool {
        match self {
            Self::Car => kind == ObstacleKind::Car,
            Self::Tree => matches!(kind, ObstacleKind::TreeCrown | ObstacleKind::TreeTrunk),
            Self::Bush => kind == ObstacleKind::Bush,
            Self::Lamp => kind == ObstacleKind::Lamp,
            Self::Pole => kind == ObstacleKind::Pole,
            Self::TrafficLight => kind == ObstacleKind::TrafficLight,
            Self::TrafficSign => kind == ObstacleKind::TrafficSign,
            Self::Static => matches!(kind, ObstacleKind::Static | ObstacleKind::Bench | ObstacleKind::Stall),
        }
    }
}

/// Size of a model beside the box around a thing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ModelFit {
    /// Length, width and height of the box: picture and box agree.
    #[default]
    Fill,
    /// The largest size at which the model keeps its shape and lies within the box, on its ground.
    Within,
}
