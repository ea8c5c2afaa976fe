//! [`MotionBlur`]: light of several moments while the shutter is open.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Blur of colour by motion while the shutter is open; depth and ids are those of its middle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct MotionBlur {
    /// Exposure time around a frame's time, seconds; 0: no blur.
    #[schemars(range(min = 0, max = 0.5))]
    pub shutter_s: f64,
    /// Pictures that a frame is the mean of; each costs a rendering. One of them is the middle: an even number
    /// counts as the next odd one.
    #[schemars(range(min = 3, max = 65))]
    pub samples: u32,
}

impl Default for MotionBlur {
    fn default() -> Self {
        Self { shutter_s: 0.0, samples: 9 }
    }
}

impl MotionBlur {
    /// Whether it blurs nothing.
    pub fn is_none(&self) -> bool {
        self.shutter_s == 0.0
    }

    /// Times of all pictures but the middle one, seconds from the middle of the shutter: evenly spaced.
    pub fn offsets_s(&self) -> impl Iterator<Item = f64> {
        let Self { shutter_s, samples } = *self;
        let count = if self.is_none() { 0 } else { samples | 1 };
        let offset = move |number: u32| shutter_s * ((f64::from(number) + 0.5) / f64::from(count) - 0.5);
        (0..count).filter(move |number| *number != count / 2).map(offset)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_lie_evenly_around_the_middle() {
        let blur = MotionBlur { shutter_s: 0.05, samples: 4 };
        let offsets: Vec<f64> = blur.offsets_s().collect();
        assert_eq!(offsets.len(), 4);
        assert!(offsets.iter().sum::<f64>().abs() < 1e-15 && (offsets[0] + 0.02).abs() < 1e-15);
        assert_eq!(MotionBlur::default().offsets_s().count(), 0);
    }
}
