//! Clumps of leaves that a round crown is drawn of: where rays from the eye meet them, and how deep between them.
//!
//! Clumps are balls in the crown's own measure, in which half its size is 1; all crowns have the same, each turned its own ray
//! around the upright. Colours alone know of them: labels, ids and depth have the whole crown.

use super::pattern::{least, most, smoothstep};
use super::vector::Vec3;

/// Middles and radii of the clumps.
pub const CLUMPS: [[f32; 4]; 20] = [
    [0.164, 0.049, 0.584, 0.465],
    [-0.189, 0.212, 0.522, 0.436],
    [0.086, -0.399, 0.540, 0.490],
    [0.356, 0.401, 0.551, 0.373],
    [-0.495, -0.112, 0.418, 0.391],
    [0.693, -0.254, 0.492, 0.255],
    [-0.181, 0.700, 0.389, 0.252],
    [-0.304, -0.635, 0.300, 0.311],
    [0.661, 0.356, 0.246, 0.314],
    [-0.549, 0.405, 0.162, 0.432],
    [0.279, -0.598, 0.100, 0.483],
    [0.198, 0.570, 0.041, 0.417],
    [-0.500, -0.337, -0.008, 0.428],
    [0.701, -0.362, -0.074, 0.365],
    [-0.298, 0.466, -0.098, 0.459],
    [-0.274, -0.690, -0.196, 0.293],
    [0.641, 0.475, -0.285, 0.287],
    [-0.675, 0.147, -0.317, 0.340],
    [0.337, -0.560, -0.376, 0.384],
    [-0.069, 0.612, -0.438, 0.266],
];
/// How far leaves stand out or back on each clump, for each that they do elsewhere: where two clumps meet, neither has a smooth edge.
pub const SWAY: [f32; 20] =
    [1.6, -1.3, 0.3, -1.8, 2.2, 1.0, -0.9, 2.0, -2.2, 0.6, -1.5, 2.4, -0.4, 1.4, -2.0, 0.8, 1.9, -1.1, 2.1, -1.7];
/// Radius of the dark inside of a crown.
const INSIDE: f32 = 0.78;
/// How much farther a clump counts that a ray passes by, for each radius squared.
const PASSED: f32 = 6.0;

/// A ray in a crown's own measure, in which half its size is 1.
#[derive(Clone, Copy)]
pub struct CrownRay {
    from: Vec3,
    along: Vec3,
    /// How far the beginning is along the ray from beside the middle of the crown.
    begun: f32,
    /// How far the beginning is from the middle of the crown, squared.
    away: f32,
}

impl CrownRay {
    /// From a place in a direction of length 1.
    #[inline(always)]
    pub fn new(from: Vec3, along: Vec3) -> Self {
        Self { from, along, begun: from.dot(along), away: from.dot(from) }
    }

    /// Where the ray begins.
    #[inline(always)]
    pub fn from(self) -> Vec3 {
        self.from
    }

    /// Where it goes, of length 1.
    #[inline(always)]
    pub fn along(self) -> Vec3 {
        self.along
    }

    /// How far along the ray a ball's middle is, and the ball's radius less the ray's distance from its middle, both squared;
    /// negative where the ray passes by.
    #[inline(always)]
    fn meet(self, middle: Vec3, radius_squared: f32) -> (f32, f32) {
        let ahead = self.along.dot(middle) - self.begun;
        let room = radius_squared - middle.dot(middle) - self.away;
        (ahead, room + 2.0 * middle.dot(self.from) + ahead * ahead)
    }
}

/// `N` rays side by side.
#[derive(Clone, Copy)]
pub struct CrownRays<const N: usize> {
    from: [[f32; N]; 3],
    along: [[f32; N]; 3],
    begun: [f32; N],
    away: [f32; N],
}

impl<const N: usize> CrownRays<N> {
    /// Nothing in particular.
    pub const EMPTY: Self = Self { from: [[0.0; N]; 3], along: [[0.0; N]; 3], begun: [0.0; N], away: [0.0; N] };

    /// Ray `k`.
    #[inline(always)]
    pub fn at(&self, k: usize) -> CrownRay {
        let [from, along] = [&self.from, &self.along].map(|rows| Vec3::new(rows[0][k], rows[1][k], rows[2][k]));
        CrownRay { from, along, begun: self.begun[k], away: self.away[k] }
    }

    /// Sets ray `k`.
    #[inline(always)]
    pub fn put(&mut self, k: usize, ray: CrownRay) {
        for (rows, v) in [(&mut self.from, ray.from), (&mut self.along, ray.along)] {
            (rows[0][k], rows[1][k], rows[2][k]) = (v.x, v.y, v.z);
        }
        (self.begun[k], self.away[k]) = (ray.begun, ray.away);
    }

    /// How much of each ray meets the crown's clumps at most, see [`NearestClump::met`].
    #[inline(always)]
    pub fn most_met(&self, most_of: &mut [f32; N]) {
        for (k, most_of) in most_of.iter_mut().enumerate() {
            *most_of = self.at(k).meet(Vec3::ZERO, INSIDE * INSIDE).1;
        }
        for [x, y, z, radius] in CLUMPS {
            for (k, most_of) in most_of.iter_mut().enumerate() {
                *most_of = most(*most_of, self.at(k).meet(Vec3::new(x, y, z), radius * radius).1);
            }
        }
    }
}

/// The clump that the eye sees along a ray.
#[derive(Clone, Copy, Debug)]
pub struct NearestClump {
    /// How far along the ray.
    pub reach: f32,
    /// Middle of the clump.
    pub middle: Vec3,
    /// The clump's radius less the ray's distance from its middle, both squared; negative where the ray passes by.
    pub met: f32,
}

impl NearestClump {
    /// The dark inside of the crown.
    #[inline(always)]
    pub fn inside(ray: CrownRay) -> Self {
        let (ahead, met) = ray.meet(Vec3::ZERO, INSIDE * INSIDE);
        Self { reach: ahead - most(met, 0.0).sqrt() + PASSED * most(-met, 0.0), middle: Vec3::ZERO, met }
    }

    /// The nearer one of this and another clump.
    #[inline(always)]
    pub fn or(self, ray: CrownRay, middle: Vec3, radius_squared: f32) -> Self {
        let (ahead, met) = ray.meet(middle, radius_squared);
        let reach = ahead - most(met, 0.0).sqrt() + PASSED * most(-met, 0.0);
        let is_nearer = reach < self.reach;
        let pick = |new: f32, old: f32| if is_nearer { new } else { old };
        let Vec3 { x, y, z } = self.middle;
        Self {
            reach: pick(reach, self.reach),
            middle: Vec3::new(pick(middle.x, x), pick(middle.y, y), pick(middle.z, z)),
            met: pick(met, self.met),
        }
    }

    /// Where the ray meets the clump, or is nearest to it.
    #[inline(always)]
    pub fn place(self, ray: CrownRay) -> Vec3 {
        ray.from + ray.along * (self.reach - PASSED * most(-self.met, 0.0))
    }
}

/// How far out of the shade between clumps a place lies: 0 deep inside, 1 on the outermost leaves.
#[inline(always)]
pub fn outwards(place: Vec3) -> f32 {
    smoothstep(0.68, 1.08, least(place.dot(place).sqrt(), 2.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pattern::draw;

    /// CrownRays onto a crown from around it, evenly spread.
    fn rays() -> impl Iterator<Item = CrownRay> {
        (0..4000).map(|number| {
            let draw = |index| 2.0 * draw(number, index) - 1.0;
            let from = Vec3::new(draw(0), draw(1), draw(2)).unit() * 6.0;
            let to = Vec3::new(draw(3), draw(4), draw(5)) * 0.7;
            CrownRay::new(from, (to - from).unit())
        })
    }

    /// The clump whose surface is nearest along a ray, by steps of a hundredth.
    fn by_steps(ray: CrownRay) -> Option<Vec3> {
        let balls = || CLUMPS.iter().map(|[x, y, z, r]| (Vec3::new(*x, *y, *z), *r)).chain([(Vec3::ZERO, INSIDE)]);
        (450..800).find_map(|step| {
            let place = ray.from + ray.along * (0.01 * step as f32);
            let is_in = |(middle, radius): &(Vec3, f32)| (place - *middle).dot(place - *middle) < radius * radius;
            balls().find(is_in).map(|(middle, _)| middle)
        })
    }

    #[test]
    fn the_nearest_clump_is_the_one_that_steps_along_the_ray_find() {
        let (mut same, mut passed, mut met) = (0, 0, 0);
        for ray in rays() {
            let balls = CLUMPS.iter().map(|[x, y, z, r]| (Vec3::new(*x, *y, *z), r * r));
            let nearest =
                balls.fold(NearestClump::inside(ray), |nearest, (middle, squared)| nearest.or(ray, middle, squared));
            let mut side_by_side = CrownRays::<1>::EMPTY;
            side_by_side.put(0, ray);
            let mut most_of = [0.0];
            side_by_side.most_met(&mut most_of);
            match by_steps(ray) {
                None => {
                    passed += 1;
                    assert!(most_of[0] < 0.01 && nearest.met < 0.01, "{nearest:?}");
                }
                Some(middle) => {
                    met += 1;
                    assert!(most_of[0] > 0.0);
                    same += u32::from((middle - nearest.middle).dot(middle - nearest.middle) < 1e-9);
                    // Where the ray meets the clump lies on its surface.
                    let radius =
                        CLUMPS.iter().find(|clump| clump[2] == nearest.middle.z).map_or(INSIDE, |clump| clump[3]);
                    let on = nearest.place(ray) - nearest.middle;
                    assert!(nearest.met < 0.0 || (on.dot(on).sqrt() - radius).abs() < 1e-3, "{nearest:?}");
                }
            }
        }
        assert!(passed > 20 && met > 3000 && 100 * same > 90 * met, "{passed} passed, {met} met, {same} the same");
    }

    #[test]
    fn clumps_cover_the_upper_side_of_a_crown_and_reach_its_outline() {
        let farthest = |out: Vec3| {
            let reach = |[x, y, z, radius]: &[f32; 4]| {
                let middle = Vec3::new(*x, *y, *z);
                let ahead = out.dot(middle);
                let met = radius * radius - middle.dot(middle) + ahead * ahead;
                if met > 0.0 { ahead + met.sqrt() } else { 0.0 }
            };
            CLUMPS.iter().map(reach).fold(INSIDE, f32::max)
        };
        let around = (0..2000).map(|number| {
            let draw = |index| 2.0 * draw(number, index) - 1.0;
            farthest(Vec3::new(draw(0), draw(1), draw(2).abs() - 0.2).unit())
        });
        let reaches: Vec<f32> = around.collect();
        let open = reaches.iter().filter(|reach| **reach < 0.85).count();
        assert!(open < 200, "{open} of 2000 look into the crown");
        assert!(reaches.iter().all(|reach| *reach < 1.2));
    }
}
