//! [`MapConfig`]: the parameters of a map in a recipe.

use crate::combine::FurtherSource;
use crate::fill::FillConfig;
use crate::streets::Streets;
use cosfly_town::FormatOptions;
use cosfly_town::simplify::SimplifyConfig;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;

/// Rules by which a map file becomes a town.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct MapConfig {
    /// The map file, relative to the recipe. Its content tells its format.
    pub source: String,
    /// Name of the town in all metadata and of its folder: letters, digits, `.`, `_`, `-`. Default: the file's name without its extension.
    pub name: Option<String>,
    /// Further map files, such as one with the houses beside these streets.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub more: Vec<FurtherSource>,
    /// The part of the town that is kept: smallest x, smallest y, largest x, largest y, metres, in the frame of the town, which
    /// `cosfly map inspect` shows. Houses that reach over its edge stay whole. Default: everything.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bounds_m: Option<[f64; 4]>,
    /// Streets of the town. Default: `invented` for CityJSON, else `file`. A town whose files have a street keeps to those.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub streets: Option<Streets>,
    /// Things to invent beside the streets of a town whose file has nothing there. None by default.
    pub fill: FillConfig,
    /// Merge, crop and prune of the boxes that the planner sees.
    pub simplify: SimplifyConfig,
    /// Options of the file's format.
    #[serde(skip_serializing_if = "FormatOptions::is_empty")]
    #[schemars(with = "BTreeMap<String, Value>")]
    pub options: FormatOptions,
}
