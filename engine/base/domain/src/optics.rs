//! [`Optics`]: what lens, sensor and image processor of a camera make of light.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Numbers of one camera's way from light to colours; its noise is [`super::Noise`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Optics {
    /// Standard deviation of the blur of lens and sensor, pixels; 0: none.
    pub point_spread_px: f64,
    /// Strength of the image processor's sharpening; 0: none, 1: contrast between neighbours about doubled.
    pub sharpening: f64,
    /// Steepness of the image processor's tone curve beyond the film curve; 0: as is, 1: a full S.
    pub contrast: f64,
    /// Exposure beyond the one that suits the weather, in stops: 1 doubles the light.
    pub exposure_ev: f64,
    /// Colour temperature that is rendered as white, kelvin; below 6500 pictures are bluer, above they are redder.
    pub white_balance_k: f64,
    /// Strength of the glow around bright lamps at night; 0: none.
    pub bloom: f64,
}

impl Optics {
    /// A pinhole without lens, sensor and image processor.
    pub const IDEAL: Self = Self {
        point_spread_px: 0.0,
        sharpening: 0.0,
        contrast: 0.0,
        exposure_ev: 0.0,
        white_balance_k: 6500.0,
        bloom: 0.0,
    };
}
