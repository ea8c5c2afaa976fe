//! People: jointed figures of frustums whose limbs swing with the gait.

use crate::Clothes;
use crate::body_figure::BodyFigure;
use crate::body_shape::Posture;
use crate::build::Hair;
use crate::frustum::{FigurePart, FigureTriangle, Ring, Surface, around, ring};
use crate::joints::{ArmJoints, Bearing, LegJoints, Limbs};
use crate::region::Region;
use crate::umbrella;
use cosfly_frames::{DVec3, real};

/// Appends the figure of a person on foot whose parts are numbered from `first_part`.
pub(crate) fn person_on_foot(
    figure: &BodyFigure,
    clothes: &Clothes,
    (person, first_part): (u32, u32),
    triangles: &mut Vec<FigureTriangle>,
) {
    let first = triangles.len();
    let (sin, cos) = real::sin_cos(figure.state.heading_rad);
    let mut surface = Surface {
        feet: figure.state.feet_in_world,
        forward: DVec3::new(cos, sin, 0.0),
        right: DVec3::new(-sin, cos, 0.0),
        height: figure.height_m,
        around: around(),
        person,
        parts: first_part,
        triangles,
    };
    for FigurePart { low, high, region } in FigureParts::of(figure, clothes).all() {
        surface.part(*low, *high, *region);
    }
    // Bent legs are shorter: the whole body sinks until a foot stands on the ground.
    let built = &mut triangles[first..];
    let lowest = built.iter().flat_map(|t| t.corners_in_world).map(|p| p.z).fold(f64::INFINITY, f64::min);
    let sink = figure.state.feet_in_world.z - lowest;
    for triangle in built {
        for point in triangle.corners_in_world.iter_mut().chain(&mut triangle.middle_in_world) {
            point.z += sink;
        }
    }
}

/// Most parts of a figure.
pub const MOST_PARTS: usize = 31;

/// The parts of a figure, before it sinks to the ground: closed frustums of [`SIDES`] sides.
pub struct FigureParts {
    count: usize,
    parts: [FigurePart; MOST_PARTS],
}

impl Default for FigureParts {
    fn default() -> Self {
        let nothing = ring(0.0, 0.0, 0.0, 0.0, 0.0);
        let nothing = FigurePart { low: nothing, high: nothing, region: Region::Skin };
        Self { count: 0, parts: [nothing; MOST_PARTS] }
    }
}

impl FigureParts {
    /// The parts of a figure; none without a body.
    pub fn of(figure: &BodyFigure, clothes: &Clothes) -> Self {
        let mut parts = Self::default();
        parts.set(figure, clothes);
        parts
    }

    /// Makes these the parts of a figure; none without a body.
    pub fn set(&mut self, figure: &BodyFigure, clothes: &Clothes) {
        self.count = 0;
        let build = &clothes.build;
        let Limbs { shoulders, hips, legs, arms, bearing } = Limbs::of(figure, build);
        let mut body = Body {
            forearm: if clothes.short_sleeves { Region::Skin } else { Region::Top },
            shoulders,
            hips,
            depth: build.belly,
            parts: self,
        };
        if figure.has_body() {
            body.trunk(build.long_top);
            body.head(build.hair);
            body.luggage(clothes.outfit.backpack, build.shoulder_bag);
            legs.iter().for_each(|leg| body.leg(leg));
            arms.iter().for_each(|arm| body.arm(arm));
            if figure.body.posture() == Posture::Stooped {
                body.stick(&arms[0]);
            }
            body.bear(&bearing);
            if figure.body.has_umbrella() {
                umbrella::parts().into_iter().for_each(|FigurePart { low, high, region }| body.part(low, high, region));
            }
        }
    }

    /// All parts.
    pub fn all(&self) -> &[FigurePart] {
        &self.parts[..self.count]
    }

    /// Height of the lowest ring, body heights: the figure sinks by it.
    pub fn lowest(&self) -> f64 {
        self.all()
            .iter()
            .flat_map(|part| [part.low.up, part.high.up])
            .map(|up| up.max(0.0))
            .fold(f64::INFINITY, f64::min)
    }
}

struct Body<'a> {
    /// Widths relative to the usual.
    shoulders: f64,
    hips: f64,
    /// Depth of the trunk relative to the usual.
    depth: f64,
    forearm: Region,
    parts: &'a mut FigureParts,
}

impl Body<'_> {
    fn part(&mut self, low: Ring, high: Ring, region: Region) {
        self.parts.parts[self.parts.count] = FigurePart { low, high, region };
        self.parts.count += 1;
    }

    fn trunk(&mut self, long_top: bool) {
        let (hips, chest, depth) = (self.hips, self.shoulders, self.depth);
        let waist = 0.5 * (hips + chest);
        let belt = ring(0.0, 0.0, 0.56, 0.088 * hips, 0.066 * depth);
        let middle = ring(0.006 * depth, 0.0, 0.66, 0.096 * waist, 0.070 * depth);
        let breast = ring(0.0, 0.0, 0.775, 0.122 * chest, 0.076);
        self.part(
            ring(0.0, 0.0, 0.46, 0.085 * hips, 0.060),
            ring(0.0, 0.0, 0.57, 0.088 * hips, 0.062),
            Region::Trousers,
        );
        self.part(belt, middle, Region::Top);
        self.part(middle, breast, Region::Top);
        let shoulders = ring(-0.004, 0.0, 0.832, 0.104 * chest, 0.060);
        self.part(breast, shoulders, Region::Top);
        self.part(shoulders, ring(0.0, 0.0, 0.862, 0.042, 0.042), Region::Top);
        if long_top {
            let hem = ring(0.0, 0.0, 0.40, 0.104 * hips, 0.086);
            self.part(hem, ring(0.0, 0.0, 0.57, 0.091 * hips, 0.068 * depth), Region::Top);
        }
        self.part(ring(0.005, 0.0, 0.83, 0.034, 0.034), ring(0.01, 0.0, 0.89, 0.034, 0.034), Region::Skin);
    }

    /// Face, and hair or hat.
    fn head(&mut self, hair: Hair) {
        let cheeks = ring(0.01, 0.0, 0.915, 0.052, 0.058);
        self.part(ring(0.015, 0.0, 0.865, 0.036, 0.044), cheeks, Region::Skin);
        self.part(cheeks, ring(0.008, 0.0, 0.955, 0.052, 0.060), Region::Skin);
        let crown = ring(-0.004, 0.0, 0.965, 0.059, 0.066);
        let lowest = match hair {
            Hair::Cap | Hair::Hat => ring(0.0, 0.0, 0.942, 0.060, 0.066),
            _ => ring(-0.008, 0.0, 0.90, 0.053, 0.052),
        };
        self.part(lowest, crown, Region::Hair);
        self.part(crown, ring(-0.008, 0.0, 1.0, 0.034, 0.040), Region::Hair);
        match hair {
            Hair::Long => {
                self.part(ring(-0.045, 0.0, 0.79, 0.050, 0.022), ring(-0.016, 0.0, 0.93, 0.058, 0.052), Region::Hair);
            }
            Hair::Bun => {
                self.part(ring(-0.072, 0.0, 0.925, 0.026, 0.020), ring(-0.068, 0.0, 0.972, 0.022, 0.024), Region::Hair);
            }
            Hair::Cap => {
                self.part(ring(0.082, 0.0, 0.943, 0.044, 0.040), ring(0.072, 0.0, 0.953, 0.048, 0.036), Region::Hair);
            }
            Hair::Hat => {
                self.part(ring(0.0, 0.0, 0.938, 0.098, 0.106), ring(0.0, 0.0, 0.946, 0.094, 0.102), Region::Hair);
            }
            Hair::Short | Hair::Bald => {}
        }
    }

    fn luggage(&mut self, backpack: bool, shoulder_bag: bool) {
        if backpack {
            self.part(ring(-0.095, 0.0, 0.60, 0.085, 0.045), ring(-0.09, 0.0, 0.80, 0.075, 0.040), Region::Bag);
        } else if shoulder_bag {
            let side = 0.088 * self.hips + 0.022;
            self.part(ring(-0.02, side, 0.43, 0.024, 0.070), ring(-0.02, side, 0.545, 0.020, 0.062), Region::Bag);
        }
    }

    /// Leans the trunk forward and gives the head its size.
    fn bear(&mut self, bearing: &Bearing) {
        let count = self.parts.count;
        for FigurePart { low, high, region } in &mut self.parts.parts[..count] {
            let is_head = low.up >= 0.86 && matches!(region, Region::Skin | Region::Hair);
            for ring in [low, high] {
                (ring.forward, ring.up) = bearing.bear((ring.forward, ring.up));
                if is_head {
                    ring.half_side *= bearing.head;
                    ring.half_forward *= bearing.head;
                }
            }
        }
    }

    fn leg(&mut self, joints: &LegJoints) {
        let LegJoints { right, hip, knee, ankle } = *joints;
        let thick = 0.5 * (1.0 + self.hips);
        self.part(
            ring(knee.0, right, knee.1, 0.034 * thick, 0.038 * thick),
            ring(hip.0, right, hip.1, 0.052 * thick, 0.056 * thick),
            Region::Trousers,
        );
        self.part(
            ring(ankle.0, right, ankle.1, 0.026, 0.030),
            ring(knee.0, right, knee.1, 0.035 * thick, 0.039 * thick),
            Region::Trousers,
        );
        let sole = (ankle.1 - 0.035).max(0.0);
        self.part(
            ring(ankle.0 + 0.035, right, sole, 0.030, 0.078),
            ring(ankle.0 + 0.012, right, ankle.1 + 0.012, 0.026, 0.042),
            Region::Shoes,
        );
    }

    /// A stick from the hand to the level of the lower sole.
    fn stick(&mut self, arm: &ArmJoints) {
        let foot = ring(arm.hand.0 + 0.05, arm.far, self.parts.lowest(), 0.008, 0.008);
        self.part(foot, ring(arm.hand.0, arm.far, arm.hand.1 + 0.02, 0.008, 0.008), Region::Shoes);
    }

    fn arm(&mut self, joints: &ArmJoints) {
        let ArmJoints { right, out, far, tip, shoulder, elbow, wrist, hand } = *joints;
        self.part(ring(elbow.0, out, elbow.1, 0.025, 0.028), ring(shoulder.0, right, 0.79, 0.031, 0.038), Region::Top);
        self.part(ring(shoulder.0, right, 0.785, 0.031, 0.038), ring(0.0, tip, 0.832, 0.016, 0.022), Region::Top);
        self.part(ring(wrist.0, far, wrist.1, 0.022, 0.023), ring(elbow.0, out, elbow.1, 0.027, 0.029), self.forearm);
        self.part(ring(hand.0, far, hand.1, 0.014, 0.021), ring(wrist.0, far, wrist.1, 0.019, 0.021), Region::Skin);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body_figure::gait_phase_rad;
    use crate::{BodyShape, add_figure, figure_triangles};
    use cosfly_frames::{Seed, TargetState};

    fn walking(phase: f64) -> BodyFigure {
        BodyFigure {
            state: TargetState { feet_in_world: DVec3::new(5.0, -3.0, 0.5), heading_rad: 1.0, speed_mps: 1.4 },
            height_m: 1.75,
            radius_m: 0.3,
            clothes_seed: Seed([3; 32]),
            gait_phase_rad: phase,
            body: BodyShape::default(),
        }
    }

    #[test]
    fn the_figure_fills_its_height_and_stays_near_its_cylinder() {
        for step in 0..12 {
            let target = walking(f64::from(step) * 0.55);
            let corners: Vec<DVec3> = figure_triangles(&target).into_iter().flatten().collect();
            let top = corners.iter().map(|p| p.z).fold(f64::NEG_INFINITY, f64::max);
            let low = corners.iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
            assert!((2.1..2.2501).contains(&top) && (low - 0.5).abs() < 1e-9, "{low} to {top}");
            let reach = corners.iter().map(|p| (*p - target.state.feet_in_world).truncate().length());
            assert!(reach.fold(0.0, f64::max) < 0.75);
        }
    }

    #[test]
    fn normals_point_out_of_every_part() {
        let mut triangles = Vec::new();
        let figure = walking(0.7);
        add_figure(&figure, &Clothes::draw(&figure.clothes_seed), 0, &mut triangles);
        assert!(triangles.len() > 300 && triangles.iter().all(|t| (t.normal_in_world.length() - 1.0).abs() < 1e-9));
    }

    #[test]
    fn two_steps_are_one_turn_of_the_phase() {
        assert!(gait_phase_rad(0.83 * 1.75, 1.75).abs() < 1e-9);
        assert!(gait_phase_rad(0.0, 1.75) == 0.0);
    }
}
