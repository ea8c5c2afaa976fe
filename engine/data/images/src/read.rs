//! Pictures from image files, whole or scaled.

use crate::jpeg::{DecodedJpeg, decode};
use cosfly_diagnose::{Diagnostic, Fault, Result, contained};
use std::io::Cursor;
use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

/// Longest side of a picture that is read, pixels.
const LONGEST: usize = 16_384;
/// Most pixels of a picture that is read: a small file may claim any number.
const MOST_PIXELS: usize = 1 << 26;

/// A picture in colours.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Width and height, pixels.
    pub size: [usize; 2],
    /// Row-major sRGB pixels.
    pub rgb: Vec<u8>,
}

/// Decodes an image file of format `jpeg` or `png`; with a size, each pixel is the mean of its area. JPEG files are scaled
/// in part while they are decoded, from the low frequencies of their blocks.
///
/// # Errors
/// `image-decode`.
pub fn picture(file: &[u8], format: &str, size: Option<[usize; 2]>) -> Result<Picture> {
    let whole = match (format, size) {
        ("jpeg", Some(size)) => scaled_jpeg(file, size),
        _ => decoded(file, format),
    };
    let whole = whole.map_err(|why| {
        Diagnostic::new("image-decode", Fault::Input, format!("a picture of format `{format}` cannot be read"))
            .because(why)
    })?;
    Ok(match size.filter(|size| *size != whole.size) {
        Some(size) => Picture { size, rgb: averaged(&whole.rgb, whole.size, size) },
        None => whole,
    })
}

/// All pixels of an image file of format `jpeg` or `png`.
///
/// # Errors
/// The reason, in words.
pub fn decoded(file: &[u8], format: &str) -> Result<Picture, String> {
    match format {
        "jpeg" => by_library(|| jpeg(file)),
        "png" => by_library(|| png(file)),
        other => Err(format!("`{other}` is not a known format")),
    }
}

/// Width and height that a PNG file states, pixels; nothing of it is unpacked.
///
/// # Errors
/// The reason, in words.
pub fn png_size(file: &[u8]) -> Result<[usize; 2], String> {
    by_library(|| {
        let reader = png::Decoder::new(Cursor::new(file)).read_info().map_err(|error| error.to_string())?;
        Ok([reader.info().width as usize, reader.info().height as usize])
    })
}

/// Result of a library, which may panic on damaged files.
fn by_library<T>(read: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
    contained(read).unwrap_or_else(|| Err("it holds what no encoder writes".to_owned()))
}

/// A picture of at least the wanted size; its area is averaged while the file is decoded.
fn scaled_jpeg(file: &[u8], size: [usize; 2]) -> Result<Picture, String> {
    match decode(file, size) {
        Some(DecodedJpeg { size, rgb }) => Ok(Picture { size, rgb }),
        None => by_library(|| jpeg(file)),
    }
}

fn jpeg(file: &[u8]) -> Result<Picture, String> {
    let options = DecoderOptions::default()
        .jpeg_set_out_colorspace(ColorSpace::RGB)
        .set_max_width(LONGEST)
        .set_max_height(LONGEST)
        .set_strict_mode(true);
    let mut decoder = JpegDecoder::new_with_options(Cursor::new(file), options);
    decoder.decode_headers().map_err(|error| error.to_string())?;
    let (width, height) = decoder.dimensions().ok_or("the picture has no size")?;
    check_size([width, height])?;
    let rgb = decoder.decode().map_err(|error| error.to_string())?;
    let info = decoder.info().ok_or("the picture has no size")?;
    let size = [usize::from(info.width), usize::from(info.height)];
    if rgb.len() == 3 * size[0] * size[1] { Ok(Picture { size, rgb }) } else { Err("it is not in colours".to_owned()) }
}

fn check_size(size: [usize; 2]) -> Result<(), String> {
    if size.iter().any(|side| *side > LONGEST) || size[0] * size[1] > MOST_PIXELS {
        return Err(format!(
            "it is {} x {} pixels; {LONGEST} a side and {MOST_PIXELS} in all are read",
            size[0], size[1]
        ));
    }
    Ok(())
}

fn png(file: &[u8]) -> Result<Picture, String> {
    let mut decoder = png::Decoder::new(Cursor::new(file));
    decoder.set_transformations(png::Transformations::EXPAND | png::Transformations::STRIP_16);
    let mut reader = decoder.read_info().map_err(|error| error.to_string())?;
    let size = [reader.info().width as usize, reader.info().height as usize];
    check_size(size)?;
    let mut rgb = vec![0; reader.output_buffer_size().ok_or("it is too large")?];
    let frame = reader.next_frame(&mut rgb).map_err(|error| error.to_string())?;
    rgb.truncate(frame.buffer_size());
    if rgb.len() == 3 * size[0] * size[1] { Ok(Picture { size, rgb }) } else { Err("it is not in colours".to_owned()) }
}

/// The value in the middle of each pixel of a scaled image.
pub fn sampled<T: Copy>(pixels: &[T], from: [usize; 2], size: [usize; 2]) -> Vec<T> {
    if from == size {
        return pixels.to_vec();
    }
    let middle = |at: usize, axis: usize| (2 * at + 1) * from[axis] / (2 * size[axis]);
    let columns: Vec<usize> = (0..size[0]).map(|x| middle(x, 0)).collect();
    let mut found = Vec::with_capacity(size[0] * size[1]);
    for y in 0..size[1] {
        let row = &pixels[middle(y, 1) * from[0]..][..from[0]];
        found.extend(columns.iter().map(|column| row[*column]));
    }
    found
}

/// Weights of source pixels for each pixel along an axis: first source pixel, and 16-bit weights that sum to 65,536.
fn weights(from: usize, to: usize) -> Vec<(usize, Vec<u32>)> {
    let part = |at: usize| at * from; // in `to`-ths of a source pixel
    (0..to)
        .map(|at| {
            let (start, end) = (part(at), part(at + 1));
            let (first, last) = (start / to, end.div_ceil(to).max(start / to + 1));
            let overlap = |source: usize| (end.min((source + 1) * to) - start.max(source * to)) as u64;
            let mut sum = 0;
            let mut weights: Vec<u32> =
                (first..last).map(|source| ((overlap(source) << 16) / from as u64) as u32).collect();
            weights.iter().for_each(|weight| sum += weight);
            // What rounding lost goes to the middle.
            let middle = weights.len() / 2;
            weights[middle] += 65_536 - sum;
            (first, weights)
        })
        .collect()
}

/// Mean over the area of each pixel of a picture of size `from` scaled to `size`, exactly weighted at the edges; magnified
/// pictures repeat pixels.
pub fn averaged(rgb: &[u8], from: [usize; 2], size: [usize; 2]) -> Vec<u8> {
    let [columns, rows] = [weights(from[0], size[0]), weights(from[1], size[1])];
    let mut sums = vec![0u32; 3 * from[0]];
    let mut made = Vec::with_capacity(3 * size[0] * size[1]);
    for (first, weights) in &rows {
        sums.fill(0);
        for (row, weight) in weights.iter().enumerate() {
            let pixels = &rgb[(first + row) * sums.len()..][..sums.len()];
            for (sum, value) in sums.iter_mut().zip(pixels) {
                *sum += u32::from(*value) * weight;
            }
        }
        for (first, weights) in &columns {
            let pixels = &sums[3 * first..][..3 * weights.len()];
            let mut total = [0u64; 3];
            for (pixel, weight) in pixels.as_chunks::<3>().0.iter().zip(weights) {
                total.iter_mut().zip(pixel).for_each(|(sum, value)| *sum += u64::from(*value) * u64::from(*weight));
            }
            made.extend(total.map(|sum| ((sum + (1 << 31)) >> 32) as u8));
        }
    }
    made
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scaling_keeps_even_pictures_and_averages_areas() {
        let even = Picture { size: [7, 5], rgb: vec![200; 105] };
        assert!(averaged(&even.rgb, even.size, [3, 2]).iter().all(|value| *value == 200));
        assert!(averaged(&even.rgb, even.size, [16, 9]).iter().all(|value| *value == 200));
        let two = Picture { size: [2, 2], rgb: [[0; 3], [100; 3], [50; 3], [250; 3]].concat() };
        assert_eq!(averaged(&two.rgb, two.size, [1, 1]), [100; 3]);
        let three = Picture { size: [3, 1], rgb: [[0; 3], [90; 3], [180; 3]].concat() };
        assert_eq!(averaged(&three.rgb, three.size, [2, 1]), [[30; 3], [150; 3]].concat());
        assert_eq!(sampled(&[1, 2, 3, 4], [4, 1], [2, 1]), [2, 4]);
    }

    #[test]
    fn files_of_either_format_give_the_size_and_the_pixels() {
        let rgb: Vec<u8> = (0..3 * 32 * 16).map(|i| (i / 7) as u8).collect();
        let mut file = vec![];
        crate::rgb::png(&rgb, 32, 16, &mut file).unwrap();
        assert_eq!(picture(&file, "png", None).unwrap(), Picture { size: [32, 16], rgb: rgb.clone() });
        let data_at = file.windows(4).position(|four| four == b"IDAT").unwrap();
        assert_eq!(png_size(&file[..data_at + 4]), Ok([32, 16]), "the head alone is read");
        assert!(decoded(&file[..data_at + 4], "png").is_err());
        crate::rgb::jpeg(&rgb, 32, 16, 95, &mut file).unwrap();
        let read = picture(&file, "jpeg", None).unwrap();
        assert!(read.rgb.iter().zip(&rgb).all(|(a, b)| a.abs_diff(*b) < 24));
        assert_eq!(picture(&file, "jpeg", Some([8, 4])).unwrap().size, [8, 4]);
        // Fractions of smooth pictures are their means; the whole is that of the general decoder.
        for size in [[32, 16], [16, 8], [8, 4], [4, 2]] {
            let small = picture(&file, "jpeg", Some(size)).unwrap().rgb;
            let means = averaged(&read.rgb, read.size, size);
            assert!(small.iter().zip(&means).all(|(a, b)| a.abs_diff(*b) <= 8), "{size:?}: {small:?} {means:?}");
        }
        for cut in 0..file.len() {
            let _ = (picture(&file[..cut], "jpeg", None), picture(&file[..cut], "jpeg", Some([9, 5])));
        }
    }
}
