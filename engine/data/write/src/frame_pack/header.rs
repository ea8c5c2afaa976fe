//! The header of a frame pack: image size, encodings, channels.

use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_domain::channels::Element;
use cosfly_domain::{Channel, ChannelSet};
use cosfly_schema::config::EncodingConfig;
use cosfly_schema::log::{FrameTimes, RawFormat, formats};
use serde::{Deserialize, Serialize};

const MAX_SIDE: u32 = 16_384;
const MAX_PIXELS: usize = 1 << 26;

/// Properties that all frames of a pack share.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PackHeader {
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Size of an instance id.
    pub instance: InstanceFormat,
    /// How the images are stored.
    pub encoding: EncodingConfig,
    /// Time between frames, seconds.
    pub dt_s: f64,
    /// Time of the first frame after the beginning of the flight, nanoseconds.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub begins_ns: u64,
    /// Channels of every frame.
    #[serde(default, skip_serializing_if = "ChannelSet::is_default")]
    pub channels: ChannelSet,
}

fn is_zero(offset: &u64) -> bool {
    *offset == 0
}

impl PackHeader {
    /// The header for images of `width` x `height` pixels, `dt_s` apart, whose instance ids are at most
    /// `largest_instance`.
    pub fn new(width: u32, height: u32, largest_instance: u32, encoding: EncodingConfig, dt_s: f64) -> Self {
        let instance = if largest_instance <= u32::from(u16::MAX) { InstanceFormat::U16 } else { InstanceFormat::U32 };
        Self { width, height, instance, encoding, dt_s, begins_ns: 0, channels: ChannelSet::default() }
    }

    /// Times of the frames.
    pub fn times(&self) -> FrameTimes {
        FrameTimes { begins_ns: self.begins_ns, dt_s: self.dt_s }
    }

    /// Layout of a raw channel's pixels.
    ///
    /// # Panics
    /// For a channel that is stored as an image file.
    pub fn format_of(&self, channel: &Channel) -> RawFormat {
        let wide = channel.element() == Element::Id && self.instance == InstanceFormat::U32;
        formats(channel)[usize::from(wide)]
    }

    /// Pixels of one image.
    pub fn pixels(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// Refuses sizes that no camera of ours has, before anything is allocated for them.
    pub(super) fn check(&self) -> Result<()> {
        let sides = 1..=MAX_SIDE;
        if !sides.contains(&self.width) || !sides.contains(&self.height) || self.pixels() > MAX_PIXELS {
            return Err(damaged(format!(
                "images of {} x {} pixels; sides must be 1 to {MAX_SIDE} and the area at most {MAX_PIXELS}",
                self.width, self.height
            )));
        }
        if let Some(missing) = self.channels.missing() {
            return Err(damaged(format!("frames without `{}`", missing.name)));
        }
        if !(self.dt_s.is_finite() && self.dt_s > 0.0) {
            return Err(damaged(format!("frames {} s apart", self.dt_s)));
        }
        Ok(())
    }
}

/// Size of an instance id in a pack and in the log made from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum InstanceFormat {
    /// Two bytes.
    U16,
    /// Four bytes, for towns with more than 65,533 objects.
    U32,
}

/// Refusal of a pack that cannot be read.
pub(super) fn damaged(message: String) -> Box<Diagnostic> {
    Diagnostic::new("frame-pack", Fault::Input, format!("the frame pack is not usable: {message}"))
}
