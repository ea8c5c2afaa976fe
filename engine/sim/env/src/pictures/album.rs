//! [`PictureBatch`]: pictures of several environments, a buffer for each channel.

use super::format::PictureFormat;
use cosfly_batch::{OnRequest, Outputs};
use cosfly_domain::Channel;
use cosfly_domain::channels::{ChannelSource, Element};
use rayon::prelude::*;
use std::ops::Range;

/// Pixels of a channel, picture after picture, each row by row from the top left pixel.
#[derive(Clone, Debug, PartialEq)]
pub enum Pixels {
    /// Labels, flags, or three bytes a pixel.
    Bytes(Vec<u8>),
    /// Numbers.
    Floats(Vec<f32>),
    /// Instance ids.
    Ids(Vec<u32>),
}

/// Pictures of several environments, one after the other, with the channels of their format.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PictureBatch {
    pixels: usize,
    channels: Vec<(&'static Channel, Pixels)>,
}

impl PictureBatch {
    /// Room for `count` pictures.
    pub fn new(format: &PictureFormat, count: usize) -> Self {
        let pixels = format.pixels();
        let channel = |channel: &'static Channel| (channel, Pixels::new(channel.element(), count * pixels));
        Self { pixels, channels: format.channels.iter().map(channel).collect() }
    }

    /// The channels with their pixels, in the order of [`cosfly_domain::channels::ALL`].
    pub fn channels(&self) -> impl Iterator<Item = (&'static Channel, &Pixels)> {
        self.channels.iter().map(|(channel, pixels)| (*channel, pixels))
    }

    /// Pixels of a channel; none where the format lacks it.
    pub fn of(&self, wanted: &Channel) -> Option<&Pixels> {
        self.channels().find_map(|(channel, pixels)| (channel == wanted).then_some(pixels))
    }

    /// Copies the picture of one environment from another album of the same format.
    pub fn copy(&mut self, other: &Self, number: usize) {
        let part = number * self.pixels..(number + 1) * self.pixels;
        for ((channel, to), (_, from)) in self.channels.iter_mut().zip(&other.channels) {
            to.copy(from, &elements(channel, &part));
        }
    }

    /// Fills a picture with zeros.
    pub(super) fn wipe(&mut self, number: usize) {
        let part = number * self.pixels..(number + 1) * self.pixels;
        self.channels.iter_mut().for_each(|(channel, pixels)| pixels.wipe(&elements(channel, &part)));
    }

    /// Sets depths beyond the farthest to the farthest, metres, in a range of pixels.
    pub(super) fn cut_depth(&mut self, part: &Range<usize>, farthest_m: f32, threads: usize) {
        let cut = |depths_m: &mut [f32]| depths_m.iter_mut().for_each(|depth_m| *depth_m = depth_m.min(farthest_m));
        for (channel, pixels) in &mut self.channels {
            if let (ChannelSource::Depth, Pixels::Floats(depths_m)) = (channel.source, pixels) {
                let depths_m = &mut depths_m[part.clone()];
                match threads {
                    0 | 1 => cut(depths_m),
                    _ => depths_m.par_chunks_mut(self.pixels.max(1)).for_each(cut),
                }
            }
        }
    }

    /// The buffers of a range of pixels, for the small renderer.
    pub(super) fn outputs(&mut self, part: &Range<usize>) -> Outputs<'_> {
        let mut outputs = Outputs::default();
        for (channel, pixels) in &mut self.channels {
            let part = elements(channel, part);
            match (channel.source, pixels) {
                (ChannelSource::Colour, Pixels::Bytes(rgb)) => outputs.rgb = Some(&mut rgb[part]),
                (ChannelSource::Depth, Pixels::Floats(depth_m)) => outputs.depth_m = Some(&mut depth_m[part]),
                (ChannelSource::Labels, Pixels::Bytes(labels)) => outputs.semantic = Some(&mut labels[part]),
                (ChannelSource::Ids, Pixels::Ids(ids)) => outputs.instance = Some(&mut ids[part]),
                (ChannelSource::Target, Pixels::Bytes(mask)) => outputs.target_mask = Some(&mut mask[part]),
                (ChannelSource::Number(number), Pixels::Floats(numbers)) => {
                    outputs.on_request.push(OnRequest::Numbers(number, &mut numbers[part]));
                }
                (ChannelSource::Bytes(three), Pixels::Bytes(bytes)) => {
                    outputs.on_request.push(OnRequest::Bytes(three, &mut bytes[part]));
                }
                // `Pixels::new` makes no other pair.
                _ => {}
            }
        }
        outputs
    }
}

impl Pixels {
    fn new(element: Element, pixels: usize) -> Self {
        match element {
            Element::Float | Element::Pair => Self::Floats(vec![0.0; element.parts() * pixels]),
            Element::Id => Self::Ids(vec![0; pixels]),
            Element::Colour | Element::Label | Element::Flag | Element::Bytes => {
                Self::Bytes(vec![0; element.parts() * pixels])
            }
        }
    }

    /// The bytes; none of other types.
    pub fn bytes(&self) -> &[u8] {
        if let Self::Bytes(bytes) = self { bytes } else { &[] }
    }

    /// The numbers; none of other types.
    pub fn floats(&self) -> &[f32] {
        if let Self::Floats(floats) = self { floats } else { &[] }
    }

    /// The ids; none of other types.
    pub fn ids(&self) -> &[u32] {
        if let Self::Ids(ids) = self { ids } else { &[] }
    }

    fn copy(&mut self, other: &Self, part: &Range<usize>) {
        match (self, other) {
            (Self::Bytes(to), Self::Bytes(from)) => to[part.clone()].copy_from_slice(&from[part.clone()]),
            (Self::Floats(to), Self::Floats(from)) => to[part.clone()].copy_from_slice(&from[part.clone()]),
            (Self::Ids(to), Self::Ids(from)) => to[part.clone()].copy_from_slice(&from[part.clone()]),
            _ => {}
        }
    }

    fn wipe(&mut self, part: &Range<usize>) {
        match self {
            Self::Bytes(bytes) => bytes[part.clone()].fill(0),
            Self::Floats(floats) => floats[part.clone()].fill(0.0),
            Self::Ids(ids) => ids[part.clone()].fill(0),
        }
    }
}

/// The elements of a range of pixels of a channel.
fn elements(channel: &Channel, part: &Range<usize>) -> Range<usize> {
    let parts = channel.element().parts();
    parts * part.start..parts * part.end
}
