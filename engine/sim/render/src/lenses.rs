//! What is wrong with the lens of a stage or of one of its cameras, and what its pictures cannot have.

use crate::config::{ConfigProblem, RenderConfig};
use cosfly_domain::channels::{ChannelSource, depth_sensor};
use cosfly_domain::{Lens, LensModel};

impl RenderConfig {
    /// Checks the lens, and what pictures through it cannot have.
    pub(crate) fn check_lens(&self) -> Result<(), ConfigProblem> {
        let Lens { model, k1, k2, k3, k4 } = self.lens;
        let problem = |path: &str, message: String, hint: &str| {
            Err(ConfigProblem { path: path.into(), message, hint: hint.into() })
        };
        for (path, value) in [("lens.k1", k1), ("lens.k2", k2), ("lens.k3", k3), ("lens.k4", k4)] {
            if !(-1.0..=1.0).contains(&value) {
                return problem(path, format!("the value is `{value}`"), "allowed are -1 to 1");
            }
        }
        if model == LensModel::Brown && (k3 != 0.0 || k4 != 0.0) {
            let message = "`k3` and `k4` are of a fisheye, and the model is `brown`".to_owned();
            return problem("lens.model", message, "write `model = \"fisheye\"`, or leave out `k3` and `k4`");
        }
        if model == LensModel::Equirectangular {
            self.check_all_around()?;
        }
        let widest_deg = self.fov_range_deg.map_or(self.fov_deg, |range| range[1]);
        let widest = self.camera_of(widest_deg);
        let is_shown = match model {
            LensModel::Brown => self.lens.widening(&widest).is_some_and(|widening| widening <= 3.0),
            LensModel::Fisheye | LensModel::Equirectangular => self.lens.ray(&widest, (0.0, 0.0)).is_some(),
        };
        if !is_shown {
            let message = format!(
                "the lens (`{}`, k {k1}, {k2}, {k3}, {k4}) has no picture in the corners of a field of view of {widest_deg} degrees, \
                 or needs one more than three times as wide",
                model.name()
            );
            return problem("lens", message, "take coefficients nearer to 0 or a smaller field of view");
        }
        if self.lens.is_none() {
            return Ok(());
        }
        if self.channels.contains(&depth_sensor::CHANNEL) {
            let message = "`depth_sensor` measures in rectified pictures, and `lens` bends them".to_owned();
            return problem("channels", message, "leave out `depth_sensor`, or `lens`");
        }
        if !self.lens.is_wide(&widest) {
            return Ok(());
        }
        let is_flow = |source| matches!(source, ChannelSource::Flow(_) | ChannelSource::FlowValid(_));
        if let Some(channel) = self.channels.iter().find(|channel| is_flow(channel.source)) {
            let message = format!("`{}` is of one ideal picture, and `lens` needs views all around", channel.name);
            return problem("channels", message, "leave out the channels of flow, or take a narrower lens");
        }
        if !self.rolling_shutter.is_none() {
            let message =
                "the rows of a picture that is put together from views all around are of one moment".to_owned();
            return problem(
                "rolling_shutter.readout_s",
                message,
                "leave out `rolling_shutter`, or take a narrower lens",
            );
        }
        Ok(())
    }

    /// Checks what an equirectangular picture has of its own.
    fn check_all_around(&self) -> Result<(), ConfigProblem> {
        let problem = |path: &str, message: &str, hint: &str| {
            Err(ConfigProblem { path: path.into(), message: message.into(), hint: hint.into() })
        };
        let Lens { k1, k2, k3, k4, .. } = self.lens;
        if [k1, k2, k3, k4] != [0.0; 4] {
            return problem("lens", "an equirectangular picture has no coefficients", "leave out `k1` to `k4`");
        }
        if self.width != 2 * self.height {
            let message = format!("the picture is `{}` pixels high and {} wide", self.height, self.width);
            return problem("height", &message, "360 x 180 degrees are twice as wide as high");
        }
        if self.fov_range_deg.is_some() {
            let message = "an equirectangular picture shows 360 x 180 degrees";
            return problem("fov_range_deg", message, "leave the key out");
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_domain::{ChannelSet, RollingShutter};

    #[test]
    fn lenses_that_see_all_around_are_allowed_and_what_they_lack_is_refused_at_its_key() {
        let lens = Lens { model: LensModel::Equirectangular, ..Lens::default() };
        let around = RenderConfig { width: 400, height: 200, lens, ..RenderConfig::default() };
        let wide =
            RenderConfig { fov_deg: 115.0, width: 300, height: 300, lens: Lens::fisheye([0.0; 4]), ..around.clone() };
        around.validate().expect("a picture all around");
        wide.validate().expect("a fisheye of 180 degrees");
        let flows = ChannelSet::of(|channel| !["depth_sensor", "disparity"].contains(&channel.name));
        let rolling_shutter = RollingShutter { readout_s: 0.02, ..RollingShutter::default() };
        for (config, path) in [
            (RenderConfig { height: 300, ..around.clone() }, "height"),
            (RenderConfig { lens: Lens { k1: 0.1, ..lens }, ..around.clone() }, "lens"),
            (RenderConfig { fov_range_deg: Some([60.0, 90.0]), ..around.clone() }, "fov_range_deg"),
            (RenderConfig { channels: flows.clone(), ..around.clone() }, "channels"),
            (RenderConfig { channels: flows, ..wide.clone() }, "channels"),
            (RenderConfig { rolling_shutter, ..around }, "rolling_shutter.readout_s"),
            (RenderConfig { rolling_shutter, ..wide.clone() }, "rolling_shutter.readout_s"),
            (RenderConfig { fov_deg: 150.0, ..wide }, "lens"),
        ] {
            let found = config.validate().expect_err(path);
            assert_eq!(found.path, path, "{found}");
        }
    }
}
