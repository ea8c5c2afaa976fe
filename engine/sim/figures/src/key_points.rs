//! Key points of a person, which follow from the joints.

use crate::joints::{ArmJoints, LegJoints, Limbs, Side};
use crate::{BodyFigure, Clothes, FigureParts};
use cosfly_frames::{DVec3, real};

/// COCO's seventeen key points of a person on foot, world frame, in the order of [`cosfly_domain::KEY_POINTS`]; `None` for others.
/// A person with a push-chair or a dog has them as well.
/// They are the joints of the figure, within its limbs; eyes, ears and nose are on the face.
pub fn key_points(figure: &BodyFigure) -> Option<[DVec3; 17]> {
    let figure = &figure.on_foot().filter(BodyFigure::has_body)?;
    let clothes = Clothes::draw(&figure.clothes_seed);
    let Limbs { legs: [left, right], arms: [left_arm, right_arm], bearing, .. } = Limbs::of(figure, &clothes.build);
    let sink = FigureParts::of(figure, &clothes).lowest();
    let (sin, cos) = real::sin_cos(figure.state.heading_rad);
    let (ahead, aside) = (DVec3::new(cos, sin, 0.0), DVec3::new(-sin, cos, 0.0));
    let at = |side: Side, right: f64| {
        let (forward, up) = bearing.bear(side);
        figure.state.feet_in_world + figure.height_m * (ahead * forward + aside * right + DVec3::Z * (up - sink))
    };
    // The head's rings grow around their middle with its size.
    let face =
        |forward: f64, right: f64, up: f64| at((0.01 + bearing.head * (forward - 0.01), up), bearing.head * right);
    let arm =
        |arm: &ArmJoints| [at((arm.shoulder.0, 0.805), arm.right), at(arm.elbow, arm.out), at(arm.wrist, arm.far)];
    let leg = |leg: &LegJoints| [at(leg.hip, leg.right), at(leg.knee, leg.right), at(leg.ankle, leg.right)];
    let [[left_shoulder, left_elbow, left_wrist], [right_shoulder, right_elbow, right_wrist]] =
        [arm(&left_arm), arm(&right_arm)];
    let [[left_hip, left_knee, left_ankle], [right_hip, right_knee, right_ankle]] = [leg(&left), leg(&right)];
    Some([
        face(0.064, 0.0, 0.915),
        face(0.052, -0.018, 0.932),
        face(0.052, 0.018, 0.932),
        face(0.008, -0.042, 0.922),
        face(0.008, 0.042, 0.922),
        left_shoulder,
        right_shoulder,
        left_elbow,
        right_elbow,
        left_wrist,
        right_wrist,
        left_hip,
        right_hip,
        left_knee,
        right_knee,
        left_ankle,
        right_ankle,
    ])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BodyShape, FigureTriangle, add_figure};
    use cosfly_frames::{Seed, TargetState};

    /// Number of parts that a point lies in: a ray from it leaves so many more often than it enters.
    fn parts_around(triangles: &[FigureTriangle], point: DVec3) -> i32 {
        let ray = DVec3::new(0.311, 0.577, 0.755);
        let mut balance = 0;
        for FigureTriangle { corners_in_world: [a, b, c], normal_in_world, .. } in triangles {
            let (ab, ac, to) = (*b - *a, *c - *a, point - *a);
            let across = ray.cross(ac);
            let determinant = ab.dot(across);
            let (u, v) = (to.dot(across) / determinant, ray.dot(to.cross(ab)) / determinant);
            if u >= 0.0 && v >= 0.0 && u + v <= 1.0 && ac.dot(to.cross(ab)) / determinant > 0.0 {
                balance += if ray.dot(*normal_in_world) > 0.0 { 1 } else { -1 };
            }
        }
        balance
    }

    #[test]
    fn key_points_lie_within_the_figure_on_their_own_sides() {
        for number in 0..12u8 {
            let figure = BodyFigure {
                state: TargetState { feet_in_world: DVec3::new(5.0, -3.0, 0.5), heading_rad: 0.0, speed_mps: 1.4 },
                height_m: if number % 3 == 0 { 1.1 } else { 1.75 },
                radius_m: 0.3,
                clothes_seed: Seed([number; 32]),
                gait_phase_rad: f64::from(number) * 0.5,
                body: BodyShape::default(),
            };
            let points = key_points(&figure).expect("a person");
            let mut triangles = vec![];
            add_figure(&figure, &Clothes::draw(&figure.clothes_seed), 0, &mut triangles);
            for (point, name) in points.iter().zip(cosfly_domain::KEY_POINTS) {
                assert!(parts_around(&triangles, *point) > 0, "{name} of {number} is outside");
                let right = (point.y + 3.0) * if name.starts_with("left") { -1.0 } else { 1.0 };
                assert!(name == "nose" || right > 0.005, "{name} is on the other side");
            }
            assert!(points[0].z > points[5].z && points[15].z < points[13].z);
        }
    }
}
