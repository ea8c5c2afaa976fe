//! The channels of a log: one writer with every topic declared, and messages appended by topic.

use super::{target_state, topic};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use foxglove::{Encode, Schema, messages};
use prost::Message;
use std::collections::BTreeMap;
use std::io::{Seek, Write};

/// About one 1280x720 frame of raw depth: one frame per chunk, so that readers can seek to a frame.
const CHUNK_BYTES: u64 = 4 << 20;
/// Levels above 1 gain nothing on depth and labels.
const ZSTD_LEVEL: u32 = 1;

/// An MCAP writer with all channels of [`topic`] declared.
pub struct ChannelWriter<W: Write + Seek> {
    writer: ::mcap::Writer<W>,
    channels: BTreeMap<&'static str, (u16, u32)>,
    buffer: Vec<u8>,
    messages: u64,
}

impl<W: Write + Seek> ChannelWriter<W> {
    /// Begins a log. `output` is only appended to. `with_previews` declares the preview topics.
    pub fn new(output: W, with_previews: bool) -> Result<Self> {
        let writer = ::mcap::WriteOptions::new()
            .library("cosfly")
            .profile("")
            .chunk_size(Some(CHUNK_BYTES))
            .compression(Some(::mcap::Compression::Zstd))
            .compression_level(ZSTD_LEVEL)
            .compression_threads(0)
            .disable_seeking(true)
            .create(output)
            .map_err(write_error)?;
        let mut this = Self { writer, channels: BTreeMap::new(), buffer: vec![], messages: 0 };
        this.declare_all(with_previews)?;
        Ok(this)
    }

    fn declare_all(&mut self, with_previews: bool) -> Result<()> {
        self.declare::<messages::CompressedImage>(topic::RGB, &[])?;
        self.declare::<messages::CameraCalibration>(topic::CAMERA, &[])?;
        self.declare::<messages::ImageAnnotations>(topic::ANNOTATIONS, &[])?;
        let depth = [("unit", "m"), ("depth", "planar, along the optical axis"), ("no_hit", "+inf")];
        self.declare::<messages::RawImage>(topic::DEPTH, &depth)?;
        self.declare::<messages::RawImage>(topic::SEMANTIC, &[("labels", "CARLA 0.9.14 and later")])?;
        let instance = [("0", "ground and sky"), ("1", "the target"), ("2 and more", "object id + 2")];
        self.declare::<messages::RawImage>(topic::INSTANCE, &instance)?;
        if with_previews {
            for preview in [topic::RGB_PREVIEW, topic::DEPTH_PREVIEW, topic::SEMANTIC_PREVIEW] {
                self.declare::<messages::CompressedImage>(preview, &[])?;
            }
        }
        self.declare::<messages::FrameTransforms>(topic::TF, &[])?;
        self.declare::<messages::PoseInFrame>(topic::DRONE_POSE, &[])?;
        self.declare::<messages::PoseInFrame>(topic::TARGET_POSE, &[])?;
        self.declare::<messages::PosesInFrame>(topic::DRONE_PATH, &[])?;
        self.declare::<messages::PosesInFrame>(topic::TARGET_PATH, &[])?;
        self.declare::<messages::SceneUpdate>(topic::SCENE, &[])?;
        self.declare::<messages::Log>(topic::CAPTIONS, &[])?;
        let state = Schema::new(target_state::SCHEMA_NAME, "protobuf", target_state::descriptor_set());
        self.declare_schema(topic::TARGET_STATE, &state, &[])
    }

    fn declare<M: Encode>(&mut self, topic: &'static str, notes: &[(&str, &str)]) -> Result<()> {
        let schema = M::get_schema().expect("every Foxglove message has a schema");
        self.declare_schema(topic, &schema, notes)
    }

    fn declare_schema(&mut self, topic: &'static str, schema: &Schema, notes: &[(&str, &str)]) -> Result<()> {
        let notes = notes.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
        let schema_id = self.writer.add_schema(&schema.name, &schema.encoding, &schema.data).map_err(write_error)?;
        let channel = self.writer.add_channel(schema_id, topic, "protobuf", &notes).map_err(write_error)?;
        self.channels.insert(topic, (channel, 0));
        Ok(())
    }

    /// Appends a message to the channel of `topic`.
    pub fn write(&mut self, topic: &'static str, time_ns: u64, message: &impl Message) -> Result<()> {
        let (channel_id, sequence) = self
            .channels
            .get_mut(topic)
            .ok_or_else(|| Diagnostic::new("mcap-channel", Fault::Bug, format!("topic `{topic}` was not declared")))?;
        *sequence += 1;
        self.buffer.clear();
        message.encode(&mut self.buffer).expect("a vector grows as needed");
        let header = ::mcap::records::MessageHeader {
            channel_id: *channel_id,
            sequence: *sequence,
            log_time: time_ns,
            publish_time: time_ns,
        };
        self.writer.write_to_known_channel(&header, &self.buffer).map_err(write_error)?;
        self.messages += 1;
        Ok(())
    }

    /// Appends a metadata record.
    pub fn metadata(&mut self, name: &str, entries: BTreeMap<String, String>) -> Result<()> {
        let record = ::mcap::records::Metadata { name: name.to_owned(), metadata: entries };
        self.writer.write_metadata(&record).map_err(write_error)
    }

    /// Writes the summary; gives the number of messages.
    pub fn finish(mut self) -> Result<u64> {
        self.writer.finish().map_err(write_error)?;
        Ok(self.messages)
    }
}

fn write_error(error: ::mcap::McapError) -> Box<Diagnostic> {
    match error {
        ::mcap::McapError::Io(error) => Diagnostic::io("write an MCAP log", &error),
        error => Diagnostic::new("mcap-write", Fault::Bug, "could not write an MCAP log").because(error),
    }
}
