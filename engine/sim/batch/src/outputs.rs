//! Buffers of a batch, brought by the caller: one for each channel, picture after picture.

use crate::on_request::{self, OnRequest};

/// Where the pictures of a batch go. Each channel is row-major from the top-left pixel, one picture after the other in the
/// order of the views, and holds exactly views x height x width elements; channels that are `None` are not made.
/// Everything is sampled at pixel centres.
#[derive(Default)]
pub struct Outputs<'a> {
    /// Planar depth along the optical axis, metres; `f32::INFINITY` for sky.
    pub depth_m: Option<&'a mut [f32]>,
    /// CARLA label ids.
    pub semantic: Option<&'a mut [u8]>,
    /// Instance ids, as in [`cosfly_domain::FrameImages`]: 0 for ground and sky.
    pub instance: Option<&'a mut [u32]>,
    /// 1 where the target is seen, 0 elsewhere.
    pub target_mask: Option<&'a mut [u8]>,
    /// Red, green, blue, in the simple look of large pictures; three elements a pixel.
    pub rgb: Option<&'a mut [u8]>,
    /// Channels that are drawn pixel by pixel, such as normals.
    pub on_request: Vec<OnRequest<'a>>,
}

impl<'a> Outputs<'a> {
    /// Name and length of the first channel that does not have `pixels` elements.
    pub fn mismatch(&self, pixels: usize) -> Option<(&'static str, usize)> {
        let of_list = [
            ("depth_m", self.depth_m.as_ref().map(|channel| channel.len())),
            ("semantic", self.semantic.as_ref().map(|channel| channel.len())),
            ("instance", self.instance.as_ref().map(|channel| channel.len())),
            ("target_mask", self.target_mask.as_ref().map(|channel| channel.len())),
            ("rgb", self.rgb.as_ref().map(|channel| if channel.len() == 3 * pixels { pixels } else { channel.len() })),
        ];
        let on_request =
            self.on_request.iter().map(|channel| ("on_request", Some(channel.pixels().unwrap_or(usize::MAX))));
        of_list
            .into_iter()
            .chain(on_request)
            .find_map(|(name, length)| length.filter(|length| *length != pixels).map(|length| (name, length)))
    }

    /// Whether anything but colours is asked for.
    pub(crate) fn has_geometry(&self) -> bool {
        let Self { depth_m, semantic, instance, target_mask, rgb: _, on_request } = self;
        depth_m.is_some() || semantic.is_some() || instance.is_some() || target_mask.is_some() || !on_request.is_empty()
    }

    /// Takes the first `pixels` elements of each channel away.
    pub(crate) fn split_off(&mut self, pixels: usize) -> Outputs<'a> {
        Outputs {
            depth_m: first(&mut self.depth_m, pixels),
            semantic: first(&mut self.semantic, pixels),
            instance: first(&mut self.instance, pixels),
            target_mask: first(&mut self.target_mask, pixels),
            rgb: first(&mut self.rgb, 3 * pixels),
            on_request: self.on_request.iter_mut().map(|channel| channel.split_off(pixels)).collect(),
        }
    }
}

fn first<'a, T>(channel: &mut Option<&'a mut [T]>, pixels: usize) -> Option<&'a mut [T]> {
    channel.as_mut().map(|buffer| on_request::first(buffer, pixels))
}
