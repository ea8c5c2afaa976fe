//! Speckles: islands of few pixels whose disparities differ from all around them.

/// Islands of fewer pixels are dropped.
const LEAST_PIXELS: usize = 60;

/// Buffers for islands.
#[derive(Default)]
pub(super) struct Speckles {
    seen: Vec<bool>,
    island: Vec<u32>,
}

impl Speckles {
    /// Sets disparities of small islands to 0. Neighbours whose disparities differ by at most `step` are of one island.
    pub(super) fn drop_from(&mut self, found: &mut [u16], width: usize, step: u16) {
        let Self { seen, island } = self;
        seen.clear();
        seen.extend(found.iter().map(|disparity| *disparity == 0));
        for first in 0..found.len() {
            if seen[first] {
                continue;
            }
            seen[first] = true;
            island.clear();
            island.push(first as u32);
            let mut next = 0;
            while let Some(at) = island.get(next).map(|at| *at as usize) {
                next += 1;
                let column = at % width;
                let left = (column > 0).then(|| at - 1);
                let right = (column + 1 < width).then_some(at + 1);
                for beside in [left, right, at.checked_sub(width), Some(at + width)].into_iter().flatten() {
                    if beside < found.len() && !seen[beside] && found[beside].abs_diff(found[at]) <= step {
                        seen[beside] = true;
                        island.push(beside as u32);
                    }
                }
            }
            if island.len() < LEAST_PIXELS {
                island.iter().for_each(|at| found[*at as usize] = 0);
            }
        }
    }
}
