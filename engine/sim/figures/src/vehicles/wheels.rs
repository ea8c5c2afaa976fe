//! Wheels at the sides of a vehicle, in dark arches; their spokes turn with the way covered.

use super::model::{Model, SPOKES, rim};
use crate::region::Region;
use cosfly_frames::{DVec3, real};

/// Radius of an arch, in radii of its wheel.
const ARCH: f64 = 1.16;
/// Radius of the rim, in radii of the wheel.
const RIM: f64 = 0.68;
/// Dark openings between the spokes of a rim.
const OPENINGS: usize = 5;

/// Radii of the discs of a large wheel, from the rim inwards, in radii of the wheel, and their materials: a plate of steel in whose
/// middle the hub stands.
const PLATE: [(f64, Region); 3] = [(0.56, Region::Metal), (0.46, Region::Trim), (0.26, Region::Metal)];

/// Middle of a wheel, within its tyre.
#[derive(Clone, Copy)]
pub(super) enum Rim {
    /// A rim with openings, at this turn, radians.
    Open(f64),
    /// The plate of a lorry or bus.
    Plate,
}

/// Wheels of an axle.
#[derive(Clone, Copy)]
pub(super) struct Axle {
    /// From the middle of the box forwards, metres.
    pub x_m: f64,
    /// Half the width between the outer sides of the tyres, metres.
    pub half_width_m: f64,
    pub radius_m: f64,
    /// Lowest edge of the sheet beside it, metres; no arch where there is none.
    pub arch_from_m: Option<f64>,
    pub rim: Rim,
}

/// Turn of wheels with openings, radians, that goes on where the phase of a gait of `height_m` does.
pub(super) fn turn_rad(phase_rad: f64, height_m: f64, radius_m: f64) -> f64 {
    let per_opening_m = real::TAU * radius_m.max(0.05) / OPENINGS as f64;
    phase_rad * (0.83 * height_m / per_opening_m).round() / OPENINGS as f64
}

impl Model<'_> {
    /// A wheel on either side.
    pub fn axle(&mut self, axle: &Axle) {
        let Axle { x_m, half_width_m: outer_m, radius_m, rim: kind, .. } = *axle;
        for sign in [-1.0, 1.0] {
            let at = |share: f64, in_m: f64| rim(x_m, radius_m, share, sign * (outer_m - in_m));
            let inside = DVec3::new(x_m, 0.0, radius_m);
            if let Some(from_m) = axle.arch_from_m {
                let around = at(ARCH, 0.016);
                // The first corners lie above the sheet's edge.
                let arch: [DVec3; SPOKES] = core::array::from_fn(|k| {
                    let corner = around[(k + 4) % SPOKES];
                    corner.with_z(corner.z.max(from_m))
                });
                self.face(Region::Trim, &arch, inside);
            }
            let (near, far) = (at(1.0, 0.009), at(1.0, 0.12 * self.size_m.y));
            let beside = DVec3::new(x_m, sign * (outer_m - 0.06 * self.size_m.y), radius_m);
            // Sheet hides the upper half of the tread.
            for k in (0..4).chain(SPOKES - 4..SPOKES) {
                let next = (k + 1) % SPOKES;
                self.face(Region::Tyre, &[near[k], near[next], far[next], far[k]], beside);
            }
            self.face(Region::Tyre, &near, inside);
            let turn_rad = match kind {
                Rim::Open(turn_rad) => turn_rad,
                Rim::Plate => {
                    for ((share, region), in_m) in PLATE.into_iter().zip([0.006, 0.003, 0.0]) {
                        self.face(region, &at(share, in_m), inside);
                    }
                    continue;
                }
            };
            self.face(Region::Metal, &at(RIM, 0.005), inside);
            for opening in 0..OPENINGS {
                let corner = |turn: f64, share: f64| {
                    let (sin, cos) = real::sin_cos(turn_rad + real::TAU * (opening as f64 + turn) / OPENINGS as f64);
                    let (x_m, z_m) = (x_m + share * radius_m * sin, radius_m * (1.0 - share * cos));
                    DVec3::new(x_m, sign * (outer_m - 0.001), z_m)
                };
                let corners = [corner(0.5, 0.2), corner(0.22, 0.58), corner(0.78, 0.58)];
                self.face(Region::Trim, &corners, inside);
            }
        }
    }
}
