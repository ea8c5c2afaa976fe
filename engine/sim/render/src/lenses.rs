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
        if !self.shows_corners(widest_deg) {
            let (message, hint) = self.empty_corners(widest_deg);
            return problem("lens", message, &hint);
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
            return problem(
                "channels",
                message,
                "leave out the channels of flow, take a narrower lens, or film this camera in a stage `render` of its own",
            );
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

    /// Whether the corners of pictures with this `fov_deg` show something.
    fn shows_corners(&self, fov_deg: f64) -> bool {
        let camera = self.camera_of(fov_deg);
        match self.lens.model {
            LensModel::Brown => self.lens.widening(&camera).is_some_and(|widening| widening <= 3.0),
            LensModel::Fisheye | LensModel::Equirectangular => self.lens.ray(&camera, (0.0, 0.0)).is_some(),
        }
    }

    /// Message and advice where the corners of pictures with this `fov_deg` show nothing.
    fn empty_corners(&self, fov_deg: f64) -> (String, String) {
        let Lens { model, k1, k2, k3, k4 } = self.lens;
        let (name, is_range) = (model.name(), self.fov_range_deg.is_some());
        let most = (1..fov_deg as u32).rev().find(|it| self.shows_corners(f64::from(*it)));
        let smaller = most.map(|most| match is_range {
            true => format!("let `fov_range_deg` end at {most} or less"),
            false => format!("take a `fov_deg` of {most} or less"),
        });
        let nearer = ([k1, k2, k3, k4] != [0.0; 4]).then(|| "take coefficients nearer to 0".to_owned());
        let ways: Vec<String> = smaller.into_iter().chain(nearer).collect();
        let mut message = format!(
            "the lens (`{name}`, k {k1}, {k2}, {k3}, {k4}) has no picture in the corners of {} x {} pixels at {fov_deg} degrees",
            self.width, self.height
        );
        let mut hint = ways.join(", or ");
        match model {
            LensModel::Brown => message += ", or needs one more than three times as wide",
            _ => {
                hint += "; the degrees state the focal length, width / 2 / tan(degrees / 2), and a fisheye sees less than 180 \
                         degrees off its axis";
            }
        }
        (message, hint)
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

    #[test]
    fn advice_on_empty_corners_can_be_followed() {
        let of = |fov_deg: f64, lens: Lens| RenderConfig {
            fov_deg,
            width: 300,
            height: 300,
            lens,
            ..RenderConfig::default()
        };
        let brown = Lens { k1: -0.3, ..Lens::default() };
        let range = RenderConfig { fov_range_deg: Some([60.0, 150.0]), ..of(60.0, Lens::fisheye([0.0; 4])) };
        assert!(range.validate().expect_err("nothing in the corners").hint.starts_with("let `fov_range_deg` end at "));
        for (lens, bent) in
            [(Lens::fisheye([0.0; 4]), false), (Lens::fisheye([-0.2, 0.0, 0.0, 0.0]), true), (brown, true)]
        {
            let found = of(150.0, lens).validate().expect_err("nothing in the corners");
            let words = found.hint.split("`fov_deg` of ").nth(1).expect("a field of view");
            let most: f64 = words.split(' ').next().and_then(|it| it.parse().ok()).expect("degrees");
            of(most, lens).validate().expect("the advice");
            of(most + 1.0, lens).validate().expect_err("the most");
            assert_eq!(found.hint.contains("coefficients"), bent, "{}", found.hint);
        }
    }
}
