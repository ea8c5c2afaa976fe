//! [`Scalar`]: kinds of numbers in binary tables of points.

/// Kind of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scalar {
    /// Signed integer of 1, 2, 4 or 8 bytes.
    Signed(u8),
    /// Unsigned integer of 1, 2, 4 or 8 bytes.
    Unsigned(u8),
    /// Real number of 4 or 8 bytes.
    Real(u8),
}

impl Scalar {
    /// Number of bytes.
    pub fn bytes(self) -> usize {
        match self {
            Self::Signed(bytes) | Self::Unsigned(bytes) | Self::Real(bytes) => bytes.into(),
        }
    }

    /// The number at the beginning of `bytes`; none where they are too few.
    pub fn read(self, bytes: &[u8], is_big_endian: bool) -> Option<f64> {
        let length = self.bytes();
        let own = bytes.get(..length)?;
        // Little end first, the rest zero.
        let mut low = [0; 8];
        for (at, byte) in own.iter().enumerate() {
            low[if is_big_endian { length - 1 - at } else { at }] = *byte;
        }
        let bits = u64::from_le_bytes(low);
        let unused = 64 - 8 * length as u32;
        Some(match self {
            Self::Signed(_) => ((bits << unused) as i64 >> unused) as f64,
            Self::Unsigned(_) => bits as f64,
            Self::Real(4) => f32::from_bits(bits as u32).into(),
            Self::Real(_) => f64::from_bits(bits),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_all_kinds_are_read_at_both_ends() {
        assert_eq!(Scalar::Signed(2).read(&(-300_i16).to_le_bytes(), false), Some(-300.0));
        assert_eq!(Scalar::Signed(4).read(&(-70_000_i32).to_be_bytes(), true), Some(-70_000.0));
        assert_eq!(Scalar::Unsigned(1).read(&[200], true), Some(200.0));
        assert_eq!(Scalar::Real(4).read(&1.5_f32.to_be_bytes(), true), Some(1.5));
        assert_eq!(Scalar::Real(8).read(&(-0.1_f64).to_le_bytes(), false), Some(-0.1));
        assert_eq!(Scalar::Real(8).read(&[0; 7], false), None);
    }
}
