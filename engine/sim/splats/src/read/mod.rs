//! Readers of files of splats. None trusts a count: what a file promises is compared with its length first.

mod packed;
mod ply;
mod points;
mod small;

use crate::cloud::SplatCloud;
use crate::error::SplatError;

/// Most splats of a file.
pub const MOST_SPLATS: usize = 10_000_000;

/// Content of a file.
#[derive(Clone, Debug)]
pub struct SplatFile {
    /// Its splats.
    pub cloud: SplatCloud,
    /// The format's name.
    pub format: &'static str,
}

/// Reads a file: `.ply` of the reference trainer, `.spz` or `.splat`, or a cloud of coloured points (`.ply`, `.las`, `.laz`), told by its
/// content.
///
/// # Errors
/// Other formats, damaged or cut files, more than [`MOST_SPLATS`] splats, and files none of whose splats can be seen.
pub fn read(bytes: &[u8]) -> Result<SplatFile, SplatError> {
    let (cloud, format) = match bytes {
        [b'L', b'A', b'S', b'F', ..] => (points::read(bytes)?, "LAS"),
        [b'p', b'l', b'y', ..] if ply::is_of_points(bytes) => (points::read(bytes)?, "PLY of points"),
        [b'p', b'l', b'y', ..] => (ply::read(bytes)?, "PLY"),
        [0x1f, 0x8b, ..] => (packed::read(bytes)?, "SPZ"),
        _ if bytes.starts_with(&packed::MAGIC) => (packed::read_columns(bytes)?, "SPZ"),
        _ => (small::read(bytes)?, "splat"),
    };
    if cloud.is_empty() {
        let message = format!("no splat of the file can be seen ({} are transparent or not finite)", cloud.left_out());
        return Err(SplatError::new(message, "export the scene again"));
    }
    Ok(SplatFile { cloud, format })
}

/// Refuses more splats than a cloud may have.
fn check_count(count: usize) -> Result<(), SplatError> {
    if count <= MOST_SPLATS {
        return Ok(());
    }
    let message = format!("the file has {count} splats; at most {MOST_SPLATS} are read");
    Err(SplatError::new(message, "cut the scene into pieces, or prune it in an editor of splats such as SuperSplat"))
}

/// `1 / (1 + e^-x)`.
fn logistic(x: f32) -> f32 {
    1.0 / (1.0 + exponential(-x))
}

/// `e^x`, the same on every machine.
fn exponential(x: f32) -> f32 {
    cosfly_frames::real::exp(x.into()) as f32
}
