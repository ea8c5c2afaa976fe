//! Clouds whose points have colours, as splats are made of them.

use crate::coloured_point::ColouredPoint;
use crate::way_out::or_advice;
use crate::{las, ply};
use cosfly_town::MapError;

/// The way out of a damaged file.
const WAY_OUT: &str = "the file seems to be damaged: fetch it again, or export the cloud anew with its colours";

/// The points of a LAS, LAZ or PLY file with colours.
///
/// # Errors
/// Other formats, damaged or cut files, points without colours.
pub fn read(bytes: &[u8]) -> Result<Vec<ColouredPoint>, MapError> {
    or_advice(if bytes.starts_with(b"LASF") { las::coloured::read(bytes) } else { ply::coloured(bytes) }, WAY_OUT)
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_frames::DVec3;

    #[test]
    fn points_of_a_table_have_their_colours() {
        let text = "ply\nformat ascii 1.0\nelement vertex 2\nproperty double x\nproperty double y\nproperty double z\n\
                    property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n\
                    500000.25 4000000 3 255 128 0\n1 2 3 1 2 3\n";
        let points = read(text.as_bytes()).expect("points");
        assert_eq!(points[0].position, DVec3::new(500_000.25, 4_000_000.0, 3.0));
        assert_eq!(points[0].colour, [255, 128, 0]);
        let plain = text.replace("uchar red", "uchar rot");
        assert!(read(plain.as_bytes()).expect_err("refused").message.contains("`red`"));
    }

    #[test]
    fn surveys_without_colours_are_refused_and_with_them_read_at_both_depths() {
        let mut head = vec![0_u8; 227];
        head[..4].copy_from_slice(b"LASF");
        (head[24], head[25], head[104]) = (1, 2, 2);
        head[94..96].copy_from_slice(&227_u16.to_le_bytes());
        head[96..100].copy_from_slice(&227_u32.to_le_bytes());
        head[105..107].copy_from_slice(&26_u16.to_le_bytes());
        head[107..111].copy_from_slice(&1_u32.to_le_bytes());
        for axis in 0..3 {
            head[131 + 8 * axis..139 + 8 * axis].copy_from_slice(&0.5_f64.to_le_bytes());
        }
        for (colour, expected) in [([0xff00_u16, 0x8000, 0], [255, 128, 0]), ([200, 100, 50], [200, 100, 50])] {
            let mut file = head.clone();
            [4_i32, -2, 6].iter().for_each(|value| file.extend(value.to_le_bytes()));
            file.extend([0; 8]);
            colour.iter().for_each(|value| file.extend(value.to_le_bytes()));
            let points = read(&file).expect("points");
            assert_eq!((points[0].position, points[0].colour), (DVec3::new(2.0, -1.0, 3.0), expected));
        }
        head[104] = 0;
        assert!(read(&head).expect_err("refused").message.contains("no colours"));
    }
}
