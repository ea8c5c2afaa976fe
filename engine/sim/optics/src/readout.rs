//! [`ReadoutStrips`]: when the rows of a picture were taken, told by its finished pixels.

use cosfly_domain::{Camera, Lens, RollingShutter};

/// Keys of the record `cosfly.camera` of logs with a rolling shutter, a list of numbers each: [`ReadoutStrips::ends_px`] and
/// [`ReadoutStrips::offsets_s`].
pub const READOUT_KEYS: [&str; 2] = ["readout_ends_px", "readout_offsets_s"];

/// Strips of rows that are taken together.
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
        let [_, margin] = margins_px(lens, camera);
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

/// Columns and rows by which the picture without its lens goes beyond each edge of the finished one, so that it has every place that a pixel
/// shows. A lens that is not wide.
pub fn margins_px(lens: &Lens, camera: &Camera) -> [u32; 2] {
    if lens.is_none() {
        return [0; 2];
    }
    let (cx, cy, _) = camera.centre_and_focal_px();
    let unbend = |(column, row): (u32, u32)| {
        let seen = (f64::from(column) + 0.5, f64::from(row) + 0.5);
        lens.unbend(camera, seen).unwrap_or(seen)
    };
    let (mut reach_u, mut reach_v) = (cx, cy);
    let (last_column, last_row) = (camera.width.saturating_sub(1), camera.height.saturating_sub(1));
    let rows = (0..camera.height).flat_map(|row| [(0, row), (last_column, row)]);
    for pixel in rows.chain((0..camera.width).flat_map(|column| [(column, 0), (column, last_row)])) {
        let (u, v) = unbend(pixel);
        reach_u = reach_u.max((u - cx).abs() + 1.0);
        reach_v = reach_v.max((v - cy).abs() + 1.0);
    }
    [(reach_u, cx), (reach_v, cy)].map(|(reach, half)| (reach - half).ceil().clamp(0.0, 4.0 * half) as u32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lens_adds_rows_before_and_after_the_finished_ones() {
        let rolling = RollingShutter { readout_s: 0.03, strips: 4 };
        let camera = Camera { width: 64, height: 48, horizontal_fov_rad: 1.5 };
        let plain = ReadoutStrips::of(&rolling, &camera, &Lens::default());
        assert_eq!(plain.ends_px, [12.0, 24.0, 36.0, 48.0]);
        assert_eq!([-1.0, 0.0, 11.9, 12.0, 60.0].map(|v| plain.strip_at(v)), [0, 0, 0, 1, 3]);
        let bent = ReadoutStrips::of(&rolling, &camera, &Lens::brown(-0.2, 0.0));
        assert!(bent.ends_px[3] > 48.0 && bent.offsets_s.iter().sum::<f64>().abs() < 1e-12);
        assert_eq!(ReadoutStrips::at_once().strip_at(30.0), 0);
    }
}
