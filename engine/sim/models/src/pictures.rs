//! Pictures of glTF files: PNG or JPEG, as rows of red, green and blue.

use cosfly_diagnose::contained;
use cosfly_town::MapError;
use std::io::Cursor;
use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

/// Largest width and height, pixels.
const LARGEST_SIDE: usize = 8192;

/// Most pixels of all pictures of a model.
pub const MOST_PIXELS: usize = LARGEST_SIDE * LARGEST_SIDE;

/// A picture: width, height, and sRGB bytes.
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

/// Reads a picture.
///
/// # Errors
/// Damaged files, other kinds, sides of no pixel or more than 8,192.
pub fn read(bytes: &[u8], number: usize) -> Result<Picture, MapError> {
    read_named(bytes, &format!("picture {number} of the model"))
}

/// Reads a picture that errors call by a name.
///
/// # Errors
/// Those of [`read`].
pub fn read_named(bytes: &[u8], name: &str) -> Result<Picture, MapError> {
    let refused = |why: String| {
        let error = MapError::new(format!("{name} cannot be read: {why}"));
        error.hint("models and meshes take PNG and JPEG pictures of at most 8,192 pixels a side")
    };
    let picture = match bytes {
        [0x89, b'P', b'N', b'G', ..] => by_library(|| read_png(bytes)),
        [0xff, 0xd8, ..] => by_library(|| read_jpeg(bytes)),
        _ => Err("it is neither PNG nor JPEG".into()),
    };
    picture.map_err(refused)
}

/// Picture that a library reads, which may panic on damaged files.
fn by_library(read: impl FnOnce() -> Result<Picture, String>) -> Result<Picture, String> {
    contained(read).unwrap_or_else(|| Err("it holds what no encoder writes".to_owned()))
}

fn check_size(width: usize, height: usize) -> Result<(), String> {
    let allowed = 1..=LARGEST_SIDE;
    let fits = allowed.contains(&width) && allowed.contains(&height);
    if fits { Ok(()) } else { Err(format!("it has {width} x {height} pixels")) }
}

fn read_png(bytes: &[u8]) -> Result<Picture, String> {
    let failed = |error: png::DecodingError| error.to_string();
    let mut decoder = png::Decoder::new(Cursor::new(bytes));
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    let mut reader = decoder.read_info().map_err(failed)?;
    let (width, height) = (reader.info().width as usize, reader.info().height as usize);
    check_size(width, height)?;
    let size = reader.output_buffer_size().ok_or("it is too large")?;
    let mut samples = vec![0; size];
    let info = reader.next_frame(&mut samples).map_err(failed)?;
    let channels = info.color_type.samples();
    let colour = |pixel: &[u8]| if channels >= 3 { [pixel[0], pixel[1], pixel[2]] } else { [pixel[0]; 3] };
    let pixels = || samples.chunks_exact(channels).take(width * height);
    let rgb: Vec<[u8; 3]> = pixels().map(colour).collect();
    let alpha = if channels % 2 == 0 { pixels().map(|pixel| pixel[channels - 1]).collect() } else { vec![] };
    if rgb.len() == width * height { Ok(Picture { width, height, rgb, alpha }) } else { Err("it is cut off".into()) }
}

fn read_jpeg(bytes: &[u8]) -> Result<Picture, String> {
    let options = DecoderOptions::default()
        .jpeg_set_out_colorspace(ColorSpace::RGB)
        .set_max_width(LARGEST_SIDE)
        .set_max_height(LARGEST_SIDE);
    let mut decoder = JpegDecoder::new_with_options(Cursor::new(bytes), options);
    decoder.decode_headers().map_err(|error| error.to_string())?;
    let (width, height) = decoder.dimensions().ok_or("it has no size")?;
    check_size(width, height)?;
    let samples = decoder.decode().map_err(|error| error.to_string())?;
    let rgb: Vec<[u8; 3]> = samples.as_chunks::<3>().0.to_vec();
    let alpha = vec![];
    if rgb.len() == width * height { Ok(Picture { width, height, rgb, alpha }) } else { Err("it is cut off".into()) }
}
