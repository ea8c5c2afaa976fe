//! Light of scans: sRGB codes and back, and what shadows of bodies leave of it.

use cosfly_domain::SemanticLabel;
use cosfly_frames::real;

/// Light of pixels without the shadows of bodies, and with them, as shares of the first.
pub fn lit_shares(without: &[u8], with: &[u8], lit: &mut Vec<f32>) {
    let curve = CodeCurve::default();
    let light: [f32; 256] = core::array::from_fn(|code| curve.decoded(code as f32 / 255.0));
    let sum = |rgb: &[u8; 3]| rgb.iter().map(|code| light[usize::from(*code)]).sum::<f32>();
    let pixels = without.as_chunks::<3>().0.iter().zip(with.as_chunks::<3>().0);
    lit.clear();
    lit.extend(pixels.map(|(without, with)| match sum(without) {
        _ if without == with => 1.0,
        bright if bright > 0.0 => (sum(with) / bright).min(1.0),
        _ => 1.0,
    }));
}

/// Pixels from one to the next at which grounds are compared.
const BETWEEN_LOOKS: usize = 61;
/// Fewest pixels of ground that tell anything.
const ENOUGH: usize = 20;
/// Labels of ground.
const GROUNDS: [SemanticLabel; 4] =
    [SemanticLabel::Roads, SemanticLabel::SideWalks, SemanticLabel::Terrain, SemanticLabel::Ground];

/// Ground of a picture in the light of its weather, to compare a scan's with.
#[derive(Debug, Default)]
pub struct GroundLight {
    /// Pixels and their light.
    drawn: Vec<(usize, f32)>,
    /// How much brighter the scan is there, stops.
    stops: Vec<f32>,
    /// Light of each code, once it is asked for.
    light: Vec<f32>,
}

impl GroundLight {
    /// Light of a pixel of three bytes, 0 to 3.
    fn light_at(&self, rgb: &[u8], at: usize) -> f32 {
        rgb.get(3 * at..3 * at + 3).map_or(0.0, |pixel| pixel.iter().map(|code| self.light[usize::from(*code)]).sum())
    }

    /// Notes the ground as it is drawn without the scan.
    pub fn note(&mut self, rgb: &[u8], semantic: &[u8]) {
        let is_ground = |label: u8| GROUNDS.iter().any(|ground| ground.id() == label);
        let pixels = semantic.iter().enumerate().step_by(BETWEEN_LOOKS).filter(|(_, label)| is_ground(**label));
        if self.light.is_empty() {
            let curve = CodeCurve::default();
            self.light = (0..=u8::MAX).map(|code| curve.decoded(f32::from(code) / 255.0)).collect();
        }
        let drawn = pixels.map(|(at, _)| (at, self.light_at(rgb, at))).collect();
        self.drawn = drawn;
    }

    /// Compares the ground with that of the scan, which now lies over it.
    pub fn compare(&mut self, rgb: &[u8]) {
        let stops = |(at, before): &(usize, f32)| {
            let ratio = f64::from(self.light_at(rgb, *at) / before);
            (real::ln(ratio) / real::ln(2.0)) as f32
        };
        let drawn = self.drawn.iter().filter(|(_, before)| *before > 0.0);
        let mut found: Vec<f32> = drawn.map(stops).filter(|stops| stops.is_finite()).collect();
        found.sort_unstable_by(f32::total_cmp);
        self.stops = found;
    }

    /// How much brighter the scan's ground is than ground is drawn in the same light, stops, in the median; none of little ground.
    pub fn stops(&self) -> Option<f32> {
        self.stops.get(self.stops.len() / 2).copied().filter(|_| self.stops.len() >= ENOUGH)
    }
}

/// Steps of the tables from light to code and back.
const STEPS: usize = 4096;

/// The curve between sRGB codes and light, both 0 to 1.
pub struct CodeCurve {
    light: [f32; STEPS + 1],
    code: [f32; STEPS + 1],
}

impl Default for CodeCurve {
    fn default() -> Self {
        let at = |step: usize| step as f64 / STEPS as f64;
        let light = |code: f64| {
            if code <= 0.04045 { code / 12.92 } else { real::powf((code + 0.055) / 1.055, 2.4) }
        };
        let code = |light: f64| {
            if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * real::powf(light, 1.0 / 2.4) - 0.055 }
        };
        Self {
            light: core::array::from_fn(|step| light(at(step)) as f32),
            code: core::array::from_fn(|step| code(at(step)) as f32),
        }
    }
}

impl CodeCurve {
    /// Light of a code.
    pub fn decoded(&self, code: f32) -> f32 {
        between(&self.light, code)
    }

    /// Code of a light.
    pub fn encoded(&self, light: f32) -> f32 {
        between(&self.code, light)
    }
}

/// Steps of a camera's tables.
const CAMERA_STEPS: usize = 1024;

/// Codes of a scan as a camera of other exposure and white balance takes them.
#[derive(Clone, Debug, Default)]
pub struct CameraCurve {
    /// Factors of red, green and blue light.
    pub factors: [f32; 3],
    codes: [Vec<f32>; 3],
}

impl CameraCurve {
    /// The tables of these factors; those at hand where they have them.
    pub fn prepare(&mut self, factors: [f32; 3], curve: &CodeCurve) {
        if self.factors == factors {
            return;
        }
        self.factors = factors;
        let code = |factor: f32, step: usize| curve.encoded(factor * curve.decoded(step as f32 / CAMERA_STEPS as f32));
        self.codes = factors.map(|factor| (0..=CAMERA_STEPS).map(|step| code(factor, step)).collect());
    }

    /// Whether codes stay what they are.
    pub fn is_plain(&self) -> bool {
        self.factors == [1.0; 3]
    }

    /// Code of channel `k` for a code of the scan.
    pub fn code(&self, k: usize, code: f32) -> f32 {
        let place = code.clamp(0.0, 1.0) * CAMERA_STEPS as f32;
        let step = (place as usize).min(CAMERA_STEPS - 1);
        match self.codes[k].get(step..step + 2) {
            Some([low, high]) => low + (high - low) * (place - step as f32),
            _ => code,
        }
    }
}

/// Value of a table over 0 to 1.
fn between(table: &[f32; STEPS + 1], at: f32) -> f32 {
    let place = at.clamp(0.0, 1.0) * STEPS as f32;
    let step = (place as usize).min(STEPS - 1);
    table[step] + (table[step + 1] - table[step]) * (place - step as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_the_light_is_half_the_light_whatever_the_code() {
        let curve = CodeCurve::default();
        for code in [0.02, 0.3, 0.9] {
            let light = curve.decoded(code);
            assert!((curve.encoded(light) - code).abs() < 2e-4, "{code}");
        }
        let mut lit = vec![];
        // 188 is half the light of 255.
        lit_shares(&[255, 255, 255, 90, 90, 90, 0, 0, 0], &[188, 188, 188, 90, 90, 90, 9, 9, 9], &mut lit);
        assert!((lit[0] - 0.5).abs() < 5e-3, "{lit:?}");
        assert_eq!(lit[1..], [1.0, 1.0]);
    }

    #[test]
    fn a_camera_of_half_the_exposure_takes_half_the_light() {
        let (curve, mut camera) = (CodeCurve::default(), CameraCurve::default());
        camera.prepare([1.0; 3], &curve);
        assert!(camera.is_plain());
        camera.prepare([0.5, 1.0, 2.0], &curve);
        for code in [0.1, 0.4, 0.7] {
            let light = [0, 1, 2].map(|k| curve.decoded(camera.code(k, code)) / curve.decoded(code));
            assert!(light.iter().zip([0.5, 1.0, 2.0]).all(|(own, factor)| (own - factor).abs() < 0.01), "{light:?}");
        }
    }

    #[test]
    fn a_scan_is_as_many_stops_brighter_as_its_ground_is() {
        let mut ground = GroundLight::default();
        let mut labels = vec![SemanticLabel::Roads.id(); 61 * 40];
        labels[..61 * 10].fill(SemanticLabel::Building.id());
        let picture = |code: u8| vec![code; 3 * labels.len()];
        ground.note(&picture(188), &labels);
        assert_eq!(ground.stops(), None, "nothing was compared");
        // 255 is twice the light of 188, and 137 half of it.
        for (code, stops) in [(188, 0.0), (255, 1.0), (137, -1.0)] {
            ground.compare(&picture(code));
            assert!(ground.stops().is_some_and(|it| (it - stops).abs() < 0.02), "{code}: {:?}", ground.stops());
        }
        ground.note(&picture(188), &labels[..61 * 20]);
        ground.compare(&picture(255));
        assert_eq!(ground.stops(), None, "too little ground");
    }
}
