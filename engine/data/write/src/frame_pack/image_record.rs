//! Raw images as records of a log, ready to be compressed: the common ground of the pack and of the log made from it.

use super::header::PackHeader;
use crate::message_head::message_head;
use cosfly_domain::Channel;
use cosfly_schema::log::messages::{OPTICAL_FRAME, timestamp};
use foxglove::messages::RawImage;
use prost::Message;

/// The record of a raw image: bytes before its pixels, pixels, bytes after them.
pub struct ImageRecord {
    /// The channel.
    pub channel: &'static Channel,
    number: u16,
    head: Vec<u8>,
    pixel_bytes: usize,
    tail: Vec<u8>,
}

/// Key of the field `data` in a protobuf message: field 6, length-delimited.
const DATA_KEY: u8 = 6 << 3 | 2;

impl ImageRecord {
    /// The record of one channel in one frame; `number` is the channel's in every log made from the pack.
    pub fn new(header: &PackHeader, (number, channel): (u16, &'static Channel), frame: usize) -> Self {
        let (time_ns, format) = (header.times().ns(frame), header.format_of(channel));
        let pixel_bytes = format.pixel_bytes * header.pixels();
        let front = RawImage {
            timestamp: Some(timestamp(time_ns)),
            width: header.width,
            height: header.height,
            encoding: format.encoding.into(),
            step: header.width * format.pixel_bytes as u32,
            ..RawImage::default()
        };
        // Fields stand in the order of their numbers; the frame's name comes after the data.
        let tail = RawImage { frame_id: OPTICAL_FRAME.into(), ..RawImage::default() }.encode_to_vec();
        let mut payload = front.encode_to_vec();
        payload.push(DATA_KEY);
        prost::encoding::encode_varint(pixel_bytes as u64, &mut payload);
        let length = payload.len() + pixel_bytes + tail.len();
        let mut head = message_head(number, frame as u32 + 1, time_ns, length).to_vec();
        head.append(&mut payload);
        Self { channel, number, head, pixel_bytes, tail }
    }

    /// Bytes of the whole record.
    pub fn len(&self) -> usize {
        self.head.len() + self.pixel_bytes + self.tail.len()
    }

    /// Place of the pixels within the record.
    pub fn pixels(&self) -> core::ops::Range<usize> {
        self.head.len()..self.head.len() + self.pixel_bytes
    }

    /// Writes everything but the pixels into `record`, which has [`Self::len`] bytes.
    pub fn write_frame(&self, record: &mut [u8]) {
        let pixels = self.pixels();
        record[..pixels.start].copy_from_slice(&self.head);
        record[pixels.end..].copy_from_slice(&self.tail);
    }
}

/// The records of the channels of a chunk in one frame, one after the other.
pub fn records_of(header: &PackHeader, channels: &[(u16, &'static Channel)], frame: usize) -> Vec<ImageRecord> {
    channels.iter().map(|channel| ImageRecord::new(header, *channel, frame)).collect()
}

/// Number of the channel and offset of each record.
pub fn messages_of(records: &[ImageRecord]) -> Vec<(u16, u64)> {
    let mut end = 0;
    let begins = records.iter().map(|record| {
        let begin = end;
        end += record.len() as u64;
        (record.number, begin)
    });
    begins.collect()
}

/// Bytes of all records.
pub fn length_of(records: &[ImageRecord]) -> usize {
    records.iter().map(ImageRecord::len).sum()
}
