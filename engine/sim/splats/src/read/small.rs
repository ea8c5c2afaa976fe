//! `.splat`: 32 bytes a splat, without a head.

use super::check_count;
use crate::cloud::SplatCloud;
use crate::error::SplatError;
use crate::splat::Splat;

/// Bytes of a splat: middle and spread as six reals, colour and opacity as four bytes, turn as four bytes.
const BYTES: usize = 32;

pub(super) fn read(bytes: &[u8]) -> Result<SplatCloud, SplatError> {
    if bytes.is_empty() || !bytes.len().is_multiple_of(BYTES) {
        let message = format!(
            "the file begins neither like `.ply` nor like `.spz`, and its {} bytes are no multiple of {BYTES}, as in `.splat`",
            bytes.len()
        );
        return Err(SplatError::new(message, "export the scene as `.ply`, `.spz` or `.splat`"));
    }
    check_count(bytes.len() / BYTES)?;
    let mut cloud = SplatCloud::new(0);
    for own in bytes.as_chunks::<BYTES>().0 {
        let real = |at: usize| f32::from_le_bytes([own[at], own[at + 1], own[at + 2], own[at + 3]]);
        let share = |at: usize| f32::from(own[at]) / 255.0;
        cloud.push(&Splat::plain(
            [0, 4, 8].map(real),
            [12, 16, 20].map(real),
            [28, 29, 30, 31].map(|at| (f32::from(own[at]) - 128.0) / 128.0),
            share(27),
            [24, 25, 26].map(share),
        ));
    }
    Ok(cloud)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_splat_of_the_smallest_format_is_read() {
        let mut bytes = Vec::new();
        for value in [1.0_f32, -2.0, 3.5, 0.1, 0.2, 0.3] {
            bytes.extend(value.to_le_bytes());
        }
        bytes.extend([255, 0, 51, 204, 255, 128, 128, 128]);
        let cloud = read(&bytes).expect("a cloud");
        assert_eq!((cloud.len(), cloud.left_out()), (1, 0));
        assert_eq!(cloud.bounds(), [[1.0, -2.0, 3.5]; 2]);
        assert_eq!(cloud.blocks()[0].opacity[0], 0.8);
        assert!((cloud.blocks()[0].covariance[3][0] - 0.04).abs() < 1e-6);
        for length in [0, 31, 33] {
            assert!(read(&vec![0; length]).is_err());
        }
    }
}
