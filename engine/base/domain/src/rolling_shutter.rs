//! Rolling shutter: rows that are exposed one after the other, in strips that share a moment.

use crate::{Camera, Lens};
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

/// Strips of a picture as its finished pixels have them: what readers of a picture need to know when a row was taken.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadoutStrips {
    /// Lower edge of each strip, rows of the picture without its lens, 0 at the upper edge of the finished one.
    pub ends_px: Vec<f64>,
    /// Moment of each strip, seconds from the frame's time.
    pub offsets_s: Vec<f64>,
}

impl ReadoutStrips {
    /// All rows at the frame's time.
    pub fn at_once() -> Self {
        Self { ends_px: vec![f64::INFINITY], offsets_s: vec![0.0] }
    }

    /// The strips of a camera with a lens that is not wide.
    pub fn of(rolling: &RollingShutter, camera: &Camera, lens: &Lens) -> Self {
        let [_, margin] = lens.margins_px(camera);
        let strips = rolling.strips((camera.height + 2 * margin) as usize);
        let (ends_px, offsets_s) =
            strips.map(|(rows, offset_s)| (rows.end as f64 - f64::from(margin), offset_s)).unzip();
        Self { ends_px, offsets_s }
    }

    /// The strip that takes a row of the picture without its lens; the nearest one beyond its ends.
    pub fn strip_at(&self, v: f64) -> usize {
        self.ends_px.partition_point(|end| *end <= v).min(self.ends_px.len().saturating_sub(1))
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

    #[test]
    fn a_lens_adds_rows_before_and_after_the_finished_ones() {
        let rolling = RollingShutter { readout_s: 0.03, strips: 4 };
        let camera = Camera { width: 64, height: 48, horizontal_fov_rad: 1.5 };
        let plain = ReadoutStrips::of(&rolling, &camera, &Lens::default());
        assert_eq!(plain.ends_px, [12.0, 24.0, 36.0, 48.0]);
        assert_eq!([-1.0, 0.0, 11.9, 12.0, 60.0].map(|v| plain.strip_at(v)), [0, 0, 0, 1, 3]);
        let bent = ReadoutStrips::of(&rolling, &camera, &Lens::brown(-0.2, 0.0));
        let beyond = bent.ends_px[3] - 48.0;
        assert!(beyond > 0.0 && bent.offsets_s.iter().sum::<f64>().abs() < 1e-12);
        assert_eq!(ReadoutStrips::at_once().strip_at(30.0), 0);
    }
}
