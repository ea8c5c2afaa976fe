//! Colour images decoded and made smaller; labels, ids and depths encoded as pictures and as NumPy files.

use cosfly_diagnose::{Diagnostic, Fault, Result, contained, counted};
use cosfly_domain::channels::Element;
use cosfly_domain::{Channel, ChannelImage};
use cosfly_images::read::decoded;
use cosfly_read::LoggedFrame;
use flate2::Compression;
use flate2::write::GzEncoder;
use std::io::Write;

use cosfly_images::rgb::png as rgb_png;

/// Row-major RGB bytes of a frame's colour image, checked to have the frame's size.
pub fn rgb_of(logged: &LoggedFrame) -> Result<Vec<u8>> {
    let decoded = decoded(&logged.rgb_file, &logged.rgb_format).map(|picture| picture.rgb);
    let bytes = 3 * logged.width as usize * logged.height as usize;
    let checked = decoded.and_then(|rgb| match rgb.len() == bytes {
        true => Ok(rgb),
        false => Err(format!("it has {} of colours, not {bytes}", counted(rgb.len(), "byte"))),
    });
    checked.map_err(|cause| {
        let message = format!("the colour image of frame {} cannot be read", logged.target.frame);
        Diagnostic::new("export-image", Fault::Input, message).because(cause)
    })
}

/// A JPEG file of row-major RGB bytes.
pub fn rgb_jpeg(rgb: &[u8], [width, height]: [u32; 2], quality: u8) -> Result<Vec<u8>> {
    let mut file = vec![];
    cosfly_images::rgb::jpeg(rgb, width, height, quality, &mut file)?;
    Ok(file)
}

/// Size of a picture that is at most `most` pixels wide, with the aspect of `[width, height]`.
pub fn smaller_size([width, height]: [u32; 2], most: u32) -> [u32; 2] {
    if width <= most {
        return [width, height];
    }
    let (most, width) = (u64::from(most), u64::from(width));
    [most as u32, ((2 * u64::from(height) * most + width) / (2 * width)).max(1) as u32]
}

/// Pixels of an 8-bit PNG file with its width and height.
pub fn decode_png(file: &[u8]) -> Result<(Vec<u8>, [u32; 2]), String> {
    contained(|| png_pixels(file)).unwrap_or_else(|| Err("it holds what no encoder writes".to_owned()))
}

fn png_pixels(file: &[u8]) -> Result<(Vec<u8>, [u32; 2]), String> {
    let mut reader = png::Decoder::new(std::io::Cursor::new(file)).read_info().map_err(|error| error.to_string())?;
    let mut pixels = vec![0; reader.output_buffer_size().ok_or("it is too large")?];
    let info = reader.next_frame(&mut pixels).map_err(|error| error.to_string())?;
    pixels.truncate(info.buffer_size());
    Ok((pixels, [info.width, info.height]))
}

/// A PNG file of one byte per pixel.
pub fn gray8_png(values: &[u8], [width, height]: [u32; 2]) -> Result<Vec<u8>> {
    gray_png(values, [width, height], png::BitDepth::Eight)
}

/// A PNG file of two bytes per pixel.
fn gray16_png(values: impl Iterator<Item = u16>, size: [u32; 2]) -> Result<Vec<u8>> {
    let bytes: Vec<u8> = values.flat_map(u16::to_be_bytes).collect();
    gray_png(&bytes, size, png::BitDepth::Sixteen)
}

fn gray_png(bytes: &[u8], [width, height]: [u32; 2], depth: png::BitDepth) -> Result<Vec<u8>> {
    let mut file = vec![];
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(depth);
    encoder.set_compression(png::Compression::Fast);
    encoder.set_filter(png::Filter::Up);
    let written = encoder.write_header().and_then(|mut writer| writer.write_image_data(bytes));
    written
        .map_err(|error| Diagnostic::new("image-encode", Fault::Bug, "could not encode a PNG image").because(error))?;
    Ok(file)
}

/// A PNG file of depths in centimetres, 16 bits: at most 655.34 m, infinity (the sky) is 65,535.
pub fn depth_png(depth_m: &[f32], size: [u32; 2]) -> Result<Vec<u8>> {
    gray16_png(depth_m.iter().map(|depth| centimetres(*depth)), size)
}

fn centimetres(depth_m: f32) -> u16 {
    if depth_m.is_finite() { (100.0 * depth_m).round_ties_even().clamp(0.0, 65_534.0) as u16 } else { u16::MAX }
}

/// A number of NumPy files.
pub trait Number: Copy {
    /// Type in the file's header.
    const DESCRIPTION: &'static str;
    /// Appends the bytes of the number, little-endian.
    fn append(self, file: &mut Vec<u8>);
}

impl Number for u8 {
    const DESCRIPTION: &'static str = "|u1";
    fn append(self, file: &mut Vec<u8>) {
        file.push(self);
    }
}

impl Number for u32 {
    const DESCRIPTION: &'static str = "<u4";
    fn append(self, file: &mut Vec<u8>) {
        file.extend_from_slice(&self.to_le_bytes());
    }
}

impl Number for f32 {
    const DESCRIPTION: &'static str = "<f4";
    fn append(self, file: &mut Vec<u8>) {
        file.extend_from_slice(&self.to_le_bytes());
    }
}

/// A NumPy file with `rows` x `columns` numbers.
pub fn npy<T: Number>(values: &[T], [columns, rows]: [u32; 2]) -> Vec<u8> {
    npy_of_shape(values, &format!("({rows}, {columns})"))
}

/// A NumPy file with numbers of a shape as Python writes it.
fn npy_of_shape<T: Number>(values: &[T], shape: &str) -> Vec<u8> {
    let kind = T::DESCRIPTION;
    let mut header = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}");
    // Magic, version and length take 10 bytes; everything before the data a multiple of 64.
    let padding = (64 - (10 + header.len() + 1) % 64) % 64;
    header.push_str(&" ".repeat(padding));
    header.push('\n');
    let mut file = Vec::with_capacity(10 + header.len() + size_of_val(values));
    file.extend_from_slice(b"\x93NUMPY\x01\x00");
    file.extend_from_slice(&(header.len() as u16).to_le_bytes());
    file.extend_from_slice(header.as_bytes());
    values.iter().for_each(|value| value.append(&mut file));
    file
}

/// A file compressed by gzip, without a time or a name in its header.
pub fn gzip(file: &[u8]) -> Result<Vec<u8>> {
    let mut encoder = GzEncoder::new(vec![], Compression::fast());
    let packed = encoder.write_all(file).and_then(|()| encoder.finish());
    packed.map_err(|error| Diagnostic::new("image-encode", Fault::Bug, "could not compress an image").because(error))
}

/// Ending of files of a channel on request: bytes are PNG, numbers NumPy files.
pub fn ending_on_request(channel: &Channel) -> &'static str {
    if matches!(channel.element(), Element::Float | Element::Pair) { "npy" } else { "png" }
}

/// File of a channel on request.
pub fn file_on_request(image: &ChannelImage, [width, height]: [u32; 2]) -> Result<Vec<u8>> {
    let numbers = || -> Vec<f32> { image.bytes.as_chunks::<4>().0.iter().map(|it| f32::from_le_bytes(*it)).collect() };
    match image.channel.element() {
        Element::Float => Ok(npy(&numbers(), [width, height])),
        Element::Pair => Ok(npy_of_shape(&numbers(), &format!("({height}, {width}, 2)"))),
        Element::Flag => gray8_png(&image.bytes, [width, height]),
        _ => {
            let mut file = vec![];
            rgb_png(&image.bytes, width, height, &mut file)?;
            Ok(file)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numpy_files_begin_as_the_format_says() {
        let file = npy(&[1.0f32, 2.0, 3.0, 4.0, 5.0, 6.0], [3, 2]);
        assert_eq!((file.len(), &file[..8]), (128 + 24, &b"\x93NUMPY\x01\x00"[..]));
        assert!(String::from_utf8_lossy(&file[10..128]).contains("'shape': (2, 3)"));
        assert_eq!(&file[128..132], &1.0f32.to_le_bytes());
        assert_eq!((npy(&[7u8, 8], [2, 1]).len(), npy(&[70_000u32], [1, 1]).len()), (128 + 2, 128 + 4));
    }

    #[test]
    fn pairs_are_the_last_axis_of_a_numpy_file() {
        let image = ChannelImage { channel: &cosfly_domain::channels::flow::BACK, bytes: vec![0; 8 * 6] };
        let file = file_on_request(&image, [3, 2]).unwrap();
        assert_eq!((ending_on_request(image.channel), file.len()), ("npy", 128 + 48));
        assert!(String::from_utf8_lossy(&file[10..128]).contains("'shape': (2, 3, 2)"));
    }

    #[test]
    fn smaller_pictures_keep_the_aspect() {
        assert_eq!(smaller_size([1280, 720], 448), [448, 252]);
        assert_eq!((smaller_size([320, 180], 448), smaller_size([4000, 1], 448)), ([320, 180], [448, 1]));
    }

    #[test]
    fn depths_are_centimetres_and_the_sky_is_the_largest_number() {
        assert_eq!([0.0, 1.234, 655.34, 900.0, f32::INFINITY].map(centimetres), [0, 123, 65_534, 65_534, 65_535]);
    }
}
