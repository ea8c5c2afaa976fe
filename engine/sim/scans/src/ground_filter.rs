//! The ground of a scan without classes: the lowest surface, opened with ever wider windows.

use crate::relief::filled;

/// Half widths of the windows, metres; the last is half as wide as the widest roof that is told from ground.
const WINDOWS_M: [f64; 6] = [1.0, 2.0, 4.0, 8.0, 16.0, 32.0];
/// Steepest ground, rise over run.
const STEEPEST: f64 = 0.3;
/// A step of the surface that is no ground in the narrowest window, and in any, metres.
const STEPS_M: [f64; 2] = [0.5, 2.5];
/// Points at most this far above the ground belong to it, metres.
const ROUGHNESS_M: f64 = 0.3;

/// Distance from the ground up to which points belong to it, for cells of a side, metres.
pub fn near_ground_m(cell_m: f64) -> f64 {
    ROUGHNESS_M + STEEPEST * 0.5 * cell_m
}

/// Height from which on points of a cell may be ground: infinite where none is. `lowest` has the lowest point of each cell, not a
/// number where there is none.
pub fn least_heights(lowest: Vec<f32>, size: [usize; 2], cell_m: f64) -> Vec<f32> {
    let mut is_measured: Vec<bool> = lowest.iter().map(|height| !height.is_nan()).collect();
    let mut surface = filled(lowest, size[0], size[1]);
    // Points far below all around are echoes: a closing fills the holes that they make.
    let closed = eroded(&dilated(&surface, size, 2), size, 2);
    for (cell, height) in surface.iter_mut().enumerate() {
        if closed[cell] - *height > STEPS_M[1] as f32 {
            *height = closed[cell];
        }
    }
    let mut before_m = 0.0;
    for window_m in WINDOWS_M {
        let half = ((window_m / cell_m).round() as usize).clamp(1, size[0].max(size[1]));
        let opened = dilated(&eroded(&surface, size, half), size, half);
        let step_m = (STEPS_M[0] + STEEPEST * (window_m - before_m)).min(STEPS_M[1]) as f32;
        for cell in 0..surface.len() {
            is_measured[cell] &= surface[cell] - opened[cell] <= step_m;
        }
        surface = opened;
        before_m = window_m;
    }
    // The opened surface is a lower bound with flat steps: the cells that passed keep their own heights.
    surface
        .iter()
        .zip(&is_measured)
        .map(|(height, is_measured)| if *is_measured { height - STEPS_M[1] as f32 } else { f32::INFINITY })
        .collect()
}

/// Largest value within `half` cells along both sides.
fn dilated(values: &[f32], size: [usize; 2], half: usize) -> Vec<f32> {
    let flipped: Vec<f32> = values.iter().map(|value| -value).collect();
    eroded(&flipped, size, half).into_iter().map(|value| -value).collect()
}

/// Smallest value within `half` cells along both sides, row by row and column by column.
fn eroded(values: &[f32], [columns, rows]: [usize; 2], half: usize) -> Vec<f32> {
    let mut out = values.to_vec();
    let mut line = Vec::new();
    let mut queue = std::collections::VecDeque::new();
    for row in 0..rows {
        line.clear();
        line.extend_from_slice(&out[row * columns..][..columns]);
        sliding_least(&line, half, &mut queue, |at, least| out[row * columns + at] = least);
    }
    for column in 0..columns {
        line.clear();
        line.extend((0..rows).map(|row| out[row * columns + column]));
        sliding_least(&line, half, &mut queue, |at, least| out[at * columns + column] = least);
    }
    out
}

/// Smallest value within `half` places of each place: the queue holds rising values that can still be the smallest.
fn sliding_least(
    line: &[f32],
    half: usize,
    queue: &mut std::collections::VecDeque<usize>,
    mut set: impl FnMut(usize, f32),
) {
    queue.clear();
    for end in 0..line.len() + half {
        if end < line.len() {
            while queue.back().is_some_and(|last| line[*last] >= line[end]) {
                queue.pop_back();
            }
            queue.push_back(end);
        }
        if let Some(at) = end.checked_sub(half) {
            while queue.front().is_some_and(|first| first + half < at) {
                queue.pop_front();
            }
            if let Some(first) = queue.front() {
                set(at, line[*first]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sliding_windows_find_what_a_search_finds() {
        let values: Vec<f32> = (0..60_u32).map(|i| ((i * 7919) % 31) as f32).collect();
        for half in [1, 2, 5, 40] {
            let found = eroded(&values, [10, 6], half);
            for (cell, least) in found.iter().enumerate() {
                let near = |other: &usize| {
                    (other % 10).abs_diff(cell % 10) <= half && (other / 10).abs_diff(cell / 10) <= half
                };
                let expected = (0..60).filter(near).map(|other| values[other]).fold(f32::INFINITY, f32::min);
                assert_eq!(*least, expected, "cell {cell}, half {half}");
            }
        }
    }
}
