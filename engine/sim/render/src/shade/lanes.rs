//! Pixels on their way through the shading kernels: blocks of sixteen, one array per quantity.

use super::surface::{Look, SurfacePoint};
use super::vector::Vec3;

/// Pixels of a block.
pub const WIDE: usize = 16;
/// Blocks that go through the kernels together.
pub const BLOCKS: usize = 8;
/// Pixels that go through the kernels together.
pub const LANES: usize = WIDE * BLOCKS;

/// One quantity of sixteen pixels.
pub type Lane = [f32; WIDE];
/// A point, direction or colour of sixteen pixels.
pub type Lane3 = [Lane; 3];

/// Pixels on their way into blocks. Room beyond the last lane lets sixteen be written at a time.
pub struct Stage {
    /// Pixel centre, from the left, pixels.
    pub u: [f32; LANES + WIDE],
    /// Pixel centre, from the top.
    pub v: [f32; LANES + WIDE],
    /// Planar depth, metres.
    pub depth_m: [f32; LANES + WIDE],
    /// Unit normal of the face, any side.
    pub normal: [[f32; LANES + WIDE]; 3],
}

impl Stage {
    /// All zero.
    pub const EMPTY: Self = Self {
        u: [0.0; LANES + WIDE],
        v: [0.0; LANES + WIDE],
        depth_m: [1.0; LANES + WIDE],
        normal: [[0.0; LANES + WIDE]; 3],
    };

    /// The lanes of block `b`: u, v, depth.
    #[inline(always)]
    pub fn lanes(&self, b: usize) -> (&Lane, &Lane, &Lane) {
        (&self.u.as_chunks().0[b], &self.v.as_chunks().0[b], &self.depth_m.as_chunks().0[b])
    }

    /// The normals of block `b`.
    #[inline(always)]
    pub fn normals(&self, b: usize) -> [&Lane; 3] {
        let [x, y, z] = &self.normal;
        [&x.as_chunks().0[b], &y.as_chunks().0[b], &z.as_chunks().0[b]]
    }
}

/// Sixteen pixels of one material. Lanes that no pixel fills hold whatever they held.
#[repr(align(64))]
#[derive(Clone, Debug)]
pub struct Block {
    /// Unit normal of the face, towards the camera.
    pub normal: Lane3,
    /// Direction from the camera, 1 along the optical axis.
    pub ray: Lane3,
    /// The point, metres.
    pub world: Lane3,
    /// Size of the pixel along the face's own horizontal, metres.
    pub along_m: Lane,
    /// And along its vertical.
    pub up_m: Lane,
    /// Size of the pixel averaged over directions, metres.
    pub footprint_m: Lane,
    /// Share of the sky that the place sees.
    pub sky: Lane,
    /// Light of street lamps.
    pub lamps: Lane,
    /// Share of light that haze lets through.
    pub kept: Lane,
    /// Share of the sun's light that no shadow takes.
    pub sunlight: Lane,
    /// What the material answers.
    pub albedo: Lane3,
    /// Light of its own.
    pub emission: Lane3,
    /// Normal for shading.
    pub bent: Lane3,
    /// Share of a mirror.
    pub mirror: Lane,
    /// Share of the surroundings' openness that the surface keeps.
    pub openness: Lane,
    /// Linear light to the camera.
    pub colour: Lane3,
    /// sRGB bytes: red in the lowest byte, then green and blue.
    pub bytes: [u32; WIDE],
}

impl Block {
    /// All zero.
    pub const EMPTY: Self = Self {
        normal: [[0.0; WIDE]; 3],
        ray: [[0.0; WIDE]; 3],
        world: [[0.0; WIDE]; 3],
        along_m: [0.0; WIDE],
        up_m: [0.0; WIDE],
        footprint_m: [0.0; WIDE],
        sky: [0.0; WIDE],
        lamps: [0.0; WIDE],
        kept: [0.0; WIDE],
        sunlight: [0.0; WIDE],
        albedo: [[0.0; WIDE]; 3],
        emission: [[0.0; WIDE]; 3],
        bent: [[0.0; WIDE]; 3],
        mirror: [0.0; WIDE],
        openness: [0.0; WIDE],
        colour: [[0.0; WIDE]; 3],
        bytes: [0; WIDE],
    };

    /// What a material is told about pixel `k`.
    #[inline(always)]
    pub fn point(&self, k: usize) -> SurfacePoint {
        SurfacePoint {
            world: get(&self.world, k),
            normal: get(&self.normal, k),
            footprint_m: self.footprint_m[k],
            footprints_m: [self.along_m[k], self.up_m[k]],
        }
    }

    /// What it answered about pixel `k`.
    #[inline(always)]
    pub fn look(&self, k: usize) -> Look {
        Look {
            albedo: get(&self.albedo, k),
            emission: get(&self.emission, k),
            normal: get(&self.bent, k),
            mirror: self.mirror[k],
            openness: self.openness[k],
        }
    }

    /// Stores what it answers.
    #[inline(always)]
    pub fn put(&mut self, k: usize, look: &Look) {
        set(&mut self.albedo, k, look.albedo);
        set(&mut self.emission, k, look.emission);
        set(&mut self.bent, k, look.normal);
        self.mirror[k] = look.mirror;
        self.openness[k] = look.openness;
    }
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
