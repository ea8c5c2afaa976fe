//! Obstacles to a walking body: rectangles in plan with a height range.

use crate::PedestrianError;
use cosfly_domain::Town;
use cosfly_frames::{DVec2, DVec3, real};

/// Highest thing that a foot steps over, metres.
const STEP_OVER_M: f64 = 0.05;

/// Side of a bucket of the index, metres.
const BUCKET_M: f64 = 8.0;

/// One obstacle's footprint.
#[derive(Clone, Copy, Debug)]
pub struct Footprint {
    center: DVec2,
    half: DVec2,
    sin: f64,
    cos: f64,
    z_min: f64,
    z_max: f64,
    /// Half the size of its axis-aligned bounds.
    pub reach: DVec2,
}

impl Footprint {
    /// Middle in plan.
    pub fn center(&self) -> DVec2 {
        self.center
    }

    /// Whether a body on ground between two heights meets its height range.
    pub fn meets_body(&self, z_low: f64, z_high: f64, height_m: f64) -> bool {
        self.z_min < z_high + height_m && self.z_max > z_low + STEP_OVER_M
    }

    fn in_own_axes(&self, point: DVec2) -> DVec2 {
        let offset = point - self.center;
        DVec2::new(self.cos * offset.x + self.sin * offset.y, self.cos * offset.y - self.sin * offset.x)
    }

    /// Distance in plan between the segment and the footprint; 0 when they touch.
    pub fn distance_m(&self, from: DVec2, to: DVec2) -> f64 {
        let (a, b) = (self.in_own_axes(from), self.in_own_axes(to));
        if crosses_box(a, b, self.half) {
            return 0.0;
        }
        let outside = |point: DVec2| (point.abs() - self.half).max(DVec2::ZERO).length();
        let mut distance = outside(a).min(outside(b));
        let step = b - a;
        let length_squared = step.length_squared();
        for corner in
            [self.half, -self.half, DVec2::new(self.half.x, -self.half.y), DVec2::new(-self.half.x, self.half.y)]
        {
            let share =
                if length_squared > 0.0 { ((corner - a).dot(step) / length_squared).clamp(0.0, 1.0) } else { 0.0 };
            distance = distance.min((a + share * step - corner).length());
        }
        distance
    }
}

/// Whether the segment meets the box of half size `half` around the origin.
fn crosses_box(a: DVec2, b: DVec2, half: DVec2) -> bool {
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    for axis in 0..2 {
        let (start, step, half) = (a[axis], b[axis] - a[axis], half[axis]);
        if step == 0.0 {
            if start.abs() > half {
                return false;
            }
            continue;
        }
        let (near, far) = ((-half - start) / step, (half - start) / step);
        enter = enter.max(near.min(far));
        leave = leave.min(near.max(far));
    }
    enter <= leave
}

/// All footprints of a town with an index.
#[derive(Clone, Debug)]
pub struct Obstruction {
    /// Footprints that touch the indexed rectangle.
    pub footprints: Vec<Footprint>,
    min: DVec2,
    columns: usize,
    rows: usize,
    buckets: Vec<Vec<u32>>,
}

impl Obstruction {
    /// Indexes the obstacles that reach into the rectangle.
    pub fn new(town: &Town, min: DVec2, max: DVec2) -> Result<Self, PedestrianError> {
        let size = (max - min) / BUCKET_M;
        let (columns, rows) = (size.x as usize + 1, size.y as usize + 1);
        let mut own = Self { footprints: vec![], min, columns, rows, buckets: vec![vec![]; columns * rows] };
        for (obstacle, thing) in town.obstacles.iter().enumerate() {
            let shape = &thing.shape;
            let finite =
                shape.center_in_world.is_finite() && shape.half_extents_m.is_finite() && shape.yaw_rad.is_finite();
            if !finite {
                return Err(PedestrianError::BrokenObstacle { obstacle });
            }
            let (sin, cos) = real::sin_cos(shape.yaw_rad);
            let half = shape.half_extents_m.truncate();
            let footprint = Footprint {
                center: shape.center_in_world.truncate(),
                half,
                sin,
                cos,
                z_min: shape.center_in_world.z - shape.half_extents_m.z,
                z_max: shape.center_in_world.z + shape.half_extents_m.z,
                reach: DVec2::new(cos.abs() * half.x + sin.abs() * half.y, sin.abs() * half.x + cos.abs() * half.y),
            };
            let id = own.footprints.len() as u32;
            let mut inside = false;
            own.each_bucket(footprint.center - footprint.reach, footprint.center + footprint.reach, |buckets, at| {
                buckets[at].push(id);
                inside = true;
            });
            if inside {
                own.footprints.push(footprint);
            }
        }
        Ok(own)
    }

    fn bucket_range(&self, min: DVec2, max: DVec2) -> Option<(usize, usize, usize, usize)> {
        let low = ((min - self.min) / BUCKET_M).floor().max(DVec2::ZERO);
        let high = ((max - self.min) / BUCKET_M).floor();
        if high.x < 0.0 || high.y < 0.0 || low.x >= self.columns as f64 || low.y >= self.rows as f64 {
            return None;
        }
        let last = ((high.x as usize).min(self.columns - 1), (high.y as usize).min(self.rows - 1));
        Some((low.x as usize, last.0, low.y as usize, last.1))
    }

    fn each_bucket(&mut self, min: DVec2, max: DVec2, mut visit: impl FnMut(&mut [Vec<u32>], usize)) {
        if let Some((left, right, top, bottom)) = self.bucket_range(min, max) {
            for row in top..=bottom {
                for column in left..=right {
                    visit(&mut self.buckets, row * self.columns + column);
                }
            }
        }
    }

    /// Whether a body of the given size walks the straight step without coming nearer than its radius.
    pub fn lets_through(&self, from: DVec3, to: DVec3, radius_m: f64, height_m: f64) -> bool {
        let (low, high) = (from.min(to), from.max(to));
        let Some((left, right, top, bottom)) = self.bucket_range(low.truncate() - radius_m, high.truncate() + radius_m)
        else {
            return true;
        };
        (top..=bottom).all(|row| {
            (left..=right).all(|column| {
                self.buckets[row * self.columns + column].iter().all(|&id| {
                    let footprint = &self.footprints[id as usize];
                    !footprint.meets_body(low.z, high.z, height_m)
                        || footprint.distance_m(from.truncate(), to.truncate()) >= radius_m
                })
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::test_towns::{pillar, town};

    #[test]
    fn distances_to_a_turned_footprint_are_exact() {
        let mut post = pillar((0.0, 0.0), 1.0, 3.0);
        post.shape.yaw_rad = core::f64::consts::FRAC_PI_4;
        let town = town(vec![], vec![post]);
        let things = Obstruction::new(&town, DVec2::splat(-50.0), DVec2::splat(50.0)).unwrap();
        let reach = 2.0_f64.sqrt();
        let distance =
            |a: (f64, f64), b: (f64, f64)| things.footprints[0].distance_m(DVec2::new(a.0, a.1), DVec2::new(b.0, b.1));
        assert!((distance((-5.0, 3.0), (5.0, 3.0)) - (3.0 - reach)).abs() < 1e-12);
        assert_eq!(distance((-5.0, 0.1), (5.0, 0.1)), 0.0);
        assert!((distance((4.0, 0.0), (4.0, 0.0)) - (4.0 - reach)).abs() < 1e-12);
    }

    #[test]
    fn a_crown_overhead_and_a_plate_underfoot_stop_nobody() {
        let (mut crown, mut plate) = (pillar((0.0, 0.0), 2.0, 1.0), pillar((20.0, 0.0), 2.0, 1.0));
        crown.shape.center_in_world.z = 4.0;
        plate.shape.center_in_world.z = -0.98;
        plate.shape.half_extents_m.z = 1.0;
        let town = town(vec![], vec![crown, plate]);
        let things = Obstruction::new(&town, DVec2::splat(-50.0), DVec2::splat(50.0)).unwrap();
        assert!(things.lets_through(DVec3::new(-9.0, 0.0, 0.0), DVec3::new(30.0, 0.0, 0.0), 0.3, 1.8));
        assert!(!things.lets_through(DVec3::new(-9.0, 0.0, 2.0), DVec3::new(9.0, 0.0, 2.0), 0.3, 1.8));
    }
}
