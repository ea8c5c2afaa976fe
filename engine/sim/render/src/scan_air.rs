//! Haze before a scan: what a frame's weather adds to the air of the day on which the place was scanned.

use crate::shade::geometry::{View, fast_exp};
use cosfly_materials::light::Light;
use cosfly_materials::scan_light::CodeCurve;
use cosfly_materials::tone::ToneCurve;
use cosfly_materials::vector::Vec3;

/// Share of the light that the air of a dry day takes per metre: a scan has it in its colours.
const OF_DRY_DAYS_PER_M: f32 = 0.00035 + 0.006 * 0.03;
/// Less haze than this is none, 1/m.
const LEAST_PER_M: f32 = 1e-6;

/// Haze of a frame.
#[derive(Clone, Copy)]
pub(crate) struct ScanAir {
    per_m: f32,
    start_m: f32,
    view: View,
    /// Light of the haze, red, green and blue, as a scan's colours are light.
    light: [f32; 3],
}

impl ScanAir {
    /// The air before a camera in a light, whose haze has this colour; none on days as clear as those of scans.
    pub fn new((light, haze): (&Light, Vec3), tone: &ToneCurve, view: View) -> Option<Self> {
        let per_m = light.haze_per_m - OF_DRY_DAYS_PER_M;
        if per_m < LEAST_PER_M {
            return None;
        }
        let [red, green, blue, _] = tone.pixel(haze * light.exposure).to_le_bytes();
        let curve = CodeCurve::default();
        let start_m = light.haze_start_m;
        let light = [red, green, blue].map(|code| curve.decoded(f32::from(code) / 255.0));
        Some(Self { per_m, start_m, view, light })
    }

    /// Share of the light of a pixel at a planar depth, metres, that comes through.
    pub fn kept(&self, pixel: usize, width: usize, depth_m: f32) -> f32 {
        let ray = self.view.ray((pixel % width) as f32 + 0.5, (pixel / width) as f32 + 0.5);
        let far_m = depth_m * ray.dot(ray).sqrt() - self.start_m;
        fast_exp(-self.per_m * far_m.max(0.0))
    }

    /// Light of channel `k` behind the haze.
    pub fn seen(&self, light: f32, kept: f32, k: usize) -> f32 {
        light * kept + self.light[k] * (1.0 - kept)
    }
}
