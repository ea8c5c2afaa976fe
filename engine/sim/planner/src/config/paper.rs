//! Parameters of the paper's pipeline that only it has, with the paper's values where it gives them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Start and clean-up of `preset = "paper"`. The descent has its own table; heights, pitch, distance and limits are
/// those of `view` and `limits`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(extend("x-gone" = { "nearest_share": "write `min_distance_share`", "farthest_share": "write `max_distance_share`" }))]
pub struct PaperConfig {
    /// Frames between searched viewpoints (paper: 5 to 10). Default 5.
    #[schemars(range(min = 1, max = 20))]
    pub keyframe_frames: u32,
    /// Half-angle of the sector behind the walker that is searched, degrees (paper: 60). Default 60.
    #[schemars(range(min = 0.0, max = 180.0))]
    pub rear_sector_deg: f64,
    /// Least horizontal distance that is searched, as a share of the standard one, which is the best distance times
    /// the cosine of the best pitch (paper: 0.7). Default 0.7.
    #[schemars(range(min = 0.1, max = 3.0))]
    pub min_distance_share: f64,
    /// Largest horizontal distance that is searched, as a share of the standard one (paper: 1.2). Default 1.2.
    #[schemars(range(min = 0.1, max = 3.0))]
    pub max_distance_share: f64,
    /// Weight of visibility while viewpoints are searched (the paper says only "optimal"). Default 60.
    #[schemars(range(min = 0.0, max = 1_000_000.0))]
    pub search_visibility: f64,
    /// Cost of a square metre between an offset from the target and that of the keyframe before, while viewpoints are
    /// searched (the paper says nothing; without it paths zigzag more). Default 0.02.
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub keyframe_motion: f64,
    /// Hidden runs longer than this are led aside or straightened, frames (paper: 5). Default 5.
    #[schemars(range(min = 1, max = 1000))]
    pub hidden_run_frames: u32,
    /// Largest sideways offset by which a hidden run of the start is bridged, metres. Default 12.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub side_offset_m: f64,
    /// Frames over which a changed stretch runs into the rest. Default 6.
    #[schemars(range(min = 0, max = 100))]
    pub ramp_frames: u32,
    /// Rounds of safety projection (paper: "multi-round"). Default 5.
    #[schemars(range(min = 1, max = 100))]
    pub projection_rounds: u32,
    /// Smooths a flight that breaks its limits, as the other presets' are; if false, the pipeline's own
    /// flight is judged (the pipeline bounds neither acceleration nor jerk, so set `limits.require_kinematics = false`, too). Default true.
    pub make_flyable: bool,
}

impl Default for PaperConfig {
    fn default() -> Self {
        Self {
            keyframe_frames: 5,
            rear_sector_deg: 60.0,
            min_distance_share: 0.7,
            max_distance_share: 1.2,
            search_visibility: 60.0,
            keyframe_motion: 0.02,
            hidden_run_frames: 5,
            side_offset_m: 12.0,
            ramp_frames: 6,
            projection_rounds: 5,
            make_flyable: true,
        }
    }
}

impl PaperConfig {
    /// Refuses values out of range: (name of the parameter within this table, what is wrong).
    pub fn validate(&self) -> Result<(), (String, String)> {
        for (name, value, low, high) in [
            ("keyframe_frames", f64::from(self.keyframe_frames), 1.0, 20.0),
            ("rear_sector_deg", self.rear_sector_deg, 0.0, 180.0),
            ("min_distance_share", self.min_distance_share, 0.1, 3.0),
            ("max_distance_share", self.max_distance_share, 0.1, 3.0),
            ("search_visibility", self.search_visibility, 0.0, 1e6),
            ("keyframe_motion", self.keyframe_motion, 0.0, 1000.0),
            ("hidden_run_frames", f64::from(self.hidden_run_frames), 1.0, 1000.0),
            ("side_offset_m", self.side_offset_m, 0.0, 100.0),
            ("ramp_frames", f64::from(self.ramp_frames), 0.0, 100.0),
            ("projection_rounds", f64::from(self.projection_rounds), 1.0, 100.0),
        ] {
            if !(value >= low && value <= high) {
                return Err((
                    name.to_owned(),
                    format!("`paper.{name}` is {value}; it must be between {low} and {high}"),
                ));
            }
        }
        if self.min_distance_share > self.max_distance_share {
            let (nearest, farthest) = (self.min_distance_share, self.max_distance_share);
            let rule = format!(
                "`paper.min_distance_share` is {nearest}; it must not be above `paper.max_distance_share`, which is {farthest}"
            );
            return Err(("min_distance_share".to_owned(), rule));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defaults_are_valid_and_refusals_name_their_parameter() {
        assert_eq!(PaperConfig::default().validate(), Ok(()));
        let check = |change: &dyn Fn(&mut PaperConfig), name: &str| {
            let mut config = PaperConfig::default();
            change(&mut config);
            let (found, rule) = config.validate().unwrap_err();
            assert_eq!(found, name);
            assert!(rule.contains(name), "{rule}");
        };
        check(&|c| c.keyframe_frames = 0, "keyframe_frames");
        check(&|c| c.rear_sector_deg = f64::NAN, "rear_sector_deg");
        check(&|c| c.min_distance_share = 1.3, "min_distance_share");
    }
}
