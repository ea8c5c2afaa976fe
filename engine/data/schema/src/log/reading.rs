//! Topics and messages of sensors that are no cameras: `/sensor/NAME`, one double for each quantity.

use super::own_message;
use super::topic::{Frequency, Topic};
use foxglove::Schema;
use prost::bytes::{Buf, BufMut};
use prost::encoding::{DecodeContext, WireType, double, skip_field};
use prost::{DecodeError, Message};
use prost_types::FileDescriptorSet;
use prost_types::field_descriptor_proto::Type;

/// Beginning of the topics.
pub const TOPICS: &str = "/sensor/";

/// Beginning of the names of quantities without errors, which no sensor measures.
pub const TRUE: &str = "true_";

/// A sensor in a log.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LoggedSensor {
    /// Name: the rest of the topic's name, and that of the messages' type in the package `cosfly`.
    pub name: String,
    /// Names of the quantities, in their order.
    pub quantities: Vec<String>,
}

impl LoggedSensor {
    /// Name of the topic.
    pub fn topic_name(&self) -> String {
        format!("{TOPICS}{}", self.name)
    }

    /// Places and names of the quantities that it measures: all but the true ones.
    pub fn measured(&self) -> impl Iterator<Item = (usize, &String)> {
        self.quantities.iter().enumerate().filter(|(_, name)| !name.starts_with(TRUE))
    }

    /// The topic.
    pub fn topic(&self) -> Topic {
        let fields: Vec<_> = self.quantities.iter().map(|name| (name.as_str(), Type::Double, false, "")).collect();
        let schema = format!("cosfly.{}", self.name);
        Topic {
            name: self.topic_name(),
            doc: format!("`{schema}`: readings of the sensor."),
            schema: Schema::new(schema, "protobuf", own_message::descriptor_set(&self.name, &fields)),
            notes: &[],
            frequency: Frequency::Readings,
        }
    }

    /// The sensor of a topic, whose messages have this schema; `None` for other topics.
    pub fn of(topic: &str, schema: &[u8]) -> Option<Self> {
        let is_name =
            |name: &&str| name.bytes().all(|byte| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'_');
        let name = topic.strip_prefix(TOPICS).filter(is_name)?.to_owned();
        let file = FileDescriptorSet::decode(schema).ok()?.file.into_iter().next()?;
        let message = file.message_type.into_iter().find(|message| message.name() == name)?;
        let quantities = message.field.iter().map(|field| field.name().to_owned()).collect();
        Some(Self { name, quantities })
    }
}

/// A reading: a number for each quantity, field 1 and on.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReadingMessage(pub Vec<f64>);

impl Message for ReadingMessage {
    fn encode_raw(&self, buffer: &mut impl BufMut) {
        (1..).zip(&self.0).for_each(|(tag, value)| double::encode(tag, value, buffer));
    }

    fn merge_field(
        &mut self,
        tag: u32,
        wire_type: WireType,
        buffer: &mut impl Buf,
        context: DecodeContext,
    ) -> Result<(), DecodeError> {
        match self.0.get_mut(tag as usize - 1) {
            Some(value) => double::merge(wire_type, value, buffer, context),
            None => skip_field(wire_type, tag, buffer, context),
        }
    }

    fn encoded_len(&self) -> usize {
        (1..).zip(&self.0).map(|(tag, value)| double::encoded_len(tag, value)).sum()
    }

    fn clear(&mut self) {
        self.0.fill(0.0);
    }
}

impl ReadingMessage {
    /// The numbers of a message with `count` quantities; one that is not there is 0.
    ///
    /// # Errors
    /// Bytes that are no message.
    pub fn numbers(count: usize, bytes: &[u8]) -> Result<Vec<f64>, DecodeError> {
        let mut message = Self(vec![0.0; count]);
        message.merge(bytes)?;
        Ok(message.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reading_and_its_topic_are_read_back() {
        let quantities = ["range_m", "is_hit"].map(str::to_owned).to_vec();
        let sensor = LoggedSensor { name: "laser_altimeter".into(), quantities };
        let topic = sensor.topic();
        assert_eq!(
            (topic.name.as_str(), topic.schema.name.as_str()),
            ("/sensor/laser_altimeter", "cosfly.laser_altimeter")
        );
        assert_eq!(LoggedSensor::of(&topic.name, &topic.schema.data), Some(sensor));
        assert_eq!(LoggedSensor::of("/tf", &topic.schema.data), None);
        assert_eq!(LoggedSensor::of("/sensor/other", b"no descriptor"), None);
        let message = ReadingMessage(vec![12.5, 0.0]);
        assert_eq!(ReadingMessage::numbers(2, &message.encode_to_vec()), Ok(message.0.clone()));
        assert_eq!(ReadingMessage::numbers(1, &message.encode_to_vec()), Ok(vec![12.5]));
        assert!(ReadingMessage::numbers(2, &[0xff]).is_err());
    }
}
