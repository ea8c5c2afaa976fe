//! Colour images as JPEG or PNG files.

use super::jpeg::{self, Chroma};
use cosfly_diagnose::{Diagnostic, Fault, Result};

/// Fills `file` with a JPEG file of row-major sRGB pixels, without chroma subsampling.
pub fn jpeg(rgb: &[u8], width: u32, height: u32, quality: u8, file: &mut Vec<u8>) -> Result<()> {
    jpeg_with(rgb, width, height, quality, Chroma::Full, file)
}

/// Fills `file` with a JPEG file of row-major sRGB pixels.
pub fn jpeg_with(rgb: &[u8], width: u32, height: u32, quality: u8, chroma: Chroma, file: &mut Vec<u8>) -> Result<()> {
    if width.max(height) > jpeg::MAX_SIDE || width.min(height) == 0 {
        let message = format!("{width} x {height} does not fit a JPEG file");
        return Err(Diagnostic::new("image-size", Fault::Recipe, message));
    }
    jpeg::encode(rgb, width, height, quality, chroma, file);
    Ok(())
}

/// Fills `file` with a PNG file of row-major sRGB pixels.
pub fn png(rgb: &[u8], width: u32, height: u32, file: &mut Vec<u8>) -> Result<()> {
    write_png(rgb, width, height, file, |encoder| encoder.set_color(png::ColorType::Rgb))
}

/// Fills `file` with a palette PNG file of row-major indices; `palette` holds three bytes an index.
pub fn palette_png(indices: &[u8], width: u32, height: u32, palette: Vec<u8>, file: &mut Vec<u8>) -> Result<()> {
    write_png(indices, width, height, file, |encoder| {
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_palette(palette);
        // The fast compressor only compresses runs of zeros; differences to the row above produce them.
        encoder.set_filter(png::Filter::Up);
    })
}

fn write_png(
    pixels: &[u8],
    width: u32,
    height: u32,
    file: &mut Vec<u8>,
    set_colours: impl FnOnce(&mut png::Encoder<'_, &mut Vec<u8>>),
) -> Result<()> {
    file.clear();
    let mut encoder = png::Encoder::new(file, width, height);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Fast);
    set_colours(&mut encoder);
    encoder
        .write_header()
        .and_then(|mut writer| writer.write_image_data(pixels))
        .map_err(|error| Diagnostic::new("image-encode", Fault::Bug, "could not encode a PNG image").because(error))
}
