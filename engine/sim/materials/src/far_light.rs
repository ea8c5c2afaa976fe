//! Light by which a body changes what lies away from it: the sun's, and that of its lamps.

use crate::light::Light;
use cosfly_domain::Weather;
use cosfly_frames::DVec3;

/// Light by which a body changes what lies away from it.
#[derive(Clone, Copy)]
pub struct FarLight {
    /// Direction to the sun, or to the moon at night; unit length, above the horizon.
    pub to_sun: DVec3,
    /// Whether vehicles have their lamps on.
    pub is_night: bool,
}

impl FarLight {
    /// The light of a weather.
    pub fn of(weather: &Weather) -> Self {
        let Light { to_sun, night, .. } = Light::new(weather);
        let to_sun = DVec3::new(f64::from(to_sun.x), f64::from(to_sun.y), f64::from(to_sun.z));
        Self { to_sun, is_night: night > 0.0 }
    }
}
