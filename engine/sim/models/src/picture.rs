//! [`Picture`]: rows of red, green and blue, and how large it may be.

/// Largest width and height, pixels.
pub(crate) const LARGEST_SIDE: usize = 8192;

/// Most pixels of all pictures of a model.
pub const MOST_PIXELS: usize = LARGEST_SIDE * LARGEST_SIDE;

/// A picture: width, height, and sRGB bytes.
#[derive(Clone)]
pub struct Picture {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Red, green, blue of each pixel.
    pub rgb: Vec<[u8; 3]>,
    /// Opacity of each pixel; empty where all are opaque.
    pub alpha: Vec<u8>,
}

impl Picture {
    /// A picture of three or four bytes for each pixel, row by row.
    pub(crate) fn of_samples(samples: &[u8], width: usize, channels: usize) -> Self {
        let pixels = samples.chunks_exact(channels);
        let alpha = if channels == 4 { pixels.clone().map(|own| own[3]).collect() } else { vec![] };
        let rgb: Vec<[u8; 3]> = pixels.map(|own| [own[0], own[1], own[2]]).collect();
        Self { width, height: rgb.len() / width, rgb, alpha }
    }
}

/// Checks the size that a header says, before a pixel is decoded.
pub(crate) fn check_size(width: usize, height: usize, left: usize) -> Result<(), String> {
    let allowed = 1..=LARGEST_SIDE;
    if !(allowed.contains(&width) && allowed.contains(&height)) {
        return Err(format!("it has {width} x {height} pixels"));
    }
    if width * height > left {
        return Err(format!("it has {width} x {height} pixels; those read before leave {left} of what all may have"));
    }
    Ok(())
}
