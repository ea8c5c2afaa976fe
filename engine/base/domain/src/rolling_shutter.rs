//! Rolling shutter: rows that are exposed one after the other, in strips that share a moment.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// A sensor that is read from its top row to its bottom row while the camera moves on.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct RollingShutter {
    /// Time from the top row to the bottom row, seconds; the middle of the picture is taken at the frame's time. 0: all
    /// rows at once.
    #[schemars(range(min = 0, max = 0.5))]
    pub readout_s: f64,
    /// Strips of rows, each of one moment; each costs a rendering.
    #[schemars(range(min = 2, max = 256))]
    pub strips: u32,
}

impl Default for RollingShutter {
    fn default() -> Self {
        Self { readout_s: 0.0, strips: 16 }
    }
}

impl RollingShutter {
    /// Whether all rows are taken at once.
    pub fn is_none(&self) -> bool {
        self.readout_s == 0.0
    }

    /// The rows of each strip of a picture `height` rows high, and their moment: seconds from the frame's time.
    pub fn strips(&self, height: usize) -> impl Iterator<Item = (Range<usize>, f64)> + use<> {
        let readout_s = self.readout_s;
        let count = if self.is_none() { 1 } else { (self.strips as usize).clamp(1, height.max(1)) };
        (0..count).map(move |strip| {
            let rows = strip * height / count..(strip + 1) * height / count;
            let middle = 0.5 * (rows.start + rows.end) as f64 / height.max(1) as f64;
            (rows, readout_s * (middle - 0.5))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_cover_every_row_once_around_the_middle() {
        let rolling = RollingShutter { readout_s: 0.04, strips: 7 };
        for height in [1, 5, 48, 720] {
            let strips: Vec<_> = rolling.strips(height).collect();
            assert!(strips.iter().flat_map(|(rows, _)| rows.clone()).eq(0..height));
            assert!(strips.iter().map(|(_, offset_s)| offset_s).is_sorted());
            let weighted: f64 = strips.iter().map(|(rows, offset_s)| rows.len() as f64 * offset_s).sum();
            assert!(weighted.abs() < 1e-12 && strips.iter().all(|(_, offset_s)| offset_s.abs() < 0.02));
        }
        assert!(RollingShutter::default().strips(720).eq([(0..720, 0.0)]));
    }
}
