//! Lidars: sensors whose reading is a cloud of points.
//!
//! * [`LIDARS`]: the devices, by name; [`ScanConfig`]: a device, or a pattern of one's own, on the drone.
//! * [`ScannedFlight`]: a flight that carries one, scanned sweep by sweep. [`LidarPoint`]: an echo.
//! * [`LidarScene`]: what rays meet, with labels and instance ids; people and vehicles are figures that move within a sweep.

mod bodies;
mod config;
mod device;
mod echo;
mod pattern;
mod point;
mod scene;
mod sweep;
#[cfg(test)]
mod tests;

pub use config::{PatternConfig, ScanConfig, ScanRefusal};

pub use device::{LIDARS, Lidar, lidar};
pub use echo::reflectivity;
pub use pattern::LidarPattern;
pub use point::LidarPoint;
pub use scene::{LidarScene, LidarTriangle};
pub use sweep::{LidarSweep, MOST_BEAMS, ScannedFlight};
