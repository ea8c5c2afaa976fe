//! Colour images as JPEG or PNG files.

use super::jpeg;
use cosfly_diagnose::{Diagnostic, Fault, Result};

/// A JPEG file of row-major sRGB pixels, without chroma subsampling.
pub fn jpeg(rgb: &[u8], width: u32, height: u32, quality: u8) -> Result<Vec<u8>> {
    if width.max(height) > jpeg::MAX_SIDE || width.min(height) == 0 {
        let message = format!("{width} x {height} does not fit a JPEG file");
        return Err(Diagnostic::new("image-size", Fault::Recipe, message));
    }
    Ok(jpeg::encode(rgb, width, height, quality))
}

/// A PNG file of row-major sRGB pixels.
pub fn png(rgb: &[u8], width: u32, height: u32) -> Result<Vec<u8>> {
    write_png(rgb, width, height, |encoder| encoder.set_color(png::ColorType::Rgb))
}

/// A palette PNG file of row-major indices; `palette` holds three bytes an index.
pub fn palette_png(indices: &[u8], width: u32, height: u32, palette: Vec<u8>) -> Result<Vec<u8>> {
    write_png(indices, width, height, |encoder| {
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_palette(palette);
    })
}

fn write_png(
    pixels: &[u8],
    width: u32,
    height: u32,
    set_colours: impl FnOnce(&mut png::Encoder<'_, &mut Vec<u8>>),
) -> Result<Vec<u8>> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width, height);
    set_colours(&mut encoder);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Fast);
    encoder
        .write_header()
        .and_then(|mut writer| writer.write_image_data(pixels))
        .map_err(|error| Diagnostic::new("image-encode", Fault::Bug, "could not encode a PNG image").because(error))?;
    Ok(file)
}
