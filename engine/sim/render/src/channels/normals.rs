//! Channel `normals`: unit normals of the surfaces.

use cosfly_domain::channels::channel::{Channel, SeenPoint, Source};
use cosfly_frames::DVec3;

/// Unit normals on the camera's side, world frame (CARLA's: x east, y south, z up), three bytes x, y, z:
/// component = (byte - 128) / 127, so that -1, 0 and 1 are exact. The sky, which has no surface, is 0, 0, 0.
pub static CHANNEL: Channel = Channel {
    name: "normals",
    doc: "unit normals of the surfaces on the camera's side, world frame (x east, y south, z up): \
          component = (byte - 128) / 127; 0, 0, 0 for sky.",
    source: Source::Bytes(stored),
    notes: &[
        ("frame", "world of CARLA: x east, y south, z up; not `map`, whose y is minus that"),
        ("value", "(byte - 128) / 127 for x, y, z"),
        ("no_hit", "0, 0, 0"),
    ],
    is_value,
};

/// Three bytes of a normal.
fn stored(point: &SeenPoint) -> [u8; 3] {
    if point.depth_m.is_infinite() {
        return [0; 3];
    }
    point.normal_in_world.to_array().map(|part| (128.0 + 127.0 * part.clamp(-1.0, 1.0)).round() as u8)
}

/// Sky, or a vector of length 1 within the rounding of its components.
fn is_value(stored: &[u8]) -> bool {
    let &[x, y, z] = stored else { return false };
    let part = |byte: u8| (f64::from(byte) - 128.0) / 127.0;
    stored == [0; 3] || (DVec3::new(part(x), part(y), part(z)).length() - 1.0).abs() < 0.01
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(depth_m: f32, normal_in_world: DVec3) -> SeenPoint {
        let (ray_in_world, camera_in_world) = (DVec3::X, DVec3::ZERO);
        SeenPoint { depth_m, label: 0, instance: 0, normal_in_world, ray_in_world, camera_in_world }
    }

    #[test]
    fn axes_are_exact_and_every_direction_is_a_value() {
        assert_eq!(stored(&point(3.0, DVec3::Z)), [128, 128, 255]);
        assert_eq!(stored(&point(3.0, DVec3::NEG_X)), [1, 128, 128]);
        assert_eq!(stored(&point(f32::INFINITY, DVec3::ZERO)), [0; 3]);
        for step in 0..500 {
            let normal = DVec3::new(f64::from(step % 7) - 3.0, f64::from(step % 11) - 5.0, f64::from(step % 13) - 6.5);
            assert!(is_value(&stored(&point(1.0, normal.normalize()))), "{normal}");
        }
        assert!(!is_value(&[128; 3]) && !is_value(&[255; 3]) && !is_value(&[1, 128]));
    }
}
