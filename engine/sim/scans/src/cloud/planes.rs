//! [`PlaneSums`]: how far points are from one plane, from sums that can be added.

use cosfly_frames::DVec3;

/// Fewer points lie in any plane.
const LEAST_POINTS: f64 = 6.0;

/// Sums over points.
#[derive(Clone, Copy, Debug, Default)]
pub struct PlaneSums {
    count: f64,
    sum: DVec3,
    /// Sums of xx, yy, zz and of xy, xz, yz.
    squares: DVec3,
    products: DVec3,
}

impl PlaneSums {
    /// Adds a point.
    pub fn add(&mut self, at: DVec3) {
        self.count += 1.0;
        self.sum += at;
        self.squares += at * at;
        self.products += DVec3::new(at.x * at.y, at.x * at.z, at.y * at.z);
    }

    /// Adds all points of another.
    pub fn join(&mut self, other: &Self) {
        self.count += other.count;
        self.sum += other.sum;
        self.squares += other.squares;
        self.products += other.products;
    }

    /// Root of the mean squared height above the plane that fits best, metres; infinite for too few points.
    pub fn roughness_m(&self) -> f64 {
        if self.count < LEAST_POINTS {
            return f64::INFINITY;
        }
        let mean = self.sum / self.count;
        let [xx, yy, zz] = (self.squares / self.count - mean * mean).to_array();
        let [xy, xz, yz] =
            (self.products / self.count - DVec3::new(mean.x * mean.y, mean.x * mean.z, mean.y * mean.z)).to_array();
        let area = xx * yy - xy * xy;
        // Points in one line fit any slope across it.
        let explained = if area > 1e-9 {
            let (along_x, along_y) = ((xz * yy - yz * xy) / area, (yz * xx - xz * xy) / area);
            along_x * xz + along_y * yz
        } else {
            0.0
        };
        (zz - explained).max(0.0).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_are_smooth_and_steps_are_rough() {
        let (mut slope, mut step) = (PlaneSums::default(), PlaneSums::default());
        for i in 0..100 {
            let (x, y) = (500.0 + f64::from(i % 10), 300.0 + f64::from(i / 10));
            slope.add(DVec3::new(x, y, 0.7 * x - 0.3 * y));
            step.add(DVec3::new(x, y, f64::from((i % 2) * 2)));
        }
        assert!(slope.roughness_m() < 1e-3 && (step.roughness_m() - 1.0).abs() < 0.05);
        assert_eq!(PlaneSums::default().roughness_m(), f64::INFINITY);
    }
}
