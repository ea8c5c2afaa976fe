//! Ground heights around a path, sampled once on a grid so that the solver may ask millions of times.

use cosfly_frames::TargetTrack;

/// Largest number of grid points; wider paths get wider cells.
const MAX_POINTS: f64 = 1_000_000.0;

/// Bilinear heights on a regular grid over the path's surroundings; the nearest cell's outside it.
pub struct GroundGrid {
    low: (f64, f64),
    cell_m: f64,
    columns: usize,
    rows: usize,
    z: Vec<f32>,
    highest_m: f64,
    level: bool,
}

impl GroundGrid {
    /// Samples `ground` within `reach_m` of the track. Points where it is not a finite number take the height
    /// of the target at the start of the track.
    pub fn sample(track: &TargetTrack, ground: &dyn Fn(f64, f64) -> f64, reach_m: f64) -> Self {
        let first = track.states.first().map_or(cosfly_frames::DVec3::ZERO, |state| state.feet_in_world);
        let (mut low, mut high) = ((first.x, first.y), (first.x, first.y));
        for state in &track.states {
            let p = state.feet_in_world;
            low = (low.0.min(p.x), low.1.min(p.y));
            high = (high.0.max(p.x), high.1.max(p.y));
        }
        let low = (low.0 - reach_m, low.1 - reach_m);
        let (width, depth) = (high.0 + reach_m - low.0, high.1 + reach_m - low.1);
        let cell_m = (width * depth / MAX_POINTS).sqrt().max(4.0);
        let (columns, rows) = ((width / cell_m).ceil() as usize + 2, (depth / cell_m).ceil() as usize + 2);
        let mut grid =
            Self { low, cell_m, columns, rows, z: vec![f32::NAN; columns * rows], highest_m: 0.0, level: false };
        grid.fill_near(track, ground, reach_m, first.z as f32);
        grid
    }

    /// Only the cells near the path are asked for; the rest are never read.
    fn fill_near(&mut self, track: &TargetTrack, ground: &dyn Fn(f64, f64) -> f64, reach_m: f64, missing: f32) {
        let reach = (reach_m / self.cell_m).ceil() as usize + 1;
        let mut last = (usize::MAX, usize::MAX);
        for state in &track.states {
            let (column, row, _, _) = self.cell(state.feet_in_world.x, state.feet_in_world.y);
            if (column, row) == last {
                continue;
            }
            last = (column, row);
            for r in row.saturating_sub(reach)..(row + reach + 2).min(self.rows) {
                for c in column.saturating_sub(reach)..(column + reach + 2).min(self.columns) {
                    let slot = &mut self.z[r * self.columns + c];
                    if slot.is_nan() {
                        let z = ground(self.low.0 + c as f64 * self.cell_m, self.low.1 + r as f64 * self.cell_m);
                        *slot = if z.is_finite() { z as f32 } else { missing };
                    }
                }
            }
        }
        for z in &mut self.z {
            if z.is_nan() {
                *z = missing;
            }
        }
        let lowest = self.z.iter().copied().fold(f32::MAX, f32::min);
        self.highest_m = f64::from(self.z.iter().copied().fold(f32::MIN, f32::max));
        self.level = f64::from(lowest) == self.highest_m;
    }

    /// The highest sample.
    pub fn highest_m(&self) -> f64 {
        self.highest_m
    }

    fn cell(&self, x_m: f64, y_m: f64) -> (usize, usize, f64, f64) {
        let u = ((x_m - self.low.0) / self.cell_m).clamp(0.0, (self.columns - 2) as f64);
        let v = ((y_m - self.low.1) / self.cell_m).clamp(0.0, (self.rows - 2) as f64);
        (u as usize, v as usize, (u - u.floor()).min(1.0), (v - v.floor()).min(1.0))
    }

    /// Height at a place, metres.
    pub fn z_m(&self, x_m: f64, y_m: f64) -> f64 {
        if self.level {
            return self.highest_m;
        }
        let (c, r, u, v) = self.cell(x_m, y_m);
        let at = |c: usize, r: usize| f64::from(self.z[r * self.columns + c]);
        let near = at(c, r) * (1.0 - u) + at(c + 1, r) * u;
        let far = at(c, r + 1) * (1.0 - u) + at(c + 1, r + 1) * u;
        near * (1.0 - v) + far * v
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_frames::{DVec3, TargetState};

    #[test]
    fn a_slope_is_reproduced_and_holes_take_the_targets_height() {
        let state = |x: f64| TargetState { feet_in_world: DVec3::new(x, 0.0, 7.0), heading_rad: 0.0, speed_mps: 1.0 };
        let track = TargetTrack {
            dt_s: 0.5,
            height_m: 1.7,
            radius_m: 0.3,
            states: (0..50).map(|i| state(f64::from(i))).collect(),
        };
        let slope = GroundGrid::sample(&track, &|x, y| 0.1 * x - 0.2 * y, 45.0);
        assert!((slope.z_m(12.3, -31.0) - (1.23 + 6.2)).abs() < 1e-4);
        let holes = GroundGrid::sample(&track, &|_, _| f64::NAN, 45.0);
        assert_eq!(holes.z_m(500.0, 0.0), 7.0);
    }
}
