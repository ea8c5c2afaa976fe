//! `.ply` of the reference trainer: rows of reals under the names of their properties.

use super::{check_count, exponential, logistic};
use crate::cloud::SplatCloud;
use crate::error::SplatError;
use crate::splat::{MOST_COEFFICIENTS, Splat};
use std::collections::BTreeMap;

/// Longest head, bytes.
const LONGEST_HEAD: usize = 64 << 10;
const END: &[u8] = b"end_header\n";
const ANOTHER: &str = "export the scene as the reference trainer writes it: a binary, uncompressed `.ply`, such as `npx @playcanvas/splat-transform packed.ply \
     plain.ply` makes of the packed ones";

/// Where the numbers of a splat stand in a row.
struct Columns {
    count: usize,
    row_bytes: usize,
    /// Middle, first harmonic, opacity, spread, turn.
    own: [usize; 14],
    /// Harmonics beyond the first: those of red, then of green, then of blue.
    further: Vec<usize>,
}

const NAMES: [&str; 14] = [
    "x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2",
    "rot_3",
];

/// Whether a file has points with colours instead of splats.
pub(super) fn is_of_points(bytes: &[u8]) -> bool {
    let within = &bytes[..bytes.len().min(LONGEST_HEAD)];
    let end = within.windows(10).position(|window| window == b"end_header").unwrap_or(0);
    let head = String::from_utf8_lossy(&within[..end]);
    let has = |name: &str| head.lines().any(|line| line.starts_with("property ") && line.trim_end().ends_with(name));
    !has(" f_dc_0") && (has(" red") || has(" r"))
}

pub(super) fn read(bytes: &[u8]) -> Result<SplatCloud, SplatError> {
    let within = &bytes[..bytes.len().min(LONGEST_HEAD)];
    let Some(end) = within.windows(END.len()).position(|window| window == END) else {
        return Err(SplatError::cut_off("the head of the file does not end with `end_header`"));
    };
    let columns = Columns::read(&String::from_utf8_lossy(&bytes[..end]))?;
    check_count(columns.count)?;
    let length = columns.count * columns.row_bytes;
    let Some(rows) = bytes[end + END.len()..].get(..length) else {
        return Err(SplatError::cut_off(format!("the file ends before the last of {} splats", columns.count)));
    };
    let per_channel = columns.further.len() / 3;
    let degree = (1..4).find(|degree| (degree + 1) * (degree + 1) == per_channel + 1).unwrap_or(0);
    let mut cloud = SplatCloud::new(degree);
    for row in rows.chunks_exact(columns.row_bytes) {
        let real = |place: usize| f32::from_le_bytes([row[place], row[place + 1], row[place + 2], row[place + 3]]);
        let own = columns.own.map(real);
        let mut harmonics = [[0.0; 3]; MOST_COEFFICIENTS];
        harmonics[0] = [own[3], own[4], own[5]];
        for (number, harmonic) in harmonics[1..].iter_mut().take(per_channel).enumerate() {
            *harmonic = [0, 1, 2].map(|channel| real(columns.further[channel * per_channel + number]));
        }
        cloud.push(&Splat {
            middle: [own[0], own[1], own[2]],
            spread: [own[7], own[8], own[9]].map(exponential),
            turn: [own[10], own[11], own[12], own[13]],
            opacity: logistic(own[6]),
            harmonics,
        });
    }
    Ok(cloud)
}

impl Columns {
    fn read(head: &str) -> Result<Self, SplatError> {
        let refusal = |message: String| SplatError::new(message, ANOTHER);
        let (mut count, mut row_bytes) = (None, 0);
        let mut places = BTreeMap::new();
        for line in head.lines().skip(1) {
            let words: Vec<&str> = line.split_whitespace().collect();
            let shown: String = line.chars().take(60).collect();
            match words[..] {
                ["format", "binary_little_endian", _] | ["comment" | "obj_info", ..] | [] => {}
                ["element", "vertex", number] if count.is_none() => {
                    let number: usize =
                        number.parse().map_err(|_| refusal(format!("the count of `{shown}` is no number")))?;
                    count = Some(number);
                }
                // Rows of other elements stand behind those of the splats.
                ["element", ..] if count.is_some() => break,
                ["property", kind, name] if count.is_some() => {
                    let bytes =
                        bytes_of(kind).ok_or_else(|| refusal(format!("`{shown}` has a type that is not known")))?;
                    let is_real = matches!(kind, "float" | "float32");
                    if places.insert(name.to_owned(), (row_bytes, is_real)).is_some() {
                        return Err(refusal(format!("`{name}` stands twice in the head")));
                    }
                    row_bytes += bytes;
                }
                _ => return Err(refusal(format!("`{shown}` stands in the head, but not in those of files of splats"))),
            }
        }
        let count = count.ok_or_else(|| refusal("the file has no element `vertex`".to_owned()))?;
        let place = |name: &str| match places.get(name) {
            Some((place, true)) => Ok(*place),
            Some((_, false)) => Err(refusal(format!("`{name}` is no `float`"))),
            None => Err(refusal(format!("the file has no property `{name}`: it seems to hold no splats"))),
        };
        let mut own = [0; NAMES.len()];
        for (own, name) in own.iter_mut().zip(NAMES) {
            *own = place(name)?;
        }
        let further = places.keys().filter(|name| name.starts_with("f_rest_")).count();
        if ![0, 9, 24, 45].contains(&further) {
            return Err(refusal(format!("the file has {further} properties `f_rest_`; there are 0, 9, 24 or 45")));
        }
        let further = (0..further).map(|number| place(&format!("f_rest_{number}"))).collect::<Result<_, _>>()?;
        Ok(Self { count, row_bytes, own, further })
    }
}

/// Bytes of a type of numbers.
fn bytes_of(kind: &str) -> Option<usize> {
    Some(match kind {
        "char" | "uchar" | "int8" | "uint8" => 1,
        "short" | "ushort" | "int16" | "uint16" => 2,
        "int" | "uint" | "int32" | "uint32" | "float" | "float32" => 4,
        "double" | "float64" => 8,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(count: usize, further: usize, rows: &[f32]) -> Vec<u8> {
        let mut head = format!("ply\nformat binary_little_endian 1.0\ncomment a test\nelement vertex {count}\n");
        let more: Vec<String> = (0..further).map(|number| format!("f_rest_{number}")).collect();
        for name in NAMES.iter().copied().chain(more.iter().map(String::as_str)) {
            head += &format!("property float {name}\n");
        }
        head += "end_header\n";
        let mut bytes = head.into_bytes();
        bytes.extend(rows.iter().flat_map(|value| value.to_le_bytes()));
        bytes
    }

    #[test]
    fn splats_of_the_trainer_are_read_channel_by_channel() {
        let mut row = vec![1.0, 2.0, 3.0, 0.5, 0.0, -0.5, 0.0, -1.0, -2.0, -3.0, 1.0, 0.0, 0.0, 0.0];
        row.extend([1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]);
        let cloud = read(&file(1, 9, &row)).expect("a cloud");
        assert_eq!((cloud.len(), cloud.coefficients()), (1, 4));
        assert_eq!(cloud.blocks()[0].opacity[0], 0.5);
        // The second harmonic of red, green and blue.
        assert_eq!([3, 4, 5].map(|lane| cloud.harmonics()[lane][0]), [1.0, 4.0, 7.0]);
        assert!((cloud.blocks()[0].covariance[0][0] - exponential(-2.0)).abs() < 1e-6);
    }

    #[test]
    fn other_files_are_refused_with_what_is_wrong() {
        let refused = |bytes: &[u8]| read(bytes).expect_err("refused").message;
        assert!(refused(&file(2, 0, &[0.0; 14])).contains("last of 2"));
        assert!(refused(&file(usize::MAX, 0, &[])).contains("at most"));
        assert!(refused(&file(1, 7, &[0.0; 21])).contains("7 properties"));
        assert!(refused(b"ply\nformat ascii 1.0\nend_header\n").contains("format ascii"));
        let points = b"ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\nend_header\n";
        assert!(refused(points).contains("`y`"));
        let chunks = b"ply\nformat binary_little_endian 1.0\nelement chunk 1\nend_header\n";
        assert!(refused(chunks).contains("element chunk 1"));
        assert!(refused(b"ply\nformat").contains("end_header"));
    }
}
