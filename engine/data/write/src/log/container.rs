//! The MCAP container: records, chunks that may come ready compressed, and the index at the end.
//!
//! The `mcap` crate compresses every chunk itself. Pictures are compressed when they are drawn and go into the log as they
//! are, so that nothing is compressed twice. Layout: <https://mcap.dev/spec>. Everything is little-endian.

use std::collections::BTreeMap;
use std::io::{Result, Write};

const MAGIC: &[u8; 8] = b"\x89MCAP0\r\n";

/// Kinds of records.
mod opcode {
    pub const HEADER: u8 = 0x01;
    pub const FOOTER: u8 = 0x02;
    pub const SCHEMA: u8 = 0x03;
    pub const CHANNEL: u8 = 0x04;
    pub const CHUNK: u8 = 0x06;
    pub const MESSAGE_INDEX: u8 = 0x07;
    pub const CHUNK_INDEX: u8 = 0x08;
    pub const STATISTICS: u8 = 0x0b;
    pub const METADATA: u8 = 0x0c;
    pub const METADATA_INDEX: u8 = 0x0d;
    pub const SUMMARY_OFFSET: u8 = 0x0e;
    pub const DATA_END: u8 = 0x0f;
}

/// Message records, compressed or not, in the order of their times.
pub struct Chunk<'a> {
    /// `zstd`, or nothing.
    pub compression: &'static str,
    /// Bytes of the records before compression, and their CRC-32.
    pub plain_bytes: u64,
    /// See `plain_bytes`.
    pub plain_crc: u32,
    /// The records as they are stored.
    pub stored: &'a [u8],
    /// CRC-32 of them.
    pub stored_crc: u32,
    /// The messages.
    pub messages: &'a [Indexed],
}

/// Place of a message in a chunk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Indexed {
    /// Channel.
    pub channel: u16,
    /// Time.
    pub time_ns: u64,
    /// Offset of the record before compression.
    pub offset: u64,
}

/// Bytes of the record of an uncompressed chunk before its records: opcode, length, two times, size, checksum, empty name of
/// the compression, stored size.
const PLAIN_CHUNK_HEAD_BYTES: u64 = 1 + 8 + 8 + 8 + 8 + 4 + 4 + 8;

/// Writes one file. Without [`Self::finish`] it has no index, and readers say that it was cut short.
pub struct Container<W: Write> {
    output: W,
    position: u64,
    crc: crc32fast::Hasher,
    schemas: Vec<Vec<u8>>,
    channels: Vec<Vec<u8>>,
    chunk_indexes: Vec<Vec<u8>>,
    metadata_indexes: Vec<Vec<u8>>,
    counts: BTreeMap<u16, u64>,
    times_ns: Option<[u64; 2]>,
}

impl<W: Write> Container<W> {
    /// Begins a file.
    pub fn new(output: W, library: &str) -> Result<Self> {
        let mut container = Self {
            output,
            position: 0,
            crc: crc32fast::Hasher::new(),
            schemas: vec![],
            channels: vec![],
            chunk_indexes: vec![],
            metadata_indexes: vec![],
            counts: BTreeMap::new(),
            times_ns: None,
        };
        container.put(MAGIC)?;
        let header = Fields::default().text("").text(library);
        container.record(opcode::HEADER, &header.0)?;
        Ok(container)
    }

    /// Declares a schema; gives its id.
    pub fn schema(&mut self, name: &str, encoding: &str, data: &[u8]) -> Result<u16> {
        let id = self.schemas.len() as u16 + 1;
        self.schemas.push(Fields::default().u16(id).text(name).text(encoding).bytes(data).0);
        self.record(opcode::SCHEMA, &self.schemas[usize::from(id) - 1].clone())?;
        Ok(id)
    }

    /// Declares a channel; gives its id: 1 for the first, and so on.
    pub fn channel(&mut self, schema: u16, topic: &str, encoding: &str, notes: &[(&str, &str)]) -> Result<u16> {
        let id = self.channels.len() as u16 + 1;
        let notes = notes.iter().fold(Fields::default(), |all, (key, value)| all.text(key).text(value));
        self.channels.push(Fields::default().u16(id).u16(schema).text(topic).text(encoding).bytes(&notes.0).0);
        self.record(opcode::CHANNEL, &self.channels[usize::from(id) - 1].clone())?;
        self.counts.insert(id, 0);
        Ok(id)
    }

    /// Appends a metadata record.
    pub fn metadata(&mut self, name: &str, entries: &BTreeMap<String, String>) -> Result<()> {
        let entries = entries.iter().fold(Fields::default(), |all, (key, value)| all.text(key).text(value));
        let content = Fields::default().text(name).bytes(&entries.0).0;
        let length = content.len() as u64 + 9;
        self.metadata_indexes.push(Fields::default().u64(self.position).u64(length).text(name).0);
        self.record(opcode::METADATA, &content)
    }

    /// Number of bytes before the records of the next chunk, if that one is not compressed.
    pub fn start_of_plain_records(&self) -> u64 {
        self.position + PLAIN_CHUNK_HEAD_BYTES
    }

    /// Appends a chunk and the index of its messages.
    pub fn chunk(&mut self, chunk: &Chunk<'_>) -> Result<()> {
        let start = self.position;
        let time_ns = |message: Option<&Indexed>| message.map_or(0, |message| message.time_ns);
        let times_ns = [time_ns(chunk.messages.first()), time_ns(chunk.messages.last())];
        let head = Fields::default()
            .u64(times_ns[0])
            .u64(times_ns[1])
            .u64(chunk.plain_bytes)
            .u32(chunk.plain_crc)
            .text(chunk.compression)
            .u64(chunk.stored.len() as u64);
        self.put(&[opcode::CHUNK])?;
        self.put(&((head.0.len() + chunk.stored.len()) as u64).to_le_bytes())?;
        self.put(&head.0)?;
        self.output.write_all(chunk.stored)?;
        self.crc.combine(&crc32fast::Hasher::new_with_initial_len(chunk.stored_crc, chunk.stored.len() as u64));
        self.position += chunk.stored.len() as u64;
        let length = self.position - start;
        let mut by_channel: BTreeMap<u16, Fields> = BTreeMap::new();
        for Indexed { channel, time_ns, offset } in chunk.messages {
            let entries = by_channel.remove(channel).unwrap_or_default();
            by_channel.insert(*channel, entries.u64(*time_ns).u64(*offset));
            *self.counts.entry(*channel).or_default() += 1;
        }
        let indexes_start = self.position;
        let mut offsets = Fields::default();
        for (channel, entries) in by_channel {
            offsets = offsets.u16(channel).u64(self.position);
            self.record(opcode::MESSAGE_INDEX, &Fields::default().u16(channel).bytes(&entries.0).0)?;
        }
        let index = Fields::default()
            .u64(times_ns[0])
            .u64(times_ns[1])
            .u64(start)
            .u64(length)
            .bytes(&offsets.0)
            .u64(self.position - indexes_start)
            .text(chunk.compression)
            .u64(chunk.stored.len() as u64)
            .u64(chunk.plain_bytes);
        self.chunk_indexes.push(index.0);
        let [first, last] = self.times_ns.unwrap_or(times_ns);
        self.times_ns = Some([first.min(times_ns[0]), last.max(times_ns[1])]);
        Ok(())
    }

    /// Writes the summary; gives the number of messages.
    pub fn finish(mut self) -> Result<u64> {
        let crc = self.crc.clone().finalize();
        self.record(opcode::DATA_END, &crc.to_le_bytes())?;
        self.crc = crc32fast::Hasher::new();
        let summary_start = self.position;
        let groups = [
            (opcode::SCHEMA, core::mem::take(&mut self.schemas)),
            (opcode::CHANNEL, core::mem::take(&mut self.channels)),
            (opcode::STATISTICS, vec![]),
            (opcode::CHUNK_INDEX, core::mem::take(&mut self.chunk_indexes)),
            (opcode::METADATA_INDEX, core::mem::take(&mut self.metadata_indexes)),
        ];
        let sizes = [0, 1, 3, 4].map(|group: usize| groups[group].1.len() as u32);
        let mut offsets = vec![];
        for (kind, records) in groups {
            let start = self.position;
            if kind == opcode::STATISTICS {
                self.record(kind, &self.statistics(sizes))?;
            }
            records.iter().try_for_each(|content| self.record(kind, content))?;
            if self.position > start {
                offsets.push(Fields(vec![kind]).u64(start).u64(self.position - start).0);
            }
        }
        let offsets_start = self.position;
        offsets.iter().try_for_each(|content| self.record(opcode::SUMMARY_OFFSET, content))?;
        let footer = Fields::default().u64(summary_start).u64(offsets_start);
        self.put(&[opcode::FOOTER])?;
        self.put(&(footer.0.len() as u64 + 4).to_le_bytes())?;
        self.put(&footer.0)?;
        let crc = self.crc.clone().finalize();
        self.put(&crc.to_le_bytes())?;
        self.put(MAGIC)?;
        self.output.flush()?;
        Ok(self.counts.values().sum())
    }

    fn statistics(&self, [schemas, channels, chunks, metadata]: [u32; 4]) -> Vec<u8> {
        let [first, last] = self.times_ns.unwrap_or_default();
        let counts = self.counts.iter().filter(|(_, count)| **count > 0);
        let counts = counts.fold(Fields::default(), |all, (channel, count)| all.u16(*channel).u64(*count));
        Fields::default()
            .u64(self.counts.values().sum())
            .u16(schemas as u16)
            .u32(channels)
            .u32(0)
            .u32(metadata)
            .u32(chunks)
            .u64(first)
            .u64(last)
            .bytes(&counts.0)
            .0
    }

    fn record(&mut self, kind: u8, content: &[u8]) -> Result<()> {
        self.put(&[kind])?;
        self.put(&(content.len() as u64).to_le_bytes())?;
        self.put(content)
    }

    fn put(&mut self, bytes: &[u8]) -> Result<()> {
        self.output.write_all(bytes)?;
        self.crc.update(bytes);
        self.position += bytes.len() as u64;
        Ok(())
    }
}

/// The content of a record, field by field.
#[derive(Default)]
struct Fields(Vec<u8>);

impl Fields {
    fn u16(mut self, value: u16) -> Self {
        self.0.extend_from_slice(&value.to_le_bytes());
        self
    }

    fn u32(mut self, value: u32) -> Self {
        self.0.extend_from_slice(&value.to_le_bytes());
        self
    }

    fn u64(mut self, value: u64) -> Self {
        self.0.extend_from_slice(&value.to_le_bytes());
        self
    }

    /// Length, then the bytes: arrays and maps, too.
    fn bytes(self, bytes: &[u8]) -> Self {
        let mut all = self.u32(bytes.len() as u32);
        all.0.extend_from_slice(bytes);
        all
    }

    fn text(self, text: &str) -> Self {
        self.bytes(text.as_bytes())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::message_head::{MESSAGE_HEAD_BYTES, message_head};
    use ::mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};

    fn file() -> Vec<u8> {
        let mut bytes = vec![];
        let mut container = Container::new(&mut bytes, "tester").unwrap();
        let schema = container.schema("shape", "protobuf", b"schema bytes").unwrap();
        let plain = container.channel(schema, "/plain", "protobuf", &[("unit", "m")]).unwrap();
        let packed = container.channel(schema, "/packed", "protobuf", &[]).unwrap();
        container.metadata("about", &BTreeMap::from([("key".to_owned(), "value".to_owned())])).unwrap();
        for frame in 0..3u32 {
            let time_ns = 10 * u64::from(frame);
            let mut records = vec![];
            for payload in [&b"one"[..], b"number two"] {
                records.extend_from_slice(&message_head(plain, frame + 1, time_ns, payload.len()));
                records.extend_from_slice(payload);
            }
            let second = (MESSAGE_HEAD_BYTES + 3) as u64;
            let at = |channel: u16, offset: u64| Indexed { channel, time_ns, offset };
            let chunk = |compression, stored, messages| Chunk {
                compression,
                plain_bytes: records.len() as u64,
                plain_crc: crc32fast::hash(&records),
                stored,
                stored_crc: crc32fast::hash(&records),
                messages,
            };
            container.chunk(&chunk("", &records, &[at(plain, 0), at(plain, second)])).unwrap();
            records.clear();
            records.extend_from_slice(&message_head(packed, frame + 1, time_ns, 1000));
            records.resize(MESSAGE_HEAD_BYTES + 1000, 7);
            let stored = zstd::bulk::compress(&records, 1).unwrap();
            let chunk = Chunk {
                compression: "zstd",
                plain_bytes: records.len() as u64,
                plain_crc: crc32fast::hash(&records),
                stored: &stored,
                stored_crc: crc32fast::hash(&stored),
                messages: &[at(packed, 0)],
            };
            container.chunk(&chunk).unwrap();
        }
        assert_eq!(container.finish().unwrap(), 9);
        bytes
    }

    /// Reads every record and every check with the `mcap` crate.
    fn check_all(bytes: &[u8]) -> std::result::Result<(), String> {
        let options = LinearReaderOptions::default()
            .with_prevalidate_chunk_crcs(true)
            .with_validate_data_section_crc(true)
            .with_validate_summary_section_crc(true)
            .with_record_length_limit(1 << 20);
        let mut reader = LinearReader::new_with_options(options);
        let mut left = bytes;
        while let Some(event) = reader.next_event() {
            match event.map_err(|error| error.to_string())? {
                LinearReadEvent::ReadRequest(wanted) => {
                    let length = wanted.min(left.len());
                    reader.insert(wanted)[..length].copy_from_slice(&left[..length]);
                    reader.notify_read(length);
                    left = &left[length..];
                }
                LinearReadEvent::Record { data, opcode } => {
                    ::mcap::parse_record(opcode, data).map_err(|error| error.to_string())?;
                }
            }
        }
        if left.is_empty() { Ok(()) } else { Err(format!("{} bytes left", left.len())) }
    }

    #[test]
    fn another_library_agrees_with_every_check_and_with_the_summary() {
        let bytes = file();
        check_all(&bytes).unwrap();
        let summary = ::mcap::Summary::read(&bytes).unwrap().unwrap();
        let statistics = summary.stats.unwrap();
        assert_eq!((statistics.message_count, statistics.chunk_count, statistics.metadata_count), (9, 6, 1));
        assert_eq!((statistics.message_start_time, statistics.message_end_time), (0, 20));
        assert_eq!(statistics.channel_message_counts, BTreeMap::from([(1, 6), (2, 3)]));
        assert_eq!(summary.channels[&1].metadata["unit"], "m");
        assert_eq!(summary.channels[&2].schema.as_ref().unwrap().name, "shape");
        assert_eq!(summary.metadata_indexes[0].name, "about");
        assert_eq!(summary.chunk_indexes.len(), 6);
        let messages: Vec<_> = ::mcap::MessageStream::new(&bytes).unwrap().map(|message| message.unwrap()).collect();
        assert_eq!(messages[1].data.as_ref(), b"number two");
        assert_eq!(
            (messages[8].channel.topic.as_str(), messages[8].log_time, messages[8].sequence),
            ("/packed", 20, 3)
        );
    }

    #[test]
    fn the_index_leads_to_each_message_and_to_no_other_chunk() {
        let bytes = file();
        let summary = ::mcap::Summary::read(&bytes).unwrap().unwrap();
        for index in &summary.chunk_indexes {
            let channels: Vec<u16> = index.message_index_offsets.keys().copied().collect();
            assert_eq!(channels, [if index.compression.is_empty() { 1 } else { 2 }]);
            for (channel, entries) in summary.read_message_indexes(&bytes, index).unwrap() {
                for entry in entries {
                    let message = summary.seek_message(&bytes, index, &entry).unwrap();
                    assert_eq!((message.channel.id, message.log_time), (channel.id, entry.log_time));
                }
            }
        }
    }

    #[test]
    fn a_flipped_byte_is_noticed() {
        let whole = file();
        for at in (8..whole.len() - 8).step_by(53) {
            let mut bytes = whole.clone();
            bytes[at] ^= 1;
            assert!(check_all(&bytes).is_err(), "byte {at}");
        }
    }
}
