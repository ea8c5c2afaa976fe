//! Depth as a feature: TIFF files of metres in 32-bit floats, which LeRobot reads without loss from 0.6 on.

use serde_json::{Value, json};

/// Steps of the statistics in a metre.
pub const STATISTICS_PER_M: f64 = 1000.0;

/// The feature in `meta/info.json`.
pub fn feature([width, height]: [u32; 2]) -> Value {
    let info = json!({"is_depth_map": true, "depth_unit": "m"});
    json!({"dtype": "image", "shape": [height, width, 1], "names": ["height", "width", "channels"], "info": info})
}
