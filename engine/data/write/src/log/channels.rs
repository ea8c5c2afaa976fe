//! The topics of a log: one writer with every topic declared, and messages appended by topic.

use super::container::{Chunk, Container, Indexed};
use crate::frame_pack::PackedChunk;
use crate::message_head::message_head;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_schema::log::Topic;
use prost::Message;
use std::collections::BTreeMap;
use std::io::Write;

/// Level of what is written once; pictures are compressed in the frame pack.
const ZSTD_LEVEL: i32 = 3;

/// An MCAP writer with all topics declared. Messages gather until a chunk is ended.
pub struct ChannelWriter<W: Write> {
    container: Container<W>,
    schemas: BTreeMap<String, u16>,
    channels: BTreeMap<String, (u16, u32)>,
    /// Records of the chunk that is not ended, and their places.
    records: Vec<u8>,
    messages: Vec<Indexed>,
}

impl<W: Write> ChannelWriter<W> {
    /// Begins a log with these topics. `output` is only appended to.
    ///
    /// # Errors
    /// The output cannot be written.
    pub fn new(output: W, topics: &[Topic]) -> Result<Self> {
        let container = Container::new(output, "cosfly").map_err(|error| write_error(&error))?;
        let (schemas, channels, records, messages) = (BTreeMap::new(), BTreeMap::new(), vec![], vec![]);
        let mut this = Self { container, schemas, channels, records, messages };
        topics.iter().try_for_each(|topic| this.declare(topic))?;
        Ok(this)
    }

    fn declare(&mut self, topic: &Topic) -> Result<()> {
        let refused = |error: std::io::Error| write_error(&error);
        let schema = &topic.schema;
        let schema_id = match self.schemas.get(&schema.name) {
            Some(id) => *id,
            None => {
                let id = self.container.schema(&schema.name, &schema.encoding, &schema.data).map_err(refused)?;
                self.schemas.insert(schema.name.clone(), id);
                id
            }
        };
        let channel = self.container.channel(schema_id, &topic.name, "protobuf", topic.notes).map_err(refused)?;
        self.channels.insert(topic.name.clone(), (channel, 0));
        Ok(())
    }

    /// Adds a message to the chunk. Times do not fall.
    pub fn write(&mut self, topic: &str, time_ns: u64, message: &impl Message) -> Result<()> {
        let (channel, sequence) = self
            .channels
            .get_mut(topic)
            .ok_or_else(|| Diagnostic::new("mcap-channel", Fault::Bug, format!("topic `{topic}` was not declared")))?;
        *sequence += 1;
        self.messages.push(Indexed { channel: *channel, time_ns, offset: self.records.len() as u64 });
        self.records.extend_from_slice(&message_head(*channel, *sequence, time_ns, message.encoded_len()));
        message.encode(&mut self.records).expect("a vector grows as needed");
        Ok(())
    }

    /// Number of bytes of the log before `content`, a part of the last message, if the chunk is ended as it is; `None` where
    /// the message has no such part.
    pub fn offset_of(&self, content: &[u8]) -> Option<u64> {
        let start = self.messages.last()?.offset;
        let message = self.records.get(usize::try_from(start).ok()?..)?;
        let at = message.windows(content.len().max(1)).position(|it| it == content)?;
        Some(self.container.start_of_plain_records() + start + at as u64)
    }

    /// Ends the chunk as it is: image files do not get smaller.
    pub fn end_plain_chunk(&mut self) -> Result<()> {
        let crc = crc32fast::hash(&self.records);
        let chunk = Chunk {
            compression: "",
            plain_bytes: self.records.len() as u64,
            plain_crc: crc,
            stored: &self.records,
            stored_crc: crc,
            messages: &self.messages,
        };
        self.container.chunk(&chunk).map_err(|error| write_error(&error))?;
        self.records.clear();
        self.messages.clear();
        Ok(())
    }

    /// Ends the chunk and compresses it.
    pub fn end_compressed_chunk(&mut self) -> Result<()> {
        let stored = zstd::bulk::compress(&self.records, ZSTD_LEVEL).map_err(|error| write_error(&error))?;
        let chunk = Chunk {
            compression: "zstd",
            plain_bytes: self.records.len() as u64,
            plain_crc: crc32fast::hash(&self.records),
            stored: &stored,
            stored_crc: crc32fast::hash(&stored),
            messages: &self.messages,
        };
        self.container.chunk(&chunk).map_err(|error| write_error(&error))?;
        self.records.clear();
        self.messages.clear();
        Ok(())
    }

    /// Appends a chunk of a frame pack as it is.
    pub fn packed_chunk(&mut self, time_ns: u64, packed: &PackedChunk) -> Result<()> {
        let indexed = |&(channel, offset): &(u16, u64)| Indexed { channel, time_ns, offset };
        let messages: Vec<Indexed> = packed.messages.iter().map(indexed).collect();
        let chunk = Chunk {
            compression: "zstd",
            plain_bytes: packed.plain_bytes,
            plain_crc: packed.plain_crc,
            stored: &packed.stored,
            stored_crc: packed.stored_crc,
            messages: &messages,
        };
        self.container.chunk(&chunk).map_err(|error| write_error(&error))
    }

    /// Appends a metadata record.
    pub fn metadata(&mut self, name: &str, entries: &BTreeMap<String, String>) -> Result<()> {
        self.container.metadata(name, entries).map_err(|error| write_error(&error))
    }

    /// Writes the summary; gives the number of messages.
    pub fn finish(self) -> Result<u64> {
        self.container.finish().map_err(|error| write_error(&error))
    }
}

fn write_error(error: &std::io::Error) -> Box<Diagnostic> {
    Diagnostic::io("write an MCAP log", error)
}
