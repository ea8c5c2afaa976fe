//! Predicted pictures: depth as 16-bit PNG or NumPy array, labels as 8-bit PNG or NumPy array.

use cosfly_diagnose::{contained, counted};
use std::fs::File;
use std::io::{BufRead, BufReader, Read, Seek};
use std::path::Path;

/// Kind and words of what is wrong with a file.
pub type Refusal = (&'static str, String);

/// Pixels at most of a picture whose size is not known: more than any camera has.
const MOST_PIXELS: u64 = 1 << 25;

/// Numbers of a picture, row-major.
enum Raster {
    Depth16(Vec<u16>),
    Bytes(Vec<u8>),
    Floats(Vec<f32>),
}

/// Content of a file, told by its beginning.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Content {
    /// Depth.
    Depth,
    /// Labels.
    Labels,
}

/// Content of the picture at `path`, by its head alone; `None` when it cannot be told.
pub fn content(path: &Path) -> Option<Content> {
    let mut file = BufReader::new(File::open(path).ok()?);
    let is_depth = if is_numpy(path) {
        matches!(header(&mut file).ok()?.0.as_str(), "<u2" | "<f2" | "<f4" | "<f8")
    } else {
        contained(|| channel(file, None))?.ok()?.1 == png::BitDepth::Sixteen
    };
    Some(if is_depth { Content::Depth } else { Content::Labels })
}

/// Depth in metres of a picture of `size` (width, height). `per_metre` is what whole numbers count a metre as; the
/// largest of 16 bits is the sky.
///
/// # Errors
/// A file that cannot be read, has another size or other numbers.
pub fn depth_m(path: &Path, size: [u32; 2], per_metre: f64) -> Result<Vec<f32>, Refusal> {
    match sized(path, size)? {
        Raster::Depth16(values) => {
            let metres = |value: u16| {
                if value == u16::MAX { f32::INFINITY } else { (f64::from(value) / per_metre) as f32 }
            };
            Ok(values.into_iter().map(metres).collect())
        }
        Raster::Floats(values) => Ok(values),
        Raster::Bytes(_) => Err(("format", "it has 8 bits a pixel; depth needs 16, or a NumPy array of floats".into())),
    }
}

/// Labels of a picture of `size` (width, height).
///
/// # Errors
/// A file that cannot be read, has another size or other numbers.
pub fn labels(path: &Path, size: [u32; 2]) -> Result<Vec<u8>, Refusal> {
    match sized(path, size)? {
        Raster::Bytes(values) => Ok(values),
        Raster::Depth16(values) => Ok(values.into_iter().map(|value| u8::try_from(value).unwrap_or(u8::MAX)).collect()),
        Raster::Floats(_) => Err(("format", "it has floating-point numbers; labels are whole numbers".into())),
    }
}

fn sized(path: &Path, size: [u32; 2]) -> Result<Raster, Refusal> {
    read(path, Some(size.map(u64::from)))
}

/// Checks the size that a file says it has, before memory is asked for.
fn check(size: [u64; 2], expected: Option<[u64; 2]>) -> Result<(), Refusal> {
    let [columns, rows] = size;
    match expected {
        Some([width, height]) if size != [width, height] => {
            Err(("size", format!("it has {columns} x {rows} pixels; the frame has {width} x {height}")))
        }
        None if columns.saturating_mul(rows) > MOST_PIXELS => {
            Err(("size", format!("it has {columns} x {rows} pixels")))
        }
        _ => Ok(()),
    }
}

/// Reads a picture of the size `expected`, or of any.
fn read(path: &Path, expected: Option<[u64; 2]>) -> Result<Raster, Refusal> {
    let unreadable = |error: &dyn std::fmt::Display| ("unreadable", format!("it cannot be read: {error}"));
    let file = File::open(path).map_err(|error| unreadable(&error))?;
    let file = BufReader::new(file);
    if is_numpy(path) {
        return numpy(file, expected);
    }
    // The library may panic on damaged files.
    contained(|| one_channel(file, expected)).unwrap_or_else(|| Err(unreadable(&"no encoder writes what it holds")))
}

fn is_numpy(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("npy"))
}

/// Reader of a PNG file of one channel and the size `expected`, after its head, and the bits of a pixel.
fn channel<R: BufRead + Seek>(file: R, expected: Option<[u64; 2]>) -> Result<(png::Reader<R>, png::BitDepth), Refusal> {
    let unreadable = |error: &dyn std::fmt::Display| ("unreadable", format!("it cannot be read: {error}"));
    let reader = png::Decoder::new(file).read_info().map_err(|error| unreadable(&error))?;
    let (info_size, colour, depth) = {
        let info = reader.info();
        ([u64::from(info.width), u64::from(info.height)], info.color_type, info.bit_depth)
    };
    check(info_size, expected)?;
    if !matches!(colour, png::ColorType::Grayscale | png::ColorType::Indexed) {
        return Err(("format", "it is a colour picture; one channel was expected".into()));
    }
    match depth {
        png::BitDepth::Eight | png::BitDepth::Sixteen => Ok((reader, depth)),
        other => Err(("format", format!("it has {} bits a pixel; 8 or 16 were expected", other as u8))),
    }
}

fn one_channel(file: impl BufRead + Seek, expected: Option<[u64; 2]>) -> Result<Raster, Refusal> {
    let unreadable = |error: &dyn std::fmt::Display| ("unreadable", format!("it cannot be read: {error}"));
    let (mut reader, depth) = channel(file, expected)?;
    let mut bytes = vec![0; reader.output_buffer_size().ok_or_else(|| unreadable(&"it is too large"))?];
    reader.next_frame(&mut bytes).map_err(|error| unreadable(&error))?;
    if depth == png::BitDepth::Eight {
        return Ok(Raster::Bytes(bytes));
    }
    Ok(Raster::Depth16(bytes.as_chunks::<2>().0.iter().map(|pair| u16::from_be_bytes(*pair)).collect()))
}

/// A NumPy array of two dimensions, or more of which the others are 1.
fn numpy(mut file: impl Read, expected: Option<[u64; 2]>) -> Result<Raster, Refusal> {
    let unreadable = |why: String| ("unreadable", format!("it cannot be read: {why}"));
    let (kind, size) = header(&mut file).map_err(unreadable)?;
    check(size, expected)?;
    numbers(file, &kind, (size[0] * size[1]) as usize).map_err(unreadable)
}

/// Type of the numbers of a NumPy array, and its width and height.
fn header(file: &mut impl Read) -> Result<(String, [u64; 2]), String> {
    let mut start = [0; 10];
    file.read_exact(&mut start).map_err(|error| error.to_string())?;
    if !start.starts_with(b"\x93NUMPY") {
        return Err("it does not begin like a NumPy file".into());
    }
    let mut length = usize::from(u16::from_le_bytes([start[8], start[9]]));
    if start[6] > 1 {
        let mut rest = [0; 2];
        file.read_exact(&mut rest).map_err(|error| error.to_string())?;
        length |= usize::from(u16::from_le_bytes(rest)) << 16;
    }
    if length > 1 << 16 {
        return Err("its header is too long".into());
    }
    let mut header = vec![0; length];
    file.read_exact(&mut header).map_err(|error| error.to_string())?;
    let header = String::from_utf8_lossy(&header).into_owned();
    let after = |key: &str| header.split_once(&format!("'{key}':")).map(|(_, rest)| rest.trim_start());
    if after("fortran_order").is_some_and(|rest| rest.starts_with("True")) {
        return Err("it is stored by columns (Fortran order)".into());
    }
    let kind = after("descr").and_then(|rest| rest.split('\'').nth(1)).ok_or("its header has no `descr`")?;
    let shape = after("shape").and_then(|rest| rest.strip_prefix('(')?.split_once(')')).ok_or("it has no shape")?.0;
    let sides: Result<Vec<u64>, _> =
        shape.split(',').map(str::trim).filter(|side| !side.is_empty()).map(str::parse).collect();
    let sides: Vec<u64> = sides.map_err(|_| "its shape is no list of numbers")?;
    let mut long: Vec<u64> = sides.iter().copied().filter(|side| *side != 1).collect();
    if sides.len() == 2 {
        long = sides;
    }
    let [rows, columns] = long[..] else { return Err(format!("its shape is ({shape}), not height and width")) };
    Ok((kind.to_owned(), [columns, rows]))
}

fn numbers(file: impl Read, kind: &str, count: usize) -> Result<Raster, String> {
    let width = match kind {
        "|u1" => 1,
        "<u2" | "<f2" => 2,
        "<f4" => 4,
        "<f8" => 8,
        other => return Err(format!("its numbers are `{other}`; f2, f4, f8 (depth), u1 and u2 are read")),
    };
    let mut bytes = vec![];
    file.take((width * count) as u64 + 1).read_to_end(&mut bytes).map_err(|error| error.to_string())?;
    if bytes.len() != width * count {
        return Err(format!("it has {} of numbers; {} were expected", counted(bytes.len(), "byte"), width * count));
    }
    Ok(match kind {
        "|u1" => Raster::Bytes(bytes),
        "<u2" => Raster::Depth16(bytes.as_chunks::<2>().0.iter().map(|it| u16::from_le_bytes(*it)).collect()),
        "<f2" => Raster::Floats(bytes.as_chunks::<2>().0.iter().map(|it| half(u16::from_le_bytes(*it))).collect()),
        "<f4" => Raster::Floats(bytes.as_chunks::<4>().0.iter().map(|it| f32::from_le_bytes(*it)).collect()),
        _ => Raster::Floats(bytes.as_chunks::<8>().0.iter().map(|it| narrowed(f64::from_le_bytes(*it))).collect()),
    })
}

/// The nearest number of 32 bits; what is finite stays finite, because infinity is the sky.
fn narrowed(value: f64) -> f32 {
    if value.is_finite() { value.clamp(f64::from(f32::MIN), f64::from(f32::MAX)) as f32 } else { value as f32 }
}

/// A number of 16 bits: sign, five bits of exponent, ten of fraction.
fn half(bits: u16) -> f32 {
    let fraction = f32::from(bits & 0x3ff);
    let size = match (bits >> 10) & 0x1f {
        0 => fraction / 16_777_216.0,
        31 if bits & 0x3ff == 0 => f32::INFINITY,
        31 => f32::NAN,
        exponent => (1.0 + fraction / 1024.0) * f32::from_bits((u32::from(exponent) + 112) << 23),
    };
    if bits & 0x8000 == 0 { size } else { -size }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn array(header: &str, bytes: &[u8]) -> Vec<u8> {
        [&b"\x93NUMPY\x01\x00"[..], &(header.len() as u16).to_le_bytes(), header.as_bytes(), bytes].concat()
    }

    #[test]
    fn arrays_of_one_channel_are_read_and_others_refused_in_words() {
        let header = "{'descr': '<f4', 'fortran_order': False, 'shape': (1, 2, 3), }";
        let bytes: Vec<u8> = (0..6).flat_map(|number| (number as f32).to_le_bytes()).collect();
        let raster = numpy(&array(header, &bytes)[..], Some([3, 2])).unwrap();
        assert!(matches!(raster, Raster::Floats(values) if values == [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]));
        assert_eq!(numpy(&array(header, &bytes)[..], Some([2, 3])).err().unwrap().0, "size");
        for (header, bytes, expected) in [
            (header, &bytes[..20], "20 bytes"),
            ("{'descr': '<i8', 'fortran_order': False, 'shape': (2, 3), }", &bytes[..], "`<i8`"),
            ("{'descr': '<f4', 'fortran_order': True, 'shape': (2, 3), }", &bytes[..], "Fortran"),
            ("{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3, 4), }", &bytes[..], "(2, 3, 4)"),
            ("{'descr': '<f4', 'fortran_order': False, 'shape': (99999999999, 3), }", &bytes[..], "3 x 99999999999"),
            ("{}", &bytes[..], "descr"),
        ] {
            let (_, why) = numpy(&array(header, bytes)[..], None).err().unwrap();
            assert!(why.contains(expected), "{why}");
        }
        assert!(numpy(&b"PK"[..], None).is_err());
    }

    #[test]
    fn size_and_content_of_a_picture_are_known_before_its_pixels_are_unpacked() {
        let mut file = vec![];
        let mut encoder = png::Encoder::new(&mut file, 3, 2);
        encoder.set_color(png::ColorType::Grayscale);
        encoder.set_depth(png::BitDepth::Sixteen);
        encoder.write_header().unwrap().write_image_data(&[1; 12]).unwrap();
        let whole = one_channel(std::io::Cursor::new(&file), Some([3, 2])).unwrap();
        assert!(matches!(whole, Raster::Depth16(values) if values == [257; 6]));
        let data_at = file.windows(4).position(|four| four == b"IDAT").unwrap();
        file.truncate(data_at + 4);
        let head = |expected| channel(std::io::Cursor::new(&file), expected).map(|(_, depth)| depth);
        assert_eq!(head(None).unwrap(), png::BitDepth::Sixteen);
        assert_eq!(head(Some([2, 3])).unwrap_err().0, "size");
        assert_eq!(one_channel(std::io::Cursor::new(&file), Some([3, 2])).err().unwrap().0, "unreadable");
    }

    #[test]
    fn halves_are_those_of_numpy() {
        for (bits, value) in
            [(0x3c00, 1.0), (0xc000, -2.0), (0x3555, 0.333_251_95), (0x0001, 5.960_464_5e-8), (0x7bff, 65504.0)]
        {
            assert_eq!(half(bits), value);
        }
        assert!(half(0x7c00).is_infinite() && half(0x7e00).is_nan());
    }
}
