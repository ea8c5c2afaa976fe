//! Light that comes back: material, angle, distance, rain, fog.

use cosfly_domain::{SemanticLabel, Weather};
use cosfly_frames::{RandomStream, real};

/// Reflectivity of the surface that a device's range is stated for.
const STATED: f64 = 0.8;
/// Rain of the weather's largest precipitation, 100, millimetres an hour.
const RAIN_MM_H: f64 = 50.0;
/// Sight in the weather's densest fog, 100, metres.
const SIGHT_M: f64 = 50.0;

/// Share of near infrared light that a surface with a label sends back, square to it.
pub fn reflectivity(label: u8) -> f64 {
    match SemanticLabel::ALL.get(usize::from(label)) {
        Some(SemanticLabel::Roads) => 0.15,
        Some(SemanticLabel::SideWalks) => 0.3,
        Some(SemanticLabel::Vegetation | SemanticLabel::Car | SemanticLabel::Truck | SemanticLabel::Bus) => 0.5,
        Some(SemanticLabel::TrafficSign | SemanticLabel::RoadLine) => 0.8,
        Some(SemanticLabel::Water) => 0.03,
        Some(SemanticLabel::Pedestrian | SemanticLabel::Rider) => 0.45,
        _ => 0.4,
    }
}

/// Loss of light on one way through rain and fog, per metre: 1.076 R^0.67 dB/km in R mm/h of rain; 3.912 / V with a sight of V.
pub(super) fn loss_per_m(weather: &Weather) -> f64 {
    let share = |percent: f64| (0.01 * percent).clamp(0.0, 1.0);
    let rain_mm_h = RAIN_MM_H * share(weather.precipitation);
    let rain = 1.076 * real::powf(rain_mm_h, 0.67) * 1e-4 * core::f64::consts::LN_10;
    rain + 3.912 / SIGHT_M * real::powf(share(weather.fog_density), 1.5)
}

/// Power of an echo in that of the weakest one that is heard: of a surface that sends `intensity` back, at a distance.
pub(super) fn power(intensity: f64, distance_m: f64, range_m: f64, loss_per_m: f64) -> f64 {
    let near = range_m / distance_m.max(1e-3);
    let clear = intensity / STATED * near * near;
    if loss_per_m > 0.0 { clear * real::exp(-2.0 * loss_per_m * distance_m) } else { clear }
}

/// Number with deviation 1 and at most 3.47 away from 0: a sum of four even ones.
pub(super) fn noise(stream: &mut RandomStream) -> f64 {
    let bits = stream.bits();
    let sum: f64 = (0..4).map(|part| f64::from((bits >> (16 * part)) as u16)).sum();
    (sum / 65_535.0 - 2.0) * 1.732_050_807_568_877_2
}
