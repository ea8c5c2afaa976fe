//! Gauss-Newton equations of a whole flight: residuals in, one banded linear solve out.
//!
//! The cost around the present waypoints is `sum w r^2` with `r(x + d) = r + J d`. Its minimum solves
//! `H d = -g` with `H = sum w J J^T` and `g = sum w r J`. Costs of one waypoint touch one 3x3 block of H; differences up to the
//! third couple the same axis of up to four neighbours. So H has half-bandwidth three in blocks.

use cosfly_frames::{DMat3, DVec3};

/// A term that knows only its slope moves a waypoint by at most about this much per step, metres.
const SLOPE_STEP_M: f64 = 0.5;
/// Coefficients of differences by order; order 0 is the value itself.
pub const DIFFERENCES: [&[f64]; 4] = [&[1.0], &[-1.0, 1.0], &[1.0, -2.0, 1.0], &[-1.0, 3.0, -3.0, 1.0]];

/// Normal equations of a flight's waypoints.
#[derive(Default)]
pub struct NormalEquations {
    /// Per frame: the part of H of this waypoint alone.
    own: Vec<DMat3>,
    /// Per frame: H's entries (same axis) with itself and the three frames before.
    coupling: Vec<[f64; 4]>,
    /// Half the slope.
    slope: Vec<DVec3>,
    /// Factors, kept for the next time.
    factor: Vec<[DMat3; 4]>,
    spare: Vec<DVec3>,
}

impl NormalEquations {
    /// Empties the equations for `frames` waypoints.
    pub fn reset(&mut self, frames: usize) {
        self.own.clear();
        self.own.resize(frames, DMat3::ZERO);
        self.coupling.clear();
        self.coupling.resize(frames, [0.0; 4]);
        self.slope.clear();
        self.slope.resize(frames, DVec3::ZERO);
    }

    /// Adds `weight * residual^2` of one waypoint; `jacobian` is the residual's slope there.
    pub fn add(&mut self, frame: usize, weight: f64, residual: f64, jacobian: DVec3) {
        let scaled = weight * jacobian;
        let outer = DMat3::from_cols(scaled * jacobian.x, scaled * jacobian.y, scaled * jacobian.z);
        self.own[frame] += outer;
        self.slope[frame] += residual * scaled;
    }

    /// Adds `weight * |waypoint - wished|^2`.
    pub fn add_anchor(&mut self, frame: usize, weight: f64, departure: DVec3) {
        self.coupling[frame][0] += weight;
        self.slope[frame] += weight * departure;
    }

    /// Adds `weight * |D w|^2` of all differences of an order, 1 to 3.
    pub fn add_differences(&mut self, order: usize, weight: f64, waypoints: &[DVec3]) {
        let coefficients = DIFFERENCES[order];
        for (start, w) in waypoints.windows(order + 1).enumerate() {
            let value: DVec3 = w.iter().zip(coefficients).map(|(w, c)| *w * *c).sum();
            for (a, ca) in coefficients.iter().enumerate() {
                self.slope[start + a] += weight * ca * value;
                for (b, cb) in coefficients[..=a].iter().enumerate() {
                    self.coupling[start + a][a - b] += weight * ca * cb;
                }
            }
        }
    }

    /// Adds a cost of which only the gradient is known.
    pub fn add_gradient(&mut self, frame: usize, gradient: DVec3) {
        self.slope[frame] += 0.5 * gradient;
        self.coupling[frame][0] += 0.5 * gradient.length() / SLOPE_STEP_M;
    }

    /// Sum of the squares of the slope: 0 where nothing pulls.
    pub fn slope(&self, frame: usize) -> DVec3 {
        self.slope[frame]
    }

    /// The step to the minimum, one displacement per waypoint. `hold` is added to every diagonal entry; the
    /// equations must then be positive definite.
    pub fn solve(&mut self, hold: f64, step: &mut Vec<DVec3>) {
        let n = self.own.len();
        self.factor.clear();
        self.spare.clear();
        for i in 0..n {
            // Row i of L in H = L L^T, blocks i-3 ..= i; the diagonal block is kept inverted.
            let mut row = [DMat3::ZERO; 4];
            let mut right = -self.slope[i];
            for k in (1..=3.min(i)).rev() {
                let j = i - k;
                let mut block = DMat3::from_diagonal(DVec3::splat(self.coupling[i][k]));
                for (m, farther) in row.iter().enumerate().take(3.min(i) + 1).skip(k + 1) {
                    block -= *farther * self.factor[j][m - k].transpose();
                }
                row[k] = block * self.factor[j][0].transpose();
                right -= row[k] * self.spare[j];
            }
            let mut diagonal = self.own[i] + DMat3::from_diagonal(DVec3::splat(self.coupling[i][0] + hold));
            for block in &row[1..] {
                diagonal -= *block * block.transpose();
            }
            row[0] = inverse_cholesky(&diagonal);
            self.spare.push(row[0] * right);
            self.factor.push(row);
        }
        step.clear();
        step.resize(n, DVec3::ZERO);
        for i in (0..n).rev() {
            let mut right = self.spare[i];
            for k in 1..=3.min(n - 1 - i) {
                right -= self.factor[i + k][k].transpose() * step[i + k];
            }
            step[i] = self.factor[i][0].transpose() * right;
        }
    }
}

/// The inverse of L, `a = L L^T` with L lower triangular.
fn inverse_cholesky(a: &DMat3) -> DMat3 {
    let positive = |value: f64| if value > 1e-300 { value.sqrt() } else { 1e-150 };
    let l00 = positive(a.x_axis.x);
    let (l10, l20) = (a.x_axis.y / l00, a.x_axis.z / l00);
    let l11 = positive(a.y_axis.y - l10 * l10);
    let l21 = (a.y_axis.z - l20 * l10) / l11;
    let l22 = positive(a.z_axis.z - l20 * l20 - l21 * l21);
    let (i0, i1, i2) = (1.0 / l00, 1.0 / l11, 1.0 / l22);
    let i10 = -l10 * i0 * i1;
    let i21 = -l21 * i1 * i2;
    let i20 = -(l20 * i0 + l21 * i10) * i2;
    DMat3::from_cols(DVec3::new(i0, i10, i20), DVec3::new(0.0, i1, i21), DVec3::new(0.0, 0.0, i2))
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_random::Seed;

    #[test]
    fn a_step_leads_to_the_minimum_of_the_squares() {
        let mut stream = Seed::of_item(1, "equations", "solve").stream("t");
        for n in [1_usize, 2, 3, 4, 5, 30] {
            let mut point = |size: f64| {
                DVec3::new(stream.uniform(-size, size), stream.uniform(-size, size), stream.uniform(-size, size))
            };
            let waypoints: Vec<DVec3> = (0..n).map(|_| point(9.0)).collect();
            let residuals: Vec<(f64, DVec3)> = (0..2 * n).map(|_| (point(2.0).x, point(1.0))).collect();
            let wished: Vec<DVec3> = (0..n).map(|_| point(9.0)).collect();
            let cost = |step: &[DVec3]| {
                let moved: Vec<DVec3> = waypoints.iter().zip(step).map(|(w, d)| *w + *d).collect();
                let ones = |k: usize| (residuals[k].0 + residuals[k].1.dot(step[k % n])).powi(2);
                let differences = |order: usize| -> f64 {
                    let d = |w: &[DVec3]| w.iter().zip(DIFFERENCES[order]).map(|(w, c)| *w * *c).sum::<DVec3>();
                    moved.windows(order + 1).map(|w| d(w).length_squared()).sum()
                };
                let anchors: f64 = moved.iter().zip(&wished).map(|(w, to)| 0.1 * w.distance_squared(*to)).sum();
                (0..2 * n).map(ones).sum::<f64>() + anchors + 0.7 * differences(2) + 0.3 * differences(3)
            };
            let mut equations = NormalEquations::default();
            equations.reset(n);
            residuals.iter().enumerate().for_each(|(k, (r, j))| equations.add(k % n, 1.0, *r, *j));
            for frame in 0..n {
                equations.add_anchor(frame, 0.1, waypoints[frame] - wished[frame]);
            }
            equations.add_differences(2, 0.7, &waypoints);
            equations.add_differences(3, 0.3, &waypoints);
            let mut step = Vec::new();
            equations.solve(0.0, &mut step);
            let lowest = cost(&step);
            for frame in 0..n {
                for axis in 0..3 {
                    for change in [-1e-3, 1e-3] {
                        let mut other = step.clone();
                        other[frame][axis] += change;
                        assert!(cost(&other) > lowest, "{n} {frame} {axis}");
                    }
                }
            }
        }
    }
}
