//! LAS 1.4, point format 6, of a sweep: what the format has no field for are extra bytes.

use cosfly_schema::log::cloud::CloudPoint;

/// Bytes of the header.
const HEADER: u16 = 375;
/// Bytes of the head of a variable record, and of the description of an attribute in it.
const RECORD_HEAD: u16 = 54;
const ATTRIBUTE: u16 = 192;
/// Attributes in extra bytes: name, type by the format's number, meaning.
const ATTRIBUTES: [(&str, u8, &str); 2] =
    [("instance", 5, "instance id as in pictures"), ("ring", 3, "number of the beam in a shot")];
/// Bytes of a point: those of format 6 and of the attributes.
const POINT: u16 = 30 + 4 + 2;
/// Steps of coordinates, metres.
const STEP_M: f64 = 1e-4;
/// Coordinate systems are texts, as format 6 wants them; there is none.
const TEXTS: u16 = 1 << 4;
/// One echo of one.
const ONLY_ECHO: u8 = 0x11;

/// The file of a sweep that begins at a time, seconds.
pub(super) fn file(begins_s: f64, points: &[CloudPoint]) -> Vec<u8> {
    let steps = |point: &CloudPoint| point.place_m.map(|metres| (f64::from(metres) / STEP_M).round() as i32);
    let records = RECORD_HEAD + ATTRIBUTE * ATTRIBUTES.len() as u16;
    let mut bytes = Vec::with_capacity(usize::from(HEADER + records) + points.len() * usize::from(POINT));
    bytes.extend(b"LASF\0\0");
    bytes.extend(TEXTS.to_le_bytes());
    bytes.extend([0; 16]);
    bytes.extend([1, 4]);
    put_text(&mut bytes, "SIMULATION", 32);
    put_text(&mut bytes, "cosfly", 32);
    // No day: the same sweep is the same file.
    bytes.extend([0; 4]);
    bytes.extend(HEADER.to_le_bytes());
    bytes.extend(u32::from(HEADER + records).to_le_bytes());
    bytes.extend(1_u32.to_le_bytes());
    bytes.push(6);
    bytes.extend(POINT.to_le_bytes());
    // Counts of 32 bits, which format 6 does not use.
    bytes.extend([0; 24]);
    bytes.extend([STEP_M; 3].map(f64::to_le_bytes).as_flattened());
    bytes.extend([0; 24]);
    for axis in 0..3 {
        let along = || points.iter().map(|point| steps(point)[axis]);
        let ends = [along().max(), along().min()].map(|end| f64::from(end.unwrap_or(0)) * STEP_M);
        bytes.extend(ends.map(f64::to_le_bytes).as_flattened());
    }
    // No wave forms, no records behind the points.
    bytes.extend([0; 20]);
    let counts = [points.len() as u64; 2].into_iter().chain([0; 14]);
    bytes.extend(counts.flat_map(u64::to_le_bytes));
    put_attributes(&mut bytes);
    for point in points {
        bytes.extend(steps(point).map(i32::to_le_bytes).as_flattened());
        let intensity = (point.intensity * f32::from(u16::MAX)).round() as u16;
        bytes.extend(intensity.to_le_bytes());
        bytes.extend([ONLY_ECHO, 0, u8::try_from(point.label).unwrap_or(u8::MAX), 0, 0, 0, 0, 0]);
        bytes.extend((begins_s + f64::from(point.time_s)).to_le_bytes());
        bytes.extend(point.instance.to_le_bytes());
        bytes.extend(point.ring.to_le_bytes());
    }
    bytes
}

/// The record that describes the extra bytes.
fn put_attributes(bytes: &mut Vec<u8>) {
    bytes.extend([0; 2]);
    put_text(bytes, "LASF_Spec", 16);
    bytes.extend(4_u16.to_le_bytes());
    bytes.extend((ATTRIBUTE * ATTRIBUTES.len() as u16).to_le_bytes());
    put_text(bytes, "extra bytes", 32);
    for (name, kind, doc) in ATTRIBUTES {
        bytes.extend([0, 0, kind, 0]);
        put_text(bytes, name, 32);
        bytes.extend([0; 4 + 5 * 24]);
        put_text(bytes, doc, 32);
    }
}

/// A text in a field of so many bytes, zeros behind it.
fn put_text(bytes: &mut Vec<u8>, text: &str, size: usize) {
    let end = bytes.len() + size;
    bytes.extend(text.as_bytes());
    bytes.resize(end, 0);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_has_the_sizes_of_its_header_and_all_numbers_of_a_point() {
        let first = CloudPoint { place_m: [1.25, -2.5, 0.0001], intensity: 0.5, ..CloudPoint::default() };
        let last = CloudPoint { time_s: 0.25, ring: 7, label: 14, instance: 70_000, ..first };
        let bytes = file(3.0, &[first, last]);
        let at = u32::from_le_bytes(bytes[96..100].try_into().unwrap()) as usize;
        assert_eq!((at, bytes.len()), (375 + 54 + 2 * 192, at + 2 * 36));
        assert_eq!(u64::from_le_bytes(bytes[247..255].try_into().unwrap()), 2);
        let point = &bytes[at + 36..];
        let int = |at: usize| i32::from_le_bytes(point[at..at + 4].try_into().unwrap());
        assert_eq!([int(0), int(4), int(8), int(30)], [12_500, -25_000, 1, 70_000]);
        assert_eq!(u16::from_le_bytes(point[12..14].try_into().unwrap()), 32_768);
        assert_eq!((point[16], u16::from_le_bytes(point[34..36].try_into().unwrap())), (14, 7));
        assert_eq!(f64::from_le_bytes(point[22..30].try_into().unwrap()), 3.25);
        assert_eq!(f64::from_le_bytes(bytes[187..195].try_into().unwrap()), 12_500.0 * STEP_M);
    }
}
