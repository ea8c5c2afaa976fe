//! Buffers of a batch, brought by the caller: one for each channel, picture after picture.

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
}

impl<'a> Outputs<'a> {
    /// Name and length of the first channel that does not have `pixels` elements.
    pub fn mismatch(&self, pixels: usize) -> Option<(&'static str, usize)> {
        [
            ("depth_m", self.depth_m.as_ref().map(|channel| channel.len())),
            ("semantic", self.semantic.as_ref().map(|channel| channel.len())),
            ("instance", self.instance.as_ref().map(|channel| channel.len())),
            ("target_mask", self.target_mask.as_ref().map(|channel| channel.len())),
            ("rgb", self.rgb.as_ref().map(|channel| if channel.len() == 3 * pixels { pixels } else { channel.len() })),
        ]
        .into_iter()
        .find_map(|(name, length)| length.filter(|length| *length != pixels).map(|length| (name, length)))
    }

    /// Whether anything but colours is asked for.
    pub(crate) fn has_geometry(&self) -> bool {
        self.depth_m.is_some() || self.semantic.is_some() || self.instance.is_some() || self.target_mask.is_some()
    }

    /// Takes the first `pixels` elements of each channel away.
    pub(crate) fn split_off(&mut self, pixels: usize) -> Outputs<'a> {
        Outputs {
            depth_m: first(&mut self.depth_m, pixels),
            semantic: first(&mut self.semantic, pixels),
            instance: first(&mut self.instance, pixels),
            target_mask: first(&mut self.target_mask, pixels),
            rgb: first(&mut self.rgb, 3 * pixels),
        }
    }
}

fn first<'a, T>(channel: &mut Option<&'a mut [T]>, pixels: usize) -> Option<&'a mut [T]> {
    let (head, rest) = channel.take()?.split_at_mut(pixels);
    *channel = Some(rest);
    Some(head)
}
