//! The bytes of an MCAP message record before its payload. Layout: <https://mcap.dev/spec>; everything is little-endian.

/// Kind of a message record.
const MESSAGE: u8 = 0x05;

/// Bytes of a message record before its payload: opcode, length, channel, sequence, two times.
pub const MESSAGE_HEAD_BYTES: usize = 31;

/// The head of a message record; its payload of `payload_bytes` bytes follows.
pub fn message_head(channel: u16, sequence: u32, time_ns: u64, payload_bytes: usize) -> [u8; MESSAGE_HEAD_BYTES] {
    let mut head = [0; MESSAGE_HEAD_BYTES];
    head[0] = MESSAGE;
    head[1..9].copy_from_slice(&((MESSAGE_HEAD_BYTES - 9 + payload_bytes) as u64).to_le_bytes());
    head[9..11].copy_from_slice(&channel.to_le_bytes());
    head[11..15].copy_from_slice(&sequence.to_le_bytes());
    head[15..23].copy_from_slice(&time_ns.to_le_bytes());
    head[23..31].copy_from_slice(&time_ns.to_le_bytes());
    head
}
