//! A band of the picture, as high as a tile: its footprints in order, tile by tile.

use crate::footprint::Footprint;
use crate::order::by_depth;
use crate::tile::{SIDE, Tile, blend, place};
use cosfly_frames::simd::Level;

/// Pixels of a band, and the depth beyond which nothing is blended into them.
pub struct Band<'a> {
    /// Number of the band.
    pub number: usize,
    /// Pixels of a row.
    pub width: usize,
    /// Colours, row by row.
    pub colour: &'a mut [[f32; 3]],
    /// Share of the light behind that comes through.
    pub transmittance: &'a mut [f32],
    /// Depth at which half of the light is gone, metres.
    pub depth_m: &'a mut [f32],
    /// Limits of depth, metres; without them there are none.
    pub limit_m: Option<&'a [f32]>,
}

/// Buffers of one thread.
#[derive(Default)]
pub struct Scratch {
    footprints: Vec<Footprint>,
    pairs: Vec<(u32, u32)>,
    spare: Vec<(u32, u32)>,
    /// Footprints of each tile, from near to far.
    tiles: Vec<Vec<u32>>,
}

impl Scratch {
    /// Draws a band of these footprints, group by group in the order of the cloud.
    pub fn draw<'f>(&mut self, level: Level, groups: impl Iterator<Item = &'f [Footprint]>, mut band: Band<'_>) {
        self.footprints.clear();
        groups.for_each(|group| self.footprints.extend_from_slice(group));
        self.pairs.clear();
        self.pairs.extend(self.footprints.iter().map(|footprint| footprint.depth_m.to_bits()).zip(0..));
        by_depth(&mut self.pairs, &mut self.spare);
        self.tiles.resize(self.tiles.len().max(band.width.div_ceil(SIDE)), Vec::new());
        self.tiles.iter_mut().for_each(Vec::clear);
        for (_, number) in &self.pairs {
            let footprint = &self.footprints[*number as usize];
            let [first, last] = [footprint.first[0], footprint.last[0]].map(|column| usize::from(column) / SIDE);
            self.tiles[first..=last].iter_mut().for_each(|tile| tile.push(*number));
        }
        for (number, order) in self.tiles[..band.width.div_ceil(SIDE)].iter().enumerate() {
            let mut tile = Tile::CLEAR;
            let column = SIDE * number;
            band.read_limits(column, &mut tile);
            blend(level, &self.footprints, order, [column, SIDE * band.number], &mut tile);
            band.write(column, &tile);
        }
    }
}

impl Band<'_> {
    fn read_limits(&self, column: usize, tile: &mut Tile) {
        let Some(limit_m) = self.limit_m else { return };
        for (row, limits) in limit_m.chunks_exact(self.width).enumerate() {
            for (k, limit) in limits[column..].iter().take(SIDE).enumerate() {
                let [block, lane] = place(row, k);
                tile.limit_m[block][lane] = *limit;
            }
        }
    }

    fn write(&mut self, column: usize, tile: &Tile) {
        let rows = self.transmittance.len() / self.width;
        let columns = SIDE.min(self.width - column);
        for row in 0..rows {
            for k in 0..columns {
                let at = row * self.width + column + k;
                let [block, lane] = place(row, k);
                let light = tile.transmittance[block][lane];
                self.colour[at] = [0, 1, 2].map(|channel| tile.colour[channel][block][lane]);
                self.transmittance[at] = light;
                self.depth_m[at] = if light < 0.5 { tile.depth_m[block][lane] } else { f32::INFINITY };
            }
        }
    }
}
