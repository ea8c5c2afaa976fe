//! Pixels on their way through the shading kernels: sixteen fours of neighbours, one array per quantity.
//!
//! Values that change slowly over a surface (light, haze, pixel sizes) are worked out once for the four pixels of a [`Shared`]
//! lane; textures and shadow edges for each pixel of the four [`Block`]s beside it.

use super::surface::{Look, SurfacePoint};
use super::vector::Vec3;

/// Fours that go through a kernel side by side.
pub const WIDE: usize = 16;
/// Neighbouring pixels of a row that share what changes slowly.
pub const FOUR: usize = 4;
/// Sixteen fours that go through the kernels together.
pub const GROUPS: usize = 4;
/// Fours that go through the kernels together.
pub const FOURS: usize = WIDE * GROUPS;
/// Pixels that go through the kernels together.
pub const LANES: usize = FOUR * FOURS;

/// One quantity of sixteen pixels or fours.
pub type PixelLane = [f32; WIDE];
/// A point, direction or colour of sixteen pixels or fours.
pub type Lane3 = [PixelLane; 3];
/// One quantity of fours on their way. Room beyond the last lets sixteen be written at a time.
pub type StageRow = [f32; FOURS + WIDE];

/// A row of nothing in particular.
pub const EMPTY_ROW: StageRow = [0.0; FOURS + WIDE];

/// Fours on their way into blocks.
pub struct PendingFours {
    /// Centre of the first pixel, from the left, pixels.
    pub u: StageRow,
    /// From the top.
    pub v: StageRow,
    /// Inverse planar depth there, 1/m.
    pub inverse: StageRow,
    /// Change per pixel to the right.
    pub across: StageRow,
    /// Change per pixel downwards.
    pub down: StageRow,
    /// Unit normal of the face, any side.
    pub normal: [StageRow; 3],
    /// The face's own horizontal, unit vectors.
    pub along: [StageRow; 3],
    /// The other direction along it, unit vectors.
    pub up: [StageRow; 3],
}

impl PendingFours {
    /// Nothing in particular.
    pub const EMPTY: Self = Self {
        u: [0.0; FOURS + WIDE],
        v: [0.0; FOURS + WIDE],
        inverse: [1.0; FOURS + WIDE],
        across: [0.0; FOURS + WIDE],
        down: [0.0; FOURS + WIDE],
        normal: [EMPTY_ROW; 3],
        along: [EMPTY_ROW; 3],
        up: [EMPTY_ROW; 3],
    };

    /// Sixteen fours of a row.
    #[inline(always)]
    pub fn lane(row: &StageRow, group: usize) -> &PixelLane {
        &row.as_chunks().0[group]
    }
}

/// Three numbers of four `k` of a group.
#[inline(always)]
pub fn three_of(rows: &[StageRow; 3], group: usize, k: usize) -> Vec3 {
    let [x, y, z] = rows;
    Vec3::new(PendingFours::lane(x, group)[k], PendingFours::lane(y, group)[k], PendingFours::lane(z, group)[k])
}

/// Writes a number for sixteen fours.
#[inline(always)]
pub fn write_row(row: &mut StageRow, at: usize, value: f32) {
    if let Some(sixteen) = row.get_mut(at..).and_then(|rest| rest.first_chunk_mut::<WIDE>()) {
        *sixteen = [value; WIDE];
    }
}

/// Writes three numbers for sixteen fours.
#[inline(always)]
pub fn write_three(rows: &mut [StageRow; 3], at: usize, value: Vec3) {
    let [x, y, z] = rows;
    write_row(x, at, value.x);
    write_row(y, at, value.y);
    write_row(z, at, value.z);
}

/// Values that the pixels of sixteen fours share. Lanes that no pixel fills hold whatever they held.
#[repr(align(64))]
#[derive(Clone, Debug)]
pub struct Shared {
    /// Unit normal of the face, towards the camera.
    pub normal: Lane3,
    /// Direction from the camera to the middle, 1 along the optical axis.
    pub ray: Lane3,
    /// The middle, metres.
    pub middle: Lane3,
    /// Size of a pixel along the face's own horizontal, metres.
    pub along_m: PixelLane,
    /// Size of a pixel along the face's own vertical, metres.
    pub up_m: PixelLane,
    /// Size of a pixel averaged over directions, metres.
    pub footprint_m: PixelLane,
    /// Share of the sky that the place sees.
    pub sky: PixelLane,
    /// Light of street lamps; 0 by day.
    pub lamps: PixelLane,
    /// Share of light that haze lets through, exposed.
    pub kept: PixelLane,
    /// Light that haze adds, exposed.
    pub fog: Lane3,
    /// Light on the surface where the sun reaches it.
    pub sunny: Lane3,
    /// All other light on it.
    pub soft: Lane3,
    /// Light in a mirror there.
    pub mirrored: Lane3,
    /// Strength of the sun's image in it.
    pub glint: PixelLane,
    /// Share of mirrored light, for surfaces that mirror.
    pub fresnel: PixelLane,
}

impl Shared {
    /// All zero.
    pub const EMPTY: Self = Self {
        normal: [[0.0; WIDE]; 3],
        ray: [[0.0; WIDE]; 3],
        middle: [[0.0; WIDE]; 3],
        along_m: [0.0; WIDE],
        up_m: [0.0; WIDE],
        footprint_m: [0.0; WIDE],
        sky: [0.0; WIDE],
        lamps: [0.0; WIDE],
        kept: [0.0; WIDE],
        fog: [[0.0; WIDE]; 3],
        sunny: [[0.0; WIDE]; 3],
        soft: [[0.0; WIDE]; 3],
        mirrored: [[0.0; WIDE]; 3],
        glint: [0.0; WIDE],
        fresnel: [0.0; WIDE],
    };

    /// The middle of four `k` as materials are told about it.
    #[inline(always)]
    pub fn point(&self, k: usize) -> SurfacePoint {
        SurfacePoint {
            world: get(&self.middle, k),
            normal: get(&self.normal, k),
            footprint_m: self.footprint_m[k],
            footprints_m: [self.along_m[k], self.up_m[k]],
        }
    }
}

/// Sixteen pixels of one material, one of each four.
#[repr(align(64))]
#[derive(Clone, Debug)]
pub struct Block {
    /// Unit normal of the surface, towards the camera.
    pub normal: Lane3,
    /// The point, metres.
    pub world: Lane3,
    /// Share of the sun's light that no shadow takes.
    pub sunlight: PixelLane,
    /// Looks of the material.
    pub albedo: Lane3,
    /// Light of its own.
    pub emission: Lane3,
    /// Normal for shading, of materials that are not flat.
    pub bent: Lane3,
    /// Share of a mirror.
    pub mirror: PixelLane,
    /// Share of the surroundings' openness that the surface keeps, where it is not flat.
    pub openness: PixelLane,
    /// sRGB bytes: red in the lowest byte, then green and blue.
    pub bytes: [u32; WIDE],
}

impl Block {
    /// All zero.
    pub const EMPTY: Self = Self {
        normal: [[0.0; WIDE]; 3],
        world: [[0.0; WIDE]; 3],
        sunlight: [0.0; WIDE],
        albedo: [[0.0; WIDE]; 3],
        emission: [[0.0; WIDE]; 3],
        bent: [[0.0; WIDE]; 3],
        mirror: [0.0; WIDE],
        openness: [0.0; WIDE],
        bytes: [0; WIDE],
    };

    /// Input of a material at pixel `k`.
    #[inline(always)]
    pub fn point(&self, shared: &Shared, k: usize) -> SurfacePoint {
        SurfacePoint {
            world: get(&self.world, k),
            normal: get(&self.normal, k),
            footprint_m: shared.footprint_m[k],
            footprints_m: [shared.along_m[k], shared.up_m[k]],
        }
    }

    /// Output of a flat material at pixel `k`.
    #[inline(always)]
    pub fn look(&self, k: usize) -> Look {
        Look {
            emission: get(&self.emission, k),
            mirror: self.mirror[k],
            ..Look::matt(get(&self.albedo, k), get(&self.normal, k))
        }
    }

    /// Stores what a flat material answers.
    #[inline(always)]
    pub fn put(&mut self, k: usize, look: &Look) {
        set(&mut self.albedo, k, look.albedo);
        set(&mut self.emission, k, look.emission);
        self.mirror[k] = look.mirror;
    }

    /// Stores what a material with a normal and depths of its own answers.
    #[inline(always)]
    pub fn put_bent(&mut self, k: usize, look: &Look) {
        set(&mut self.albedo, k, look.albedo);
        set(&mut self.bent, k, look.normal);
        self.openness[k] = look.openness;
    }
}

/// Every sixteen fours with their pixels.
#[inline(always)]
pub fn groups<'a>(
    shared: &'a [Shared],
    blocks: &'a mut [Block],
) -> impl Iterator<Item = (&'a Shared, &'a mut [Block; FOUR])> {
    shared.iter().zip(blocks.as_chunks_mut::<FOUR>().0)
}

/// Pixel `k` of a triple.
#[inline(always)]
pub fn get(lane: &Lane3, k: usize) -> Vec3 {
    Vec3::new(lane[0][k], lane[1][k], lane[2][k])
}

/// Sets pixel `k` of a triple.
#[inline(always)]
pub fn set(lane: &mut Lane3, k: usize, value: Vec3) {
    lane[0][k] = value.x;
    lane[1][k] = value.y;
    lane[2][k] = value.z;
}
