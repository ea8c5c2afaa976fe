//! Bicycles, electric scooters and motorcycles with their riders. All sizes follow the box.

use super::model::Model;
use crate::Clothes;
use crate::frustum::{Surface, ring};
use crate::region::Region;
use cosfly_frames::{DVec3, real};

/// Size of the box that a person who sits is made for, and height of that person when standing, metres.
pub(super) const SEATED_M: DVec3 = DVec3::new(1.05, 0.65, 1.32);
const STANDING_M: f64 = 1.72;

/// Sizes that the shares of both vehicles are made for, metres.
const BICYCLE_M: DVec3 = DVec3::new(1.80, 0.65, 1.75);
const E_SCOOTER_M: DVec3 = DVec3::new(1.15, 0.61, 1.87);
const MOTORCYCLE_M: DVec3 = DVec3::new(2.10, 0.80, 1.60);

/// Places of a rider, in box heights forward and up.
pub(super) struct Seat {
    pub hip: [f64; 2],
    pub shoulder: [f64; 2],
    pub hand: [f64; 2],
    /// Half the distance between the hands.
    pub half_grip: f64,
    pub feet: [[f64; 2]; 2],
    /// Half the distance between the feet.
    pub half_stand: f64,
    /// Whether a helmet covers the head.
    pub helmet: bool,
}

/// A bicycle; `phase_rad` turns its pedals.
pub(super) fn bicycle(model: &mut Model<'_>, clothes: &Clothes, phase_rad: f64) {
    let stretch = model.size_m / BICYCLE_M;
    let at = |x_m: f64, y_m: f64, z_m: f64| stretch * DVec3::new(x_m, y_m, z_m);
    let radius_m = 0.34;
    let axle_m = 0.90 - radius_m;
    for sign in [-1.0, 1.0] {
        model.spoked_wheel([sign * axle_m * stretch.x, 0.0], radius_m * stretch, 0.034 * stretch.y);
    }
    let (rear, front) = (at(-axle_m, 0.0, radius_m), at(axle_m, 0.0, radius_m));
    let (crank, seat, head) = (at(-0.08, 0.0, 0.28), at(-0.22, 0.0, 0.90), at(0.40, 0.0, 0.92));
    let thick_m = 0.035 * stretch.min_element();
    for (from, to) in [(rear, crank), (rear, at(-0.19, 0.0, 0.74)), (crank, seat), (crank, head), (head, front)] {
        model.bar(Region::Paint, from, to, thick_m);
    }
    model.bar(Region::Paint, at(-0.18, 0.0, 0.72), at(0.38, 0.0, 0.84), thick_m);
    model.bar(Region::Trim, at(-0.34, 0.0, 0.91), at(-0.08, 0.0, 0.91), 2.2 * thick_m);
    handlebar(model, 0.40 * stretch.x, 1.02 * stretch.z, thick_m);
    let pedal = |turn_rad: f64| {
        let (sin, cos) = real::sin_cos(turn_rad);
        [(-0.08 + 0.165 * sin) / 1.75, (0.30 + 0.165 * cos) / 1.75]
    };
    // Ahead means forward over the top.
    let feet = [pedal(phase_rad), pedal(phase_rad + real::PI)];
    let seat = Seat {
        hip: [-0.115, 0.545],
        shoulder: [0.02, 0.815],
        hand: [0.20, 0.595],
        half_grip: 0.145,
        feet,
        half_stand: 0.060,
        helmet: false,
    };
    rider(&mut model.rider(BICYCLE_M), &seat, forearm(clothes));
}

/// A motorcycle.
pub(super) fn motorcycle(model: &mut Model<'_>, clothes: &Clothes) {
    let stretch = model.size_m / MOTORCYCLE_M;
    let at = |x_m: f64, z_m: f64| [x_m / MOTORCYCLE_M.x, z_m / MOTORCYCLE_M.z];
    let radius_m = 0.31;
    let axle_m = 1.05 - radius_m;
    for sign in [-1.0, 1.0] {
        model.solid_wheel(sign * axle_m * stretch.x, radius_m * stretch, 0.16 * stretch.y);
    }
    // Engine, exhausts, tank, seat, tail, fairing, mudguards, screen.
    model.hull(Region::Metal, &[at(-0.30, 0.20), at(0.26, 0.20), at(0.34, 0.54), at(-0.38, 0.54)], [0.19, 0.17]);
    model.hull(Region::Paint, &[at(-0.06, 0.54), at(0.34, 0.56), at(0.36, 0.80), at(0.04, 0.88)], [0.24, 0.18]);
    model.hull(Region::Trim, &[at(-0.78, 0.58), at(0.0, 0.56), at(0.02, 0.76), at(-0.70, 0.82)], [0.20, 0.17]);
    model.hull(Region::Paint, &[at(-0.98, 0.70), at(-0.62, 0.56), at(-0.60, 0.78), at(-0.92, 0.82)], [0.16, 0.12]);
    model.hull(Region::Paint, &[at(0.30, 0.34), at(0.52, 0.50), at(0.64, 0.80), at(0.40, 0.94)], [0.27, 0.20]);
    model.hull(Region::Paint, &[at(0.50, 0.60), at(0.98, 0.58), at(0.88, 0.67), at(0.58, 0.67)], [0.11, 0.11]);
    model.hull(Region::Glass, &[at(0.46, 0.90), at(0.56, 0.90), at(0.42, 1.10), at(0.38, 1.08)], [0.15, 0.13]);
    for sign in [-1.0, 1.0] {
        let pipe = [[-0.95, 0.36], [-0.05, 0.24]].map(|[x, z]| stretch * DVec3::new(x, 0.17 * sign, z));
        model.bar(Region::Metal, pipe[0], pipe[1], 0.09 * stretch.min_element());
    }
    let fork = stretch * DVec3::new(0.48, 0.0, 0.90);
    let axle = stretch * DVec3::new(axle_m, 0.0, radius_m);
    let thick_m = 0.05 * stretch.min_element();
    model.bar(Region::Metal, fork, axle, thick_m);
    model.bar(
        Region::Metal,
        stretch * DVec3::new(-0.3, 0.0, 0.36),
        stretch * DVec3::new(-axle_m, 0.0, radius_m),
        thick_m,
    );
    handlebar(model, 0.40 * stretch.x, 0.98 * stretch.z, 0.7 * thick_m);
    lamp(model, Region::HeadLamp, 0.645, [0.70, 0.84]);
    lamp(model, Region::TailLamp, -0.97, [0.70, 0.79]);
    let foot = [0.02, 0.17];
    let seat = Seat {
        hip: [-0.13, 0.50],
        shoulder: [0.0, 0.80],
        hand: [0.22, 0.625],
        half_grip: 0.19,
        feet: [foot; 2],
        half_stand: 0.12,
        helmet: true,
    };
    rider(&mut model.rider(MOTORCYCLE_M), &seat, forearm(clothes));
}

/// A scooter: a board for the feet behind a shield.
pub(super) fn scooter(model: &mut Model<'_>, clothes: &Clothes) {
    let stretch = model.size_m / MOTORCYCLE_M;
    let at = |x_m: f64, z_m: f64| [x_m / MOTORCYCLE_M.x, z_m / MOTORCYCLE_M.z];
    let radius_m = 0.24;
    let axle_m = 1.05 - radius_m;
    for sign in [-1.0, 1.0] {
        model.solid_wheel(sign * axle_m * stretch.x, radius_m * stretch, 0.14 * stretch.y);
    }
    model.hull(Region::Paint, &[at(-0.98, 0.40), at(-0.30, 0.22), at(-0.22, 0.62), at(-0.90, 0.64)], [0.22, 0.18]);
    model.hull(Region::Trim, &[at(-0.36, 0.20), at(0.42, 0.20), at(0.42, 0.28), at(-0.36, 0.28)], [0.20, 0.20]);
    model.hull(Region::Paint, &[at(0.34, 0.24), at(0.46, 0.24), at(0.62, 0.86), at(0.50, 0.92)], [0.26, 0.22]);
    model.hull(Region::Paint, &[at(0.56, 0.42), at(0.98, 0.46), at(0.90, 0.54), at(0.58, 0.54)], [0.10, 0.10]);
    model.hull(Region::Trim, &[at(-0.86, 0.64), at(-0.14, 0.62), at(-0.16, 0.74), at(-0.80, 0.76)], [0.18, 0.15]);
    let thick_m = 0.05 * stretch.min_element();
    let (top, axle) = (stretch * DVec3::new(0.50, 0.0, 0.92), stretch * DVec3::new(axle_m, 0.0, radius_m));
    model.bar(Region::Metal, top, axle, thick_m);
    handlebar(model, 0.46 * stretch.x, 0.98 * stretch.z, 0.7 * thick_m);
    lamp(model, Region::HeadLamp, 0.635, [0.76, 0.86]);
    lamp(model, Region::TailLamp, -0.965, [0.50, 0.58]);
    let seat = Seat {
        hip: [-0.20, 0.50],
        shoulder: [-0.13, 0.80],
        hand: [0.25, 0.625],
        half_grip: 0.19,
        feet: [[0.14, 0.18]; 2],
        half_stand: 0.08,
        helmet: true,
    };
    rider(&mut model.rider(MOTORCYCLE_M), &seat, forearm(clothes));
}

/// An electric scooter: a low board between two small wheels and a tall stem; its rider stands with one foot ahead.
pub(super) fn e_scooter(model: &mut Model<'_>, clothes: &Clothes) {
    let stretch = model.size_m / E_SCOOTER_M;
    let at = |x_m: f64, z_m: f64| stretch * DVec3::new(x_m, 0.0, z_m);
    let share = |x_m: f64, z_m: f64| [x_m / E_SCOOTER_M.x, z_m / E_SCOOTER_M.z];
    let radius_m = 0.115;
    let axle_m = 0.5 * E_SCOOTER_M.x - radius_m;
    for sign in [-1.0, 1.0] {
        model.solid_wheel(sign * axle_m * stretch.x, radius_m * stretch, 0.05 * stretch.y);
    }
    let board = [share(-0.46, 0.13), share(-0.30, 0.09), share(0.26, 0.09), share(0.34, 0.15), share(-0.42, 0.17)];
    model.hull(Region::Paint, &board, [0.30, 0.30]);
    let (thick_m, grip_m) = (0.05 * stretch.min_element(), [0.33, 1.08]);
    model.bar(Region::Paint, at(axle_m, radius_m), at(0.40, 0.24), thick_m);
    model.bar(Region::Paint, at(0.30, 0.12), at(0.40, 0.24), thick_m);
    model.bar(Region::Metal, at(0.40, 0.24), at(grip_m[0], grip_m[1]), 0.8 * thick_m);
    handlebar(model, grip_m[0] * stretch.x, grip_m[1] * stretch.z, 0.7 * thick_m);
    let seat = Seat {
        hip: [-0.05, 0.6],
        shoulder: [-0.015, 0.835],
        hand: [0.165, 0.59],
        half_grip: 0.125,
        feet: [[0.045, 0.088], [-0.10, 0.088]],
        half_stand: 0.034,
        helmet: false,
    };
    rider(&mut model.rider(E_SCOOTER_M), &seat, forearm(clothes));
}

/// A lamp in the middle plane at `x` and between two heights, in metres of a motorcycle's usual box.
fn lamp(model: &mut Model<'_>, region: Region, x: f64, [low, high]: [f64; 2]) {
    let stretch = model.size_m / MOTORCYCLE_M;
    let corners = [[-0.08, low], [0.08, low], [0.08, high], [-0.08, high]];
    let corners = corners.map(|[y, z]| stretch * DVec3::new(x, y, z));
    model.face(region, &corners, DVec3::new(0.0, 0.0, corners[0].z));
}

/// A bar across the whole width.
fn handlebar(model: &mut Model<'_>, x_m: f64, z_m: f64, thick_m: f64) {
    let half_m = 0.5 * model.size_m.y;
    model.bar(Region::Trim, DVec3::new(x_m, -half_m, z_m), DVec3::new(x_m, half_m, z_m), thick_m);
}

/// Forearms, bare or covered.
pub(super) fn forearm(clothes: &Clothes) -> Region {
    if clothes.short_sleeves { Region::Skin } else { Region::Top }
}

/// Somebody who sits on what stands on the ground, in a box that was made for [`SEATED_M`]. Places of the seat are shares of the height of
/// the person when standing: the surface is that of somebody who stands so deep that the head reaches the top of the box.
pub(super) fn seated(model: &mut Model<'_>, seat: &Seat, clothes: &Clothes) {
    let stretch = model.size_m.z / SEATED_M.z;
    let mut person = model.rider(SEATED_M);
    person.feet -= DVec3::Z * ((STANDING_M - SEATED_M.z) * stretch);
    person.height = STANDING_M * stretch;
    rider(&mut person, seat, forearm(clothes));
}

/// Somebody who sits; the head reaches the top of the box.
pub(super) fn rider(body: &mut Surface<'_>, seat: &Seat, forearm: Region) {
    let ([hip_x, hip_z], [neck_x, neck_z]) = (seat.hip, seat.shoulder);
    let (head, face) = if seat.helmet { (Region::Hair, 1.3) } else { (Region::Skin, 1.0) };
    body.part(
        ring(hip_x - 0.02, 0.0, hip_z - 0.05, 0.085, 0.065),
        ring(hip_x + 0.01, 0.0, hip_z + 0.05, 0.090, 0.066),
        Region::Trousers,
    );
    body.part(
        ring(hip_x + 0.01, 0.0, hip_z + 0.03, 0.090, 0.066),
        ring(neck_x - 0.01, 0.0, neck_z, 0.118, 0.070),
        Region::Top,
    );
    body.part(
        ring(neck_x - 0.01, 0.0, neck_z, 0.118, 0.070),
        ring(neck_x, 0.0, neck_z + 0.04, 0.05, 0.045),
        Region::Top,
    );
    body.part(
        ring(neck_x, 0.0, neck_z + 0.02, 0.034, 0.034),
        ring(neck_x + 0.02, 0.0, 0.90, 0.034, 0.034),
        Region::Skin,
    );
    body.part(
        ring(neck_x + 0.035, 0.0, 0.87, face * 0.038, face * 0.046),
        ring(neck_x + 0.03, 0.0, 0.945, face * 0.052, face * 0.058),
        head,
    );
    body.part(
        ring(neck_x + 0.015, 0.0, 0.905, 0.056, 0.060),
        ring(neck_x + 0.02, 0.0, 0.965, 0.062, 0.070),
        Region::Hair,
    );
    body.part(
        ring(neck_x + 0.02, 0.0, 0.965, 0.062, 0.070),
        ring(neck_x + 0.015, 0.0, 1.0, 0.036, 0.042),
        Region::Hair,
    );
    for (side, [foot_x, foot_z]) in [-1.0, 1.0].into_iter().zip(seat.feet) {
        arm(body, seat, side, forearm);
        let hip = [hip_x + 0.01, hip_z - 0.01];
        let ankle = [foot_x - 0.015, foot_z + 0.04];
        let [knee_x, knee_z] = joint(hip, ankle, 0.255, 0.255);
        let (near, far) = (side * 0.052, side * seat.half_stand);
        let middle = 0.5 * (near + far) + side * 0.012;
        body.part(
            ring(knee_x, middle, knee_z, 0.034, 0.040),
            ring(hip[0], near, hip[1], 0.050, 0.058),
            Region::Trousers,
        );
        body.part(
            ring(ankle[0], far, ankle[1], 0.026, 0.030),
            ring(knee_x, middle, knee_z, 0.035, 0.040),
            Region::Trousers,
        );
        let sole = (foot_z - 0.005).max(0.0);
        body.part(
            ring(foot_x + 0.012, far, sole, 0.028, 0.072),
            ring(ankle[0] + 0.01, far, ankle[1], 0.026, 0.040),
            Region::Shoes,
        );
    }
}

fn arm(body: &mut Surface<'_>, seat: &Seat, side: f64, forearm: Region) {
    let ([neck_x, neck_z], [hand_x, hand_z]) = (seat.shoulder, seat.hand);
    let (near, far) = (side * 0.122, side * seat.half_grip);
    let elbow = [0.5 * (neck_x + hand_x) - 0.012, 0.5 * (neck_z + hand_z) - 0.03];
    let middle = 0.5 * (near + far) + side * 0.008;
    body.part(
        ring(elbow[0], middle, elbow[1], 0.025, 0.028),
        ring(neck_x, near, neck_z - 0.01, 0.031, 0.036),
        Region::Top,
    );
    body.part(
        ring(hand_x - 0.02, far, hand_z + 0.005, 0.021, 0.022),
        ring(elbow[0], middle, elbow[1], 0.026, 0.029),
        forearm,
    );
    body.part(
        ring(hand_x + 0.005, far, hand_z - 0.02, 0.018, 0.026),
        ring(hand_x, far, hand_z + 0.02, 0.018, 0.022),
        Region::Skin,
    );
}

/// The knee between a hip and an ankle, ahead of both: thigh and shin have these lengths, or are stretched.
fn joint(hip: [f64; 2], ankle: [f64; 2], thigh: f64, shin: f64) -> [f64; 2] {
    let (x, z) = (ankle[0] - hip[0], ankle[1] - hip[1]);
    let length = (x * x + z * z).sqrt().max(1e-6);
    let along = ((thigh * thigh - shin * shin + length * length) / (2.0 * length)).clamp(0.0, length);
    let aside = (thigh * thigh - along * along).max(0.0).sqrt();
    [hip[0] + (along * x - aside * z) / length, hip[1] + (along * z + aside * x) / length]
}
