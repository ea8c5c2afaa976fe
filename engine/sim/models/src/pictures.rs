//! Pictures of glTF files: PNG, JPEG, WebP or KTX 2.0, as rows of red, green and blue.

use crate::ktx2;
use crate::picture::{LARGEST_SIDE, Picture, check_size};
use cosfly_diagnose::contained;
use cosfly_town::MapError;
use image_webp::WebPDecoder;
use std::io::Cursor;
use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

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
            .hint("models and meshes take PNG, JPEG, WebP and KTX2 pictures of at most 8,192 pixels a side")
            .hint("export it with fewer or smaller pictures")
    };
    let picture = match bytes {
        [0x89, b'P', b'N', b'G', ..] => by_library(|| read_png(bytes, *left)),
        [0xff, 0xd8, ..] => by_library(|| read_jpeg(bytes, *left)),
        [b'R', b'I', b'F', b'F', _, _, _, _, b'W', b'E', b'B', b'P', ..] => by_library(|| read_webp(bytes, *left)),
        _ if bytes.starts_with(ktx2::MAGIC) => by_library(|| ktx2::read(bytes, *left)),
        _ => Err("it is neither PNG nor JPEG, WebP or KTX2".into()),
    };
    let picture = picture.map_err(refused)?;
    *left -= picture.width * picture.height;
    Ok(picture)
}

/// Picture that a library reads, which may panic on damaged files.
fn by_library(read: impl FnOnce() -> Result<Picture, String>) -> Result<Picture, String> {
    contained(read).unwrap_or_else(|| Err("it holds what no encoder writes".to_owned()))
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

fn read_webp(bytes: &[u8], left: usize) -> Result<Picture, String> {
    let mut decoder = WebPDecoder::new(Cursor::new(bytes)).map_err(|error| error.to_string())?;
    let (width, height) = decoder.dimensions();
    let (width, height) = (width as usize, height as usize);
    check_size(width, height, left)?;
    if decoder.is_animated() {
        return Err("it is a film".into());
    }
    let channels = if decoder.has_alpha() { 4 } else { 3 };
    let mut samples = vec![0; channels * width * height];
    decoder.read_image(&mut samples).map_err(|error| error.to_string())?;
    Ok(Picture::of_samples(&samples, width, channels))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::MOST_PIXELS;

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

    const WEBP: &[u8] = include_bytes!("pictures/four.webp");
    const ETC1S: &[u8] = include_bytes!("pictures/four_etc1s.ktx2");
    const UASTC: &[u8] = include_bytes!("pictures/four_uastc.ktx2");
    const ZSTANDARD: &[u8] = include_bytes!("pictures/four_zstd.ktx2");

    /// A file of plain bytes: `channels` of each of 7 x 6 pixels.
    fn plain_ktx2(format: u32, channels: usize) -> Vec<u8> {
        let head = [format, 1, 7, 6, 0, 0, 1, 1, 0].map(u32::to_le_bytes).concat();
        let pixels: Vec<u8> = (0..42 * channels).map(|at| at as u8).collect();
        let level = [104, pixels.len() as u64, 0].map(u64::to_le_bytes).concat();
        [ktx2::MAGIC, &head, &[0; 32], &level, &pixels].concat()
    }

    #[test]
    fn pictures_of_all_kinds_have_their_colours_and_take_their_pixels() {
        // Four colours, the last one clear: encoders keep them within a few steps, the clear one within fewer.
        let corners = [(0, [200, 40, 40]), (6, [40, 180, 60]), (35, [50, 60, 200]), (41, [240, 230, 220])];
        let lossy: &[u8] = include_bytes!("pictures/four_lossy.webp");
        for (bytes, most, has_alpha) in
            [(WEBP, 0, true), (lossy, 70, false), (ETC1S, 3, true), (UASTC, 1, true), (ZSTANDARD, 1, true)]
        {
            let mut left = 42;
            let picture = read(bytes, 0, &mut left).expect("a picture");
            assert_eq!((picture.width, picture.height, left), (7, 6, 0));
            let is_near = |own: u8, colour: u8| own.abs_diff(colour) <= most;
            for (at, colour) in corners {
                assert!((0..3).all(|k| is_near(picture.rgb[at][k], colour[k])), "{at}: {:?}", picture.rgb[at]);
            }
            assert_eq!(picture.alpha.len(), if has_alpha { 42 } else { 0 });
            assert!(!has_alpha || (picture.alpha[0], picture.alpha[41]) == (255, 0), "{:?}", picture.alpha);
            let error = read(bytes, 0, &mut 41).map(|_| ()).expect_err("refused");
            assert!(error.message.contains("it has 7 x 6 pixels"), "{}", error.message);
        }
        let picture = read(&plain_ktx2(43, 4), 0, &mut 42).expect("a picture");
        assert_eq!((picture.rgb[41], picture.alpha[41]), ([164, 165, 166], 167));
        assert_eq!(read(&plain_ktx2(29, 3), 0, &mut 42).expect("a picture").rgb[41], [123, 124, 125]);
    }

    #[test]
    fn damaged_pictures_and_those_of_other_kinds_are_refused() {
        let refused = |bytes: &[u8]| read(bytes, 0, &mut MOST_PIXELS.clone()).map(|_| ()).expect_err("refused").message;
        let film = refused(include_bytes!("pictures/film.webp"));
        assert!(film.contains("it is a film"), "{film}");
        let changed = |bytes: &[u8], at: usize, own: u32| [&bytes[..at], &own.to_le_bytes(), &bytes[at + 4..]].concat();
        // Sizes, counts and kinds that are not there, or are another file's.
        for (bytes, words) in [
            (changed(UASTC, 20, 9000), "9000 x 6"),
            (changed(UASTC, 20, 4000), "64 bytes of pixels for 32000"),
            (changed(ZSTANDARD, 24, 2), "cannot be read"),
            (changed(UASTC, 28, 1), "a volume"),
            (changed(UASTC, 32, 2), "several pictures"),
            (changed(UASTC, 36, 6), "several pictures"),
            (changed(UASTC, 44, 3), "way 3"),
            (changed(UASTC, 12, 145), "format 145"),
            (changed(UASTC, 48, u32::MAX), "neither UASTC nor ETC1S"),
            (changed(ETC1S, 80, u32::MAX), "cut off"),
            (changed(ETC1S, 204, u32::MAX), "damaged"),
            (changed(ETC1S, 40, u32::MAX), "damaged"),
            (plain_ktx2(43, 3), "bytes of pixels for 168"),
        ] {
            let message = refused(&bytes);
            assert!(message.contains(words), "{message}");
        }
        for bytes in [WEBP, ETC1S, UASTC, ZSTANDARD] {
            for length in 0..bytes.len() {
                drop(read(&bytes[..length], 0, &mut 42));
                let mut damaged = bytes.to_vec();
                for change in [1, 0x80, 0xff] {
                    damaged[length] = bytes[length] ^ change;
                    drop(read(&damaged, 0, &mut 4200));
                }
            }
        }
    }
}
