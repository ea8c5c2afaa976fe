//! Losing the target on purpose.

use super::ranges::{Range, RangeRefusal, ordered};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Losing the target on purpose: whole frames in which no body point is seen.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct OcclusionConfig {
    /// Number of times that the target is to be lost. The certificate states the time ordered and reached. Default 0.
    #[schemars(range(min = 0, max = 100))]
    pub count: u32,
    /// Share of the flights that lose their target. Below 1, every flight is planned with its loss first, and the orders go to
    /// flights that succeeded, so that the share is filled; a shortfall is reported. Default 1: each flight tries.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub share: f64,
    /// Share of those flights that see the target again beside somebody in the same clothes, at most 15 m away; for walks of stage
    /// `traffic` and `share` below 1. Default 0.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub beside_look_alike: f64,
    /// Shortest loss, seconds. Default 2.
    #[schemars(range(min = 0.1, max = 60.0))]
    pub min_s: f64,
    /// Longest loss, seconds; half-way between the two is aimed at. Default 4.
    #[schemars(range(min = 0.1, max = 60.0))]
    pub max_s: f64,
}

impl Default for OcclusionConfig {
    fn default() -> Self {
        Self { count: 0, share: 1.0, beside_look_alike: 0.0, min_s: 2.0, max_s: 4.0 }
    }
}

impl OcclusionConfig {
    /// Parameters that no single flight depends on, only the order that it gets; not in its key.
    pub const NOT_IN_KEY: &[&str] = &["share", "beside_look_alike"];

    /// Whether losses are ordered in a share of the flights, or a share of the losses beside look-alikes.
    pub fn has_quota(&self) -> bool {
        self.count > 0 && (self.share < 1.0 || self.beside_look_alike > 0.0)
    }

    /// Rules without an order: those of a flight that keeps its target.
    #[must_use]
    pub fn without_losses(&self) -> Self {
        let Self { share, beside_look_alike, count, .. } = Self::default();
        Self { share, beside_look_alike, count, ..self.clone() }
    }

    pub(super) fn ranges(&self) -> [Range; 5] {
        [
            ("occlusion.count", f64::from(self.count), 0.0, 100.0),
            ("occlusion.share", self.share, 0.0, 1.0),
            ("occlusion.beside_look_alike", self.beside_look_alike, 0.0, 1.0),
            ("occlusion.min_s", self.min_s, 0.1, 60.0),
            ("occlusion.max_s", self.max_s, 0.1, 60.0),
        ]
    }

    pub(super) fn check_order(&self) -> Result<(), RangeRefusal> {
        for (path, value, default) in [
            ("occlusion.share", self.share, Self::default().share),
            ("occlusion.beside_look_alike", self.beside_look_alike, Self::default().beside_look_alike),
        ] {
            if self.count == 0 && value != default {
                let rule = "but `occlusion.count` is `0`, so that no flight loses its target; set it to `1` or more";
                return Err((path.to_owned(), format!("`{path}` is `{value}`, {rule}")));
            }
        }
        ordered(("occlusion.min_s", self.min_s), ("occlusion.max_s", self.max_s))
    }
}
