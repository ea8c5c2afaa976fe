//! Pictures of areas of people: grey PNG files, checked before any stage runs.

use cosfly_diagnose::{Diagnostic, Fault, Result, contained};
use cosfly_pedestrians::{AreaConfig, AreaPicture};
use cosfly_stage::{Source, SourceCheck};
use serde_json::Value;
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Most pixels along a side.
const MOST_SIDE: u32 = 8192;
/// Smallest and largest pixel in the town, metres.
const PIXEL_M: [f64; 2] = [0.02, 100.0];
/// Most by which a pixel may be wider than high, or higher than wide: more is a wrong place.
const MOST_STRETCH: f64 = 1.1;
/// Form of a picture of an area.
const FORM: &str = "a grey PNG of 8 bits a pixel, without transparency: white has the whole `weight`, black none; \
    `magick FILE -alpha off -colorspace Gray -depth 8 -define png:color-type=0 MASK.png` writes one";

/// Files of the areas' pictures; what they hold counts, so their names leave the parameters. `table` are the keys to `areas`.
pub fn take_sources(areas: &mut [AreaConfig], table: &str) -> Vec<Source> {
    let mut sources = vec![];
    for (index, area) in areas.iter_mut().enumerate() {
        let placed = area.clone();
        let Some(picture) = &mut area.picture else { continue };
        let path = std::mem::replace(picture, "(content)".into());
        let settle = Arc::new(move |path: &Path| read_picture(&placed, path).map(drop));
        let read = Arc::new(|_: &Path| Ok(Value::Bool(true)));
        let check = SourceCheck { describes: String::new(), read, settle: Some(settle) };
        sources.push(Source { check: Some(check), ..Source::new(format!("{table}areas.{index}.picture"), path) });
    }
    sources
}

/// The areas with the pixels of their pictures, from the files of [`take_sources`].
///
/// # Errors
/// Files that are no pictures of areas.
pub fn with_pixels(areas: &[AreaConfig], files: &[PathBuf]) -> Result<Vec<AreaConfig>> {
    let mut files = files.iter();
    let filled = |area: &AreaConfig| {
        let Some(path) = area.picture.as_ref().and_then(|_| files.next()) else { return Ok(area.clone()) };
        Ok(AreaConfig { pixels: Some(Arc::new(read_picture(area, path)?)), ..area.clone() })
    };
    areas.iter().map(filled).collect()
}

fn read_picture(area: &AreaConfig, path: &Path) -> Result<AreaPicture> {
    let refused = |why: String, hint: &str| {
        Diagnostic::new("area-picture", Fault::Input, format!("`{}` cannot be the picture of an area", path.display()))
            .because(why)
            .hint(hint)
    };
    // The library may panic on damaged files.
    let read = contained(|| grey_png(path)).unwrap_or_else(|| Err("it holds what no encoder writes".into()));
    let picture = read.map_err(|why| refused(why, FORM))?;
    let [from, to] = [area.min_m, area.max_m].map(Option::unwrap_or_default);
    let [width_m, height_m] = [0, 1].map(|axis| (to[axis] - from[axis]) / picture.size[axis] as f64);
    let pixel = format!("a pixel of it would be {width_m:.3} m wide and {height_m:.3} m high");
    let of = format!("`min_m`, `max_m` and its {} x {} pixels", picture.size[0], picture.size[1]);
    let [least, most] = PIXEL_M;
    let rule = if ![width_m, height_m].iter().all(|side| (least..=most).contains(side)) {
        format!("it must be from {least} to {most} m")
    } else if width_m.max(height_m) > MOST_STRETCH * width_m.min(height_m) {
        "pixels must be square, within 10 %".to_owned()
    } else {
        return Ok(picture);
    };
    Err(refused(
        format!("by {of}, {pixel}; {rule}"),
        "`min_m` and `max_m` are the places of the picture's corners in the world, metres",
    ))
}

fn grey_png(path: &Path) -> Result<AreaPicture, String> {
    let file = File::open(path).map_err(|error| error.to_string())?;
    let failed = |error: png::DecodingError| format!("it is no PNG file that can be read: {error}");
    let mut reader = png::Decoder::new(BufReader::new(file)).read_info().map_err(failed)?;
    let (width, height, (colour, depth)) = (reader.info().width, reader.info().height, reader.output_color_type());
    if width.max(height) > MOST_SIDE {
        return Err(format!("it has {width} x {height} pixels; at most {MOST_SIDE} along a side are read"));
    }
    match (colour, depth) {
        (png::ColorType::Grayscale, png::BitDepth::Eight) => {}
        (png::ColorType::Grayscale, depth) => return Err(format!("it has {} bits a pixel", depth as u8)),
        (png::ColorType::GrayscaleAlpha, _) => return Err("it has a channel of transparency".into()),
        _ => return Err("it is a picture in colours".into()),
    }
    let mut grey = vec![0; width as usize * height as usize];
    reader.next_frame(&mut grey).map_err(failed)?;
    if grey.iter().all(|value| *value == 0) {
        return Err("it is black everywhere; a part must be lighter".into());
    }
    Ok(AreaPicture { size: [width as usize, height as usize], grey })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(size: [u32; 2], colour: png::ColorType, depth: png::BitDepth, value: u8, max_m: [f64; 2]) -> String {
        let path = std::env::temp_dir()
            .join(format!("cosfly-area-{}-{size:?}{colour:?}{depth:?}{value}.png", std::process::id()));
        let mut encoder = png::Encoder::new(File::create(&path).unwrap(), size[0], size[1]);
        encoder.set_color(colour);
        encoder.set_depth(depth);
        let bits = colour.samples() * depth as usize * size[0] as usize;
        let bytes = vec![value; bits.div_ceil(8) * size[1] as usize];
        encoder.write_header().unwrap().write_image_data(&bytes).unwrap();
        let area = AreaConfig {
            picture: Some(String::new()),
            min_m: Some([0.0; 2]),
            max_m: Some(max_m),
            ..AreaConfig::default()
        };
        let read = read_picture(&area, &path);
        std::fs::remove_file(&path).unwrap();
        read.err().map_or_else(String::new, |error| format!("{error:?}"))
    }

    #[test]
    fn pictures_that_are_no_masks_are_refused_with_the_reason() {
        use png::BitDepth::{Eight, Four, Sixteen};
        use png::ColorType::{Grayscale, GrayscaleAlpha, Rgb};
        let square = [30.0, 20.0];
        for (size, colour, depth, value, max_m, reason) in [
            ([30, 20], Rgb, Eight, 9, square, "in colours"),
            ([30, 20], GrayscaleAlpha, Eight, 9, square, "transparency"),
            ([30, 20], Grayscale, Sixteen, 9, square, "16 bits"),
            ([30, 20], Grayscale, Four, 9, square, "4 bits"),
            ([30, 20], Grayscale, Eight, 0, square, "black everywhere"),
            ([8193, 1], Grayscale, Eight, 9, square, "at most 8192"),
            ([30, 20], Grayscale, Eight, 8, [0.03, 0.02], "from 0.02 to 100 m"),
            ([30, 20], Grayscale, Eight, 7, [20.0, 30.0], "must be square"),
        ] {
            let found = refusal(size, colour, depth, value, max_m);
            assert!(found.contains(reason), "{found}");
        }
        assert_eq!(refusal([30, 20], Grayscale, Eight, 9, square), "");
    }
}
