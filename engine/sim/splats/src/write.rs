//! Files of splats as the reference trainer writes them.

use crate::splat::Splat;
use cosfly_frames::real;

/// Splats as a binary `.ply` with colours of degree 0.
pub fn to_ply(splats: &[Splat], source: &str) -> Vec<u8> {
    // A line of its own, whatever the name is.
    let source = source.replace(char::is_control, " ");
    let mut head =
        format!("ply\nformat binary_little_endian 1.0\ncomment source {source}\nelement vertex {}\n", splats.len());
    for name in "x y z f_dc_0 f_dc_1 f_dc_2 opacity scale_0 scale_1 scale_2 rot_0 rot_1 rot_2 rot_3".split(' ') {
        head += &format!("property float {name}\n");
    }
    head += "end_header\n";
    let mut bytes = head.into_bytes();
    let logarithm = |value: f32| real::ln(value.into()) as f32;
    for splat in splats {
        let opacity = splat.opacity.clamp(1e-6, 1.0 - 1e-6);
        let numbers = splat.middle.into_iter().chain(splat.harmonics[0]);
        let numbers = numbers.chain([logarithm(opacity / (1.0 - opacity))]);
        let numbers = numbers.chain(splat.spread.map(logarithm)).chain(splat.turn);
        numbers.for_each(|number| bytes.extend(number.to_le_bytes()));
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read() {
        let turn = [0.5, -0.5, 0.5, 0.5];
        let splat = Splat::plain([1.0, 2.0, -3.0], [0.1, 0.2, 0.3], turn, 0.9, [0.2, 0.5, 1.0]);
        let cloud = crate::read(&to_ply(&[splat; 3], "of two\nlines.osm")).expect("a cloud").cloud;
        assert_eq!((cloud.len(), cloud.bounds()), (3, [[1.0, 2.0, -3.0]; 2]));
        let block = &cloud.blocks()[0];
        assert!((block.opacity[2] - 0.9).abs() < 1e-5);
        let expected = splat.covariance();
        assert!((0..6).all(|k| (f64::from(block.covariance[k][1]) - expected[k]).abs() < 1e-6));
    }
}
