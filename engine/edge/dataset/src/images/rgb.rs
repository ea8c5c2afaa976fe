//! Colour images as JPEG or PNG files.

use cosfly_diagnose::{Diagnostic, Fault, Result};

/// A JPEG file of row-major sRGB pixels, without chroma subsampling.
pub fn jpeg(rgb: &[u8], width: u32, height: u32, quality: u8) -> Result<Vec<u8>> {
    let too_large =
        || Diagnostic::new("image-size", Fault::Recipe, format!("{width} x {height} is too large for JPEG"));
    let (columns, rows) =
        (u16::try_from(width).map_err(|_| too_large())?, u16::try_from(height).map_err(|_| too_large())?);
    let mut file = Vec::with_capacity(rgb.len() / 6);
    let mut encoder = jpeg_encoder::Encoder::new(&mut file, quality);
    encoder.set_sampling_factor(jpeg_encoder::SamplingFactor::R_4_4_4);
    encoder
        .encode(rgb, columns, rows, jpeg_encoder::ColorType::Rgb)
        .map_err(|error| Diagnostic::new("image-encode", Fault::Bug, "could not encode a JPEG image").because(error))?;
    Ok(file)
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
