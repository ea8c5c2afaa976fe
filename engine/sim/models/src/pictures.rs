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

/// Reads a picture, and takes its pixels from those that are left.
///
/// # Errors
/// Damaged files, other kinds, sides of no pixel or more than 8,192, and more pixels than are left.
pub fn read(bytes: &[u8], number: usize, left: &mut usize) -> Result<Picture, MapError> {
    read_named(bytes, &format!("picture {number} of the model"), left)
}

/// Reads a picture that errors call by a name.
///
/// # Errors
/// Those of [`read`].
pub fn read_named(bytes: &[u8], name: &str, left: &mut usize) -> Result<Picture, MapError> {
    let refused = |why: String| {
        let error = MapError::new(format!("{name} cannot be read: {why}"));
        error
            .hint("models and meshes take PNG and JPEG pictures of at most 8,192 pixels a side")
            .hint("export it with fewer or smaller pictures")
    };
    let picture = match bytes {
        [0x89, b'P', b'N', b'G', ..] => by_library(|| read_png(bytes, *left)),
        [0xff, 0xd8, ..] => by_library(|| read_jpeg(bytes, *left)),
        _ => Err("it is neither PNG nor JPEG".into()),
    };
    let picture = picture.map_err(refused)?;
    *left -= picture.width * picture.height;
    Ok(picture)
}

/// Picture that a library reads, which may panic on damaged files.
fn by_library(read: impl FnOnce() -> Result<Picture, String>) -> Result<Picture, String> {
    contained(read).unwrap_or_else(|| Err("it holds what no encoder writes".to_owned()))
}

/// Checks the size that a header says, before a pixel is decoded.
fn check_size(width: usize, height: usize, left: usize) -> Result<(), String> {
    let allowed = 1..=LARGEST_SIDE;
    if !(allowed.contains(&width) && allowed.contains(&height)) {
        return Err(format!("it has {width} x {height} pixels"));
    }
    if width * height > left {
        return Err(format!("it has {width} x {height} pixels; those read before leave {left} of what all may have"));
    }
    Ok(())
}

fn read_png(bytes: &[u8], left: usize) -> Result<Picture, String> {
    let failed = |error: png::DecodingError| error.to_string();
    let mut decoder = png::Decoder::new(Cursor::new(bytes));
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    let mut reader = decoder.read_info().map_err(failed)?;
    let (width, height) = (reader.info().width as usize, reader.info().height as usize);
    check_size(width, height, left)?;
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

fn read_jpeg(bytes: &[u8], left: usize) -> Result<Picture, String> {
    let options = DecoderOptions::default()
        .jpeg_set_out_colorspace(ColorSpace::RGB)
        .set_max_width(LARGEST_SIDE)
        .set_max_height(LARGEST_SIDE);
    let mut decoder = JpegDecoder::new_with_options(Cursor::new(bytes), options);
    decoder.decode_headers().map_err(|error| error.to_string())?;
    let (width, height) = decoder.dimensions().ok_or("it has no size")?;
    check_size(width, height, left)?;
    let samples = decoder.decode().map_err(|error| error.to_string())?;
    let rgb: Vec<[u8; 3]> = samples.as_chunks::<3>().0.to_vec();
    let alpha = vec![];
    if rgb.len() == width * height { Ok(Picture { width, height, rgb, alpha }) } else { Err("it is cut off".into()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_are_charged_by_the_header_before_they_are_decoded() {
        let mut bytes = vec![];
        let mut encoder = png::Encoder::new(&mut bytes, 40, 20);
        encoder.set_color(png::ColorType::Rgb);
        let mut writer = encoder.write_header().expect("a header");
        writer.write_image_data(&[90; 3 * 40 * 20]).expect("pixels");
        writer.finish().expect("an end");
        let mut left = 1000;
        assert_eq!(read(&bytes, 0, &mut left).expect("a picture").rgb.len(), 800);
        assert_eq!(left, 200);
        // The pixels are cut off: only the header can tell the size.
        let error = read(&bytes[..60], 1, &mut left).map(|_| ()).expect_err("refused");
        assert!(error.message.contains("it has 40 x 20 pixels; those read before leave 200"), "{}", error.message);
        assert_eq!(left, 200);
    }
}
