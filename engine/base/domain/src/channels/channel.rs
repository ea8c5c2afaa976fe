//! The entry of a channel: name, meaning, element type, and how a pixel is drawn and checked.

use crate::TARGET_INSTANCE;
use cosfly_frames::DVec3;

/// A channel: one image per frame.
#[derive(Debug)]
pub struct Channel {
    /// Name in recipes, topics and files: lower-case letters and `_`.
    pub name: &'static str,
    /// Meaning with unit and frame, a sentence without its first capital.
    pub doc: &'static str,
    /// Origin of the pixels, and with it their element type.
    pub source: ChannelSource,
    /// Keys and texts that a log carries beside the channel's topic.
    pub notes: &'static [(&'static str, &'static str)],
    /// Whether the stored bytes of a pixel are a value of the channel, for channels on request; `cosfly verify` compares
    /// the channels of every frame with the tables instead.
    pub is_value: fn(&[u8]) -> bool,
}

/// Origin of a channel's pixels.
#[derive(Clone, Copy, Debug)]
pub enum ChannelSource {
    /// Shading: sRGB, three bytes a pixel; part of every frame.
    Colour,
    /// Planar depth, metres; part of every frame.
    Depth,
    /// CARLA label ids; part of every frame.
    Labels,
    /// Instance ids; part of every frame.
    Ids,
    /// Whether the pixel is of the target, drawn where somebody asks for the channel.
    Target,
    /// Whether the pixel is of the target or of what hides it, drawn in films where somebody asks for the channel.
    TargetAlone,
    /// A number for each pixel, drawn where somebody asks for the channel.
    Number(fn(&SeenPoint) -> f32),
    /// Three bytes for each pixel, drawn where somebody asks for the channel.
    Bytes(fn(&SeenPoint) -> [u8; 3]),
    /// Way of the point at the pixel centre to its place in a neighbouring frame, pixels: right and down; drawn in films
    /// where somebody asks for the channel.
    Flow(FlowTo),
    /// Whether the neighbouring frame shows that point; drawn as the flow is.
    FlowValid(FlowTo),
    /// A number for each pixel that needs more than the point there; drawn in films where somebody asks for the channel.
    FilmNumber,
}

/// A frame beside another one of a film.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FlowTo {
    /// The frame before.
    Previous,
    /// The frame after.
    Next,
}

/// Element type of a pixel as it is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Element {
    /// Three bytes, stored as an image file.
    Colour,
    /// A 32-bit float.
    Float,
    /// A label id, one byte.
    Label,
    /// An instance id, two or four bytes.
    Id,
    /// 0 or 1, one byte.
    Flag,
    /// Three bytes.
    Bytes,
    /// Two 32-bit floats.
    Pair,
}

/// The surface that is nearest at a pixel centre. World frame.
#[derive(Clone, Copy, Debug)]
pub struct SeenPoint {
    /// Planar depth, metres; infinite for the sky.
    pub depth_m: f32,
    /// CARLA label id.
    pub label: u8,
    /// Instance id.
    pub instance: u32,
    /// Unit normal of the surface on the camera's side; zero for the sky.
    pub normal_in_world: DVec3,
    /// Direction from the camera through the pixel centre, of length 1 along the optical axis: the surface is at
    /// `camera_in_world + depth_m * ray_in_world`.
    pub ray_in_world: DVec3,
    /// Position of the camera, metres.
    pub camera_in_world: DVec3,
}

impl Channel {
    /// Element type of the pixels.
    pub fn element(&self) -> Element {
        match self.source {
            ChannelSource::Colour => Element::Colour,
            ChannelSource::Depth | ChannelSource::Number(_) | ChannelSource::FilmNumber => Element::Float,
            ChannelSource::Labels => Element::Label,
            ChannelSource::Ids => Element::Id,
            ChannelSource::Target | ChannelSource::TargetAlone | ChannelSource::FlowValid(_) => Element::Flag,
            ChannelSource::Bytes(_) => Element::Bytes,
            ChannelSource::Flow(_) => Element::Pair,
        }
    }

    /// Whether the channel is drawn only where a recipe or an environment asks for it.
    pub fn is_on_request(&self) -> bool {
        use ChannelSource::{Colour, Depth, Ids, Labels};
        !matches!(self.source, Colour | Depth | Labels | Ids)
    }

    /// Whether a pixel needs more than the point at its centre, such as other pixels or frames: films have the channel,
    /// environments do not.
    pub fn is_of_films(&self) -> bool {
        use ChannelSource::{FilmNumber, Flow, FlowValid, TargetAlone};
        matches!(self.source, TargetAlone | Flow(_) | FlowValid(_) | FilmNumber)
    }

    /// Whether the values are lengths in pixels of the picture, which change where it is scaled.
    pub fn is_in_pixels(&self) -> bool {
        self.notes.contains(&("unit", "px"))
    }

    /// Whether a log may hold small pictures of the channel: of all but ids, whose numbers are no picture.
    pub fn has_previews(&self) -> bool {
        self.element() != Element::Id
    }

    /// Writes the stored bytes of one pixel of a channel on request; `pixel` has [`Self::bytes_on_request`] bytes. Channels
    /// of films are drawn by films.
    pub fn draw(&self, point: &SeenPoint, pixel: &mut [u8]) {
        match self.source {
            ChannelSource::Target => pixel.fill(u8::from(point.instance == TARGET_INSTANCE)),
            ChannelSource::Number(number) => pixel.copy_from_slice(&number(point).to_le_bytes()),
            ChannelSource::Bytes(three) => pixel.copy_from_slice(&three(point)),
            _ => {}
        }
    }

    /// Bytes of a pixel of a channel on request; 0 for the channels of every frame.
    pub fn bytes_on_request(&self) -> usize {
        match self.source {
            ChannelSource::Target | ChannelSource::TargetAlone | ChannelSource::FlowValid(_) => 1,
            ChannelSource::Number(_) | ChannelSource::FilmNumber => 4,
            ChannelSource::Bytes(_) => 3,
            ChannelSource::Flow(_) => 8,
            _ => 0,
        }
    }
}

impl Element {
    /// Number of values in a pixel.
    pub fn parts(self) -> usize {
        match self {
            Self::Colour | Self::Bytes => 3,
            Self::Pair => 2,
            Self::Float | Self::Label | Self::Id | Self::Flag => 1,
        }
    }
}

impl PartialEq for Channel {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Eq for Channel {}
