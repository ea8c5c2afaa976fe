//! [`RenderOptions`]: what a measurement draws, and how often.

use super::views::Ground;
use cosfly_domain::Weather;
use cosfly_schema::EncodingConfig;
use std::path::Path;

/// Options of the measurement.
pub struct RenderOptions<'a> {
    /// Towns, each with its views.
    pub grounds: Vec<Ground>,
    /// Weathers in which every view is drawn.
    pub weathers: Vec<Weather>,
    /// Number of rounds over all views; the minimum time of each stage counts.
    pub rounds: usize,
    /// Storage of images.
    pub encoding: EncodingConfig,
    /// Number of threads of the throughput measurement.
    pub threads: usize,
    /// Number of frames of each flight of the throughput measurement.
    pub flight_frames: usize,
    /// An empty folder on the measured disk.
    pub scratch: &'a Path,
}
