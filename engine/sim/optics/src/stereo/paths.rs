//! Costs of disparities along five paths, row by row: from the left, the right, above, and both diagonals from above.

use super::census::PAIRS;
use cosfly_frames::simd_kernel;

/// Added for a disparity that differs by one from its neighbour's, and by more.
const PENALTIES: [u8; 2] = [10, 120];
/// More than every cost of a path.
const NEVER: u8 = u8::MAX;
/// Disparities that are computed together; their number is a multiple of it.
pub(super) const BLOCK: usize = 32;

/// Costs of one path at the pixels of a row: of each pixel all disparities, between two that never are.
struct Path {
    costs: Vec<u8>,
    least: Vec<u8>,
}

/// Costs of the disparities of a row of pixels.
pub(super) struct Paths {
    disparities: usize,
    /// Paths from above left, above, and above right; whole rows.
    above: [Path; 3],
    /// Paths from the right and from the left, at one pixel.
    aside: [Path; 2],
    before: Vec<u8>,
    /// Differences of the codes, of each pixel all disparities.
    own: Vec<u8>,
    /// Sums over all paths, of each pixel all disparities.
    pub(super) sums: Vec<u16>,
}

impl Path {
    fn new(pixels: usize, disparities: usize) -> Self {
        Self { costs: vec![NEVER; pixels * (disparities + 2)], least: vec![0; pixels] }
    }

    /// A path that begins.
    fn begin(&mut self, disparities: usize) {
        self.least.fill(0);
        self.costs.chunks_mut(disparities + 2).for_each(|costs| costs[1..=disparities].fill(0));
    }
}

impl Paths {
    pub(super) fn new(width: usize, disparities: usize) -> Self {
        Self {
            disparities,
            above: [(); 3].map(|()| Path::new(width, disparities)),
            aside: [(); 2].map(|()| Path::new(1, disparities)),
            before: vec![NEVER; disparities + 2],
            own: vec![0; width * disparities],
            sums: vec![0; width * disparities],
        }
    }

    /// Begins with a picture.
    pub(super) fn begin(&mut self) {
        let disparities = self.disparities;
        self.above.iter_mut().for_each(|path| path.begin(disparities));
    }
}

simd_kernel! {
    /// Adds up the costs of a row between the codes of one picture and those of the other one, the latter from right to left.
    pub(super) fn add_row(paths: &mut Paths, codes: &[u32], others: &[u32]) {
        let Paths { disparities, above: [above_left, above, above_right], aside: [right, left], before, own, sums } = paths;
        let (disparities, width) = (*disparities, codes.len());
        right.begin(disparities);
        left.begin(disparities);
        // Each way leaves the diagonal's last pixel as the row above had it until it was used.
        for at in (0..width).rev() {
            let pixel = at * disparities..(at + 1) * disparities;
            let (own, sums) = (&mut own[pixel.clone()], &mut sums[pixel]);
            difference(codes[at], &others[width - 1 - at..], own);
            sums.fill(0);
            step(right, [0, 0], before, own, sums);
            step(above_left, [at.saturating_sub(1), at], before, own, sums);
        }
        for at in 0..width {
            let pixel = at * disparities..(at + 1) * disparities;
            let (own, sums) = (&own[pixel.clone()], &mut sums[pixel]);
            step(left, [0, 0], before, own, sums);
            step(above, [at, at], before, own, sums);
            step(above_right, [(at + 1).min(width - 1), at], before, own, sums);
        }
    }
}

/// Differences between a code and those of the other picture's pixels, from its own column to the left.
#[inline(always)]
fn difference(code: u32, others: &[u32], own: &mut [u8]) {
    let inside = own.len().min(others.len());
    let (blocks, rest) = own[..inside].as_chunks_mut::<BLOCK>();
    let (other_blocks, other_rest) = others[..inside].as_chunks::<BLOCK>();
    for (own, others) in blocks.iter_mut().zip(other_blocks) {
        *own = core::array::from_fn(|at| (code ^ others[at]).count_ones() as u8);
    }
    for (own, other) in rest.iter_mut().zip(other_rest) {
        *own = (code ^ other).count_ones() as u8;
    }
    own[inside..].fill(PAIRS);
}

/// Goes on with a path from one pixel to another, and adds its costs to the sums.
#[inline(always)]
fn step(path: &mut Path, [from, to]: [usize; 2], before: &mut [u8], own: &[u8], sums: &mut [u16]) {
    let (count, stride) = (own.len(), own.len() + 2);
    before.copy_from_slice(&path.costs[from * stride..(from + 1) * stride]);
    let [near, far] = PENALTIES;
    let least_before = path.least[from];
    let jump = least_before.saturating_add(far);
    let (costs, _) = path.costs[to * stride + 1..][..count].as_chunks_mut::<BLOCK>();
    let [below, same, over] = [0, 1, 2].map(|first| before[first..first + count].as_chunks::<BLOCK>().0);
    let mut least = [NEVER; BLOCK];
    let blocks = costs.iter_mut().zip(own.as_chunks::<BLOCK>().0).zip(sums.as_chunks_mut::<BLOCK>().0);
    for (((costs, own), sums), ((below, same), over)) in blocks.zip(below.iter().zip(same).zip(over)) {
        // A path costs at most the largest difference and a jump more than its least: nothing wraps.
        let block: [u8; BLOCK] = core::array::from_fn(|at| {
            let next = below[at].min(over[at]).saturating_add(near);
            own[at].wrapping_add(same[at].min(next).min(jump).wrapping_sub(least_before))
        });
        *sums = core::array::from_fn(|at| sums[at].wrapping_add(u16::from(block[at])));
        least = core::array::from_fn(|at| least[at].min(block[at]));
        *costs = block;
    }
    path.least[to] = least.into_iter().fold(NEVER, u8::min);
}
