//! Kinds of vehicles that stand in boxes whose kind nobody states.

use crate::body_shape::BodyShape;
use cosfly_domain::BodyKind;
use cosfly_frames::DVec3;

/// Lengths, widths and heights of vehicles of a kind, mirrors included, metres.
type Sizes = [[f64; 2]; 3];

/// Kinds by their sizes, the first that fits counts.
const KINDS: [(BodyKind, Sizes); 4] = [
    (BodyKind::Car, [[2.6, 5.6], [1.4, 2.35], [1.15, 1.94]]),
    (BodyKind::Van, [[3.8, 7.4], [1.6, 2.6], [1.7, 3.0]]),
    (BodyKind::Truck, [[5.0, 9.5], [1.9, 3.0], [2.2, 4.2]]),
    (BodyKind::Bus, [[8.5, 19.0], [2.2, 3.1], [2.6, 4.2]]),
];

impl BodyShape {
    /// The vehicle that fills a box of a length, width and height in metres; `None` where no vehicle has such a size.
    pub fn of_vehicle_in(size_m: DVec3) -> Option<Self> {
        let fits = |sizes: &Sizes| {
            let sides = sizes.iter().zip(size_m.to_array());
            sides.into_iter().all(|([low, high], side)| (*low..=*high).contains(&side))
        };
        let (kind, _) = KINDS.iter().find(|(_, sizes)| fits(sizes))?;
        Some(Self::Vehicle { kind: *kind, size_m })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_get_vehicles_of_their_size() {
        let kind = |x: f64, y: f64, z: f64| match BodyShape::of_vehicle_in(DVec3::new(x, y, z)) {
            Some(BodyShape::Vehicle { kind, .. }) => Some(kind),
            _ => None,
        };
        assert_eq!(kind(4.4, 1.8, 1.44), Some(BodyKind::Car));
        assert_eq!(kind(4.8, 2.16, 1.49), Some(BodyKind::Car));
        assert_eq!(kind(5.9, 2.0, 2.6), Some(BodyKind::Van));
        assert_eq!(kind(8.4, 2.9, 3.8), Some(BodyKind::Truck));
        assert_eq!(kind(12.0, 2.55, 3.1), Some(BodyKind::Bus));
        for [x, y, z] in [[1.0, 1.0, 1.0], [4.4, 4.4, 1.5], [4.4, 1.8, 6.0], [40.0, 2.5, 3.0], [f64::NAN, 1.8, 1.5]] {
            assert_eq!(kind(x, y, z), None, "{x} {y} {z}");
        }
    }

    #[test]
    fn usual_sizes_of_a_kind_fit_it() {
        for kind in [BodyKind::Car, BodyKind::Van, BodyKind::Bus] {
            let sizes_m = kind.row().driving.as_ref().expect("it drives").sizes_m;
            for end in 0..2 {
                let size_m = DVec3::from_array(sizes_m.map(|side| side[end]));
                assert_eq!(BodyShape::of_vehicle_in(size_m), Some(BodyShape::Vehicle { kind, size_m }));
            }
        }
    }
}
