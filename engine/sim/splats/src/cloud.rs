//! [`SplatCloud`]: all splats of a file in blocks of lanes.

use crate::block::{Block, WIDE};
use crate::splat::Splat;

/// Least opacity that is drawn, as in the reference: one step of eight bits.
pub const LEAST_ALPHA: f32 = 1.0 / 255.0;

/// Splats in the frame of their file.
#[derive(Clone, Debug)]
pub struct SplatCloud {
    blocks: Vec<Block>,
    /// Coefficients of all colours, block by block: by harmonic, then by channel.
    harmonics: Vec<[f32; WIDE]>,
    coefficients: usize,
    count: usize,
    left_out: usize,
    low: [f32; 3],
    high: [f32; 3],
    origin: [f64; 3],
}

impl SplatCloud {
    /// A cloud without splats whose colours have spherical harmonics to a degree, 0 to 3.
    pub fn new(degree: usize) -> Self {
        let side = degree.min(3) + 1;
        Self {
            blocks: Vec::new(),
            harmonics: Vec::new(),
            coefficients: side * side,
            count: 0,
            left_out: 0,
            low: [f32::INFINITY; 3],
            high: [f32::NEG_INFINITY; 3],
            origin: [0.0; 3],
        }
    }

    /// This cloud, whose splats count from a place of the file.
    #[must_use]
    pub fn with_origin(mut self, origin: [f64; 3]) -> Self {
        self.origin = origin;
        self
    }

    /// Place of the file from which splats count.
    pub fn origin(&self) -> [f64; 3] {
        self.origin
    }

    /// Adds a splat. One that is not finite or that nobody sees is counted and left out.
    pub fn push(&mut self, splat: &Splat) {
        let covariance = splat.covariance().map(|entry| entry as f32);
        let colours = splat.harmonics[..self.coefficients].iter().flatten();
        let is_finite = splat.middle.iter().chain(&covariance).chain(colours).all(|value| value.is_finite());
        let is_seen = splat.opacity > LEAST_ALPHA && splat.opacity <= 1.0;
        if !(is_finite && is_seen) {
            self.left_out += 1;
            return;
        }
        let lane = self.count % WIDE;
        if lane == 0 {
            self.blocks.push(Block::EMPTY);
            self.harmonics.resize(self.harmonics.len() + 3 * self.coefficients, [0.0; WIDE]);
        }
        let (blocks, width) = (self.blocks.len(), 3 * self.coefficients);
        let block = &mut self.blocks[blocks - 1];
        for axis in 0..3 {
            block.middle[axis][lane] = splat.middle[axis];
            self.low[axis] = self.low[axis].min(splat.middle[axis]);
            self.high[axis] = self.high[axis].max(splat.middle[axis]);
        }
        block.covariance.iter_mut().zip(covariance).for_each(|(lanes, entry)| lanes[lane] = entry);
        block.opacity[lane] = splat.opacity;
        let own = &mut self.harmonics[(blocks - 1) * width..];
        own.iter_mut().zip(splat.harmonics.iter().flatten()).for_each(|(lanes, value)| lanes[lane] = *value);
        self.count += 1;
    }

    /// Number of splats.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether there is no splat.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Splats that were left out: not finite, or fainter than one step of eight bits.
    pub fn left_out(&self) -> usize {
        self.left_out
    }

    /// Lowest and highest middle, frame of the file.
    pub fn bounds(&self) -> [[f32; 3]; 2] {
        [self.low, self.high]
    }

    /// Harmonics of each colour: 1, 4, 9 or 16.
    pub(crate) fn coefficients(&self) -> usize {
        self.coefficients
    }

    /// All blocks.
    pub(crate) fn blocks(&self) -> &[Block] {
        &self.blocks
    }

    /// Coefficients of the colours of all blocks, `3 * coefficients` lanes each.
    pub(crate) fn harmonics(&self) -> &[[f32; WIDE]] {
        &self.harmonics
    }
}
