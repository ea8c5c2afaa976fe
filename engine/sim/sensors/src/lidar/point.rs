//! [`LidarPoint`]: an echo.

/// An echo. The place is in the axes of the sensor at the time of the shot (x ahead, y right, z up).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LidarPoint {
    /// Metres.
    pub place_m: [f32; 3],
    /// Share of the light that the surface sends back.
    pub intensity: f32,
    /// Time since the sweep's beginning, seconds.
    pub time_s: f32,
    /// Number of the beam in a shot.
    pub ring: u16,
    /// CARLA's label id.
    pub label: u8,
    /// Instance id as in pictures: 0 ground, 1 the target.
    pub instance: u32,
}
