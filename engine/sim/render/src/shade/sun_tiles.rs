//! Tiles of a town's shadow map, kept for all cameras of the town under the suns of late.

use super::sunlight::{LOWEST_M, MOST_STEPS, SUMMARY_SIDE, Texels};
use cosfly_frames::{DVec2, DVec3};
use cosfly_materials::vector::Vec3;
use cosfly_raster::shadow_frame::ShadowFrame;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Size of the finest texels across the sun's direction, metres; those of each coarser size are twice as large.
pub(super) const TEXEL_M: f64 = 0.1;
/// Tiles that all suns of a town keep: 64 MB at most.
const MOST_TILES: usize = 1024;

/// A sun over a town: everything that its tiles depend on beside the town and their places.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sun {
    pub(super) to_sun: DVec3,
    reference_m: f64,
    /// Steps of heights in a metre.
    pub(super) steps_per_m: f32,
}

impl Sun {
    /// The sun in a direction, over a town whose lowest and highest places are at these heights.
    pub(super) fn new(to_sun: Vec3, [lowest_m, highest_m]: [f64; 2]) -> Self {
        let to_sun = DVec3::new(f64::from(to_sun.x), f64::from(to_sun.y), f64::from(to_sun.z));
        let lowest_m = if lowest_m.is_finite() { lowest_m } else { 0.0 };
        let reference_m = (lowest_m / 8.0).floor() * 8.0;
        let is_high = (highest_m - reference_m + LOWEST_M) * 16.0 > f64::from(MOST_STEPS);
        Self { to_sun, reference_m, steps_per_m: if is_high { 8.0 } else { 16.0 } }
    }

    /// The lattice of the texels of a size.
    pub(super) fn lattice(&self, grain: usize) -> ShadowFrame {
        let flat = self.to_sun.truncate();
        let shear = flat / self.to_sun.z;
        let along = if flat.length() > 1e-6 { flat.normalize() } else { DVec2::Y };
        // Coarse texels are long where shadows are; the finest are square.
        let stretch = if grain == 0 { 1.0 } else { shear.length().clamp(1.0, 3.0) };
        ShadowFrame {
            corner: DVec2::ZERO,
            reference_m: self.reference_m,
            shear,
            axes: [DVec2::new(-along.y, along.x), along],
            texels_m: TEXEL_M * f64::from(1u32 << grain) * DVec2::new(1.0, stretch),
        }
    }

    fn key(&self) -> [u64; 4] {
        [self.to_sun.x, self.to_sun.y, self.to_sun.z, self.reference_m].map(f64::to_bits)
    }
}

/// Size of texels, row and column of a tile in their lattice.
pub(super) type TilePlace = (usize, i32, i32);

/// A drawn tile.
#[derive(Clone)]
pub(super) struct Tile {
    /// Texels as kernels read them: all renderers of a town read the same ones.
    pub(super) texels: Arc<Texels>,
    /// Their summary, see [`super::sunlight::measure_tile`].
    pub(super) summary: Arc<[u32; SUMMARY_SIDE * SUMMARY_SIDE]>,
}

/// Tiles under one sun; `None` where nothing stands.
type Tiles = BTreeMap<TilePlace, Option<Tile>>;

/// Tiles of a town under the suns of late, the latest sun last.
#[derive(Default)]
pub(crate) struct SunMaps {
    suns: Mutex<Vec<([u64; 4], Tiles)>>,
}

impl SunMaps {
    /// Hands kept tiles of a sun to `take`, and leaves those places that are not kept.
    pub(super) fn take_kept(
        &self,
        sun: &Sun,
        wanted: &mut Vec<TilePlace>,
        mut take: impl FnMut(TilePlace, Option<&Tile>),
    ) {
        let mut suns = self.suns.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(at) = suns.iter().position(|(key, _)| *key == sun.key()) else { return };
        let count = suns.len();
        suns[at..count].rotate_left(1);
        let tiles = &suns[count - 1].1;
        wanted.retain(|place| match tiles.get(place) {
            Some(tile) => {
                take(*place, tile.as_ref());
                false
            }
            None => true,
        });
    }

    /// Keeps a tile; where there are too many, those of the sun longest out of use go, or a quarter of the only sun's.
    pub(super) fn keep(&self, sun: &Sun, place: TilePlace, tile: Option<Tile>) {
        let mut suns = self.suns.lock().unwrap_or_else(PoisonError::into_inner);
        let held = |tiles: &Tiles| tiles.values().filter(|tile| tile.is_some()).count();
        if tile.is_some() && suns.iter().map(|(_, tiles)| held(tiles)).sum::<usize>() >= MOST_TILES {
            match suns.as_mut_slice() {
                // Cameras that take turns all over a town would find none of their tiles if all, or the oldest, went.
                [(_, tiles)] => {
                    let mut number = 0;
                    tiles.retain(|_, _| {
                        number += 1;
                        number % 4 != 0
                    });
                }
                _ => _ = suns.remove(0),
            }
        }
        let at = match suns.iter().position(|(key, _)| *key == sun.key()) {
            Some(at) => at,
            None => {
                suns.push((sun.key(), Tiles::new()));
                suns.len() - 1
            }
        };
        suns[at].1.insert(place, tile);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finest_texels_are_a_tenth_of_a_metre_whatever_the_sun() {
        for height in [0.2f32, 0.7, 1.0] {
            let sun = Sun::new(Vec3::new(0.6, -0.5, height).unit(), [-3.0, 300.0]);
            assert!(sun.lattice(0).texels_m.max_element() <= 0.1 && sun.reference_m == -8.0);
            assert!(sun.lattice(1).texels_m.x == 0.2);
        }
    }
}
