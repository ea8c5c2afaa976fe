//! CDR, the encoding of ROS 2 messages: XCDR1, little-endian, values aligned to their own size from the start of the body.

/// Encapsulation of plain CDR, little-endian.
const HEAD: [u8; 4] = [0, 1, 0, 0];

/// A message that is being encoded.
pub struct Cdr {
    bytes: Vec<u8>,
}

impl Cdr {
    /// An empty message.
    pub fn new() -> Self {
        Self { bytes: HEAD.to_vec() }
    }

    /// The encoded message.
    pub fn finish(self) -> Vec<u8> {
        self.bytes
    }

    fn aligned(&mut self, value: &[u8]) {
        let body = self.bytes.len() - HEAD.len();
        self.bytes.resize(HEAD.len() + body.next_multiple_of(value.len()), 0);
        self.bytes.extend_from_slice(value);
    }

    /// A whole number of 8 bits, or a truth value.
    pub fn u8(&mut self, value: u8) {
        self.bytes.push(value);
    }

    /// A whole number of 16 bits.
    pub fn u16(&mut self, value: u16) {
        self.aligned(&value.to_le_bytes());
    }

    /// A whole number of 32 bits; also the length of a sequence.
    pub fn u32(&mut self, value: u32) {
        self.aligned(&value.to_le_bytes());
    }

    /// A signed number of 32 bits.
    pub fn i32(&mut self, value: i32) {
        self.aligned(&value.to_le_bytes());
    }

    /// A real number of 32 bits.
    pub fn f32(&mut self, value: f32) {
        self.aligned(&value.to_le_bytes());
    }

    /// A real number of 64 bits.
    pub fn f64(&mut self, value: f64) {
        self.aligned(&value.to_le_bytes());
    }

    /// An array of a length that the definition states.
    pub fn f64s(&mut self, values: &[f64]) {
        values.iter().for_each(|value| self.f64(*value));
    }

    /// A text, with its length and a zero byte at the end.
    pub fn text(&mut self, text: &str) {
        self.u32(text.len() as u32 + 1);
        self.bytes.extend_from_slice(text.as_bytes());
        self.bytes.push(0);
    }

    /// A sequence of bytes.
    pub fn byte_sequence(&mut self, bytes: &[u8]) {
        self.u32(bytes.len() as u32);
        self.bytes.extend_from_slice(bytes);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_aligned_from_the_start_of_the_body() {
        let mut cdr = Cdr::new();
        cdr.u8(7);
        cdr.text("ab");
        cdr.f64(1.0);
        cdr.u8(1);
        cdr.byte_sequence(&[9]);
        let body = [
            &[7, 0, 0, 0, 3, 0, 0, 0, b'a', b'b', 0, 0, 0, 0, 0, 0][..],
            &1.0f64.to_le_bytes(),
            &[1, 0, 0, 0, 1, 0, 0, 0, 9],
        ];
        assert_eq!(cdr.finish(), [&HEAD[..], &body.concat()].concat());
    }
}
