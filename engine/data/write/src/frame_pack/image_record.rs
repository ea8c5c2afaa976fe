//! Raw images as records of a log, ready to be compressed: what the pack and the log made from it agree on.

use super::PackHeader;
use crate::log::message_head;
use cosfly_schema::log::frame_time_ns;
use cosfly_schema::log::messages::{OPTICAL_FRAME, timestamp};
use foxglove::messages::RawImage;
use prost::Message;

/// One of [`cosfly_schema::log::topic::PACKED`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RawChannel {
    /// Depth, 32-bit floats.
    Depth,
    /// Label ids, bytes.
    Semantic,
    /// Instance ids.
    Instance,
}

impl RawChannel {
    /// Its id in every log.
    pub fn id(self) -> u16 {
        match self {
            Self::Depth => 1,
            Self::Semantic => 2,
            Self::Instance => 3,
        }
    }

    /// Bytes of a pixel.
    pub fn pixel_bytes(self, header: &PackHeader) -> usize {
        match self {
            Self::Depth => 4,
            Self::Semantic => 1,
            Self::Instance => header.instance.bytes(),
        }
    }

    fn encoding(self, header: &PackHeader) -> &'static str {
        match self {
            Self::Depth => "32FC1",
            Self::Semantic => "mono8",
            Self::Instance => header.instance.encoding(),
        }
    }
}

/// The record of a raw image: bytes before its pixels, pixels, bytes after them.
pub struct ImageRecord {
    head: Vec<u8>,
    pixel_bytes: usize,
    tail: Vec<u8>,
}

/// Key of the field `data` in a protobuf message: field 6, length-delimited.
const DATA_KEY: u8 = 6 << 3 | 2;

impl ImageRecord {
    /// The record of one channel in one frame.
    pub fn new(header: &PackHeader, channel: RawChannel, frame: usize) -> Self {
        let time_ns = frame_time_ns(header.dt_s, frame);
        let pixel_bytes = channel.pixel_bytes(header) * header.pixels();
        let front = RawImage {
            timestamp: Some(timestamp(time_ns)),
            width: header.width,
            height: header.height,
            encoding: channel.encoding(header).into(),
            step: header.width * channel.pixel_bytes(header) as u32,
            ..RawImage::default()
        };
        // Fields stand in the order of their numbers; the frame's name comes after the data.
        let tail = RawImage { frame_id: OPTICAL_FRAME.into(), ..RawImage::default() }.encode_to_vec();
        let mut payload = front.encode_to_vec();
        payload.push(DATA_KEY);
        prost::encoding::encode_varint(pixel_bytes as u64, &mut payload);
        let length = payload.len() + pixel_bytes + tail.len();
        let mut head = message_head(channel.id(), frame as u32 + 1, time_ns, length).to_vec();
        head.append(&mut payload);
        Self { head, pixel_bytes, tail }
    }

    /// Bytes of the whole record.
    pub fn len(&self) -> usize {
        self.head.len() + self.pixel_bytes + self.tail.len()
    }

    /// Where its pixels lie.
    pub fn pixels(&self) -> core::ops::Range<usize> {
        self.head.len()..self.head.len() + self.pixel_bytes
    }

    /// Writes everything but the pixels into `record`, which has [`Self::len`] bytes; gives the room for the pixels.
    pub fn frame_of<'a>(&self, record: &'a mut [u8]) -> &'a mut [u8] {
        let (head, rest) = record.split_at_mut(self.head.len());
        let (pixels, tail) = rest.split_at_mut(self.pixel_bytes);
        head.copy_from_slice(&self.head);
        tail.copy_from_slice(&self.tail);
        pixels
    }
}

/// The records of a chunk and where they begin.
pub struct ChunkRecords<const N: usize> {
    /// One after the other.
    pub records: [ImageRecord; N],
    /// Channel and offset of each.
    pub messages: Vec<(u16, u64)>,
}

impl<const N: usize> ChunkRecords<N> {
    /// The records of these channels in one frame.
    pub fn new(header: &PackHeader, channels: [RawChannel; N], frame: usize) -> Self {
        let records = channels.map(|channel| ImageRecord::new(header, channel, frame));
        let mut end = 0;
        let begins = records.iter().map(|record| {
            let begin = end;
            end += record.len() as u64;
            begin
        });
        let messages = channels.iter().map(|channel| channel.id()).zip(begins).collect();
        Self { records, messages }
    }

    /// Bytes of all of them.
    pub fn len(&self) -> usize {
        self.records.iter().map(ImageRecord::len).sum()
    }
}

/// The depth chunk of a frame.
pub fn depth_records(header: &PackHeader, frame: usize) -> ChunkRecords<1> {
    ChunkRecords::new(header, [RawChannel::Depth], frame)
}

/// The chunk of both id images of a frame.
pub fn id_records(header: &PackHeader, frame: usize) -> ChunkRecords<2> {
    ChunkRecords::new(header, [RawChannel::Semantic, RawChannel::Instance], frame)
}
