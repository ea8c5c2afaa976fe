//! Leaves of trees and bushes: clumps of light and dark over round crowns.
//!
//! Boxes of crowns are small on the screen: all of a picture are shaded together, each four with the numbers of its crown.

use super::lanes::{
    Block, EMPTY_ROW, FOUR, Shared, Stage, StageRow, WIDE, get, groups, set, three_of, write_row, write_three,
};
use super::pattern::{NoiseTexture, Noises, draw, most, smoothstep, unit};
use super::surface::{Look, SurfacePoint};
use super::vector::Vec3;
use crate::parts::SceneBox;
use cosfly_frames::simd_kernel;
use cosfly_maps::ObstacleKind;

/// Leaves by species, linear RGB: plane, lime, maple, oak, ash, willow, cherry, olive, birch, and copper beech.
const SPECIES: [[f32; 3]; 10] = [
    [0.085, 0.135, 0.036],
    [0.095, 0.160, 0.042],
    [0.070, 0.125, 0.030],
    [0.062, 0.100, 0.030],
    [0.080, 0.120, 0.045],
    [0.130, 0.165, 0.060],
    [0.075, 0.110, 0.034],
    [0.105, 0.120, 0.070],
    [0.125, 0.150, 0.040],
    [0.075, 0.045, 0.040],
];

/// A crown.
#[derive(Clone, Copy, Debug)]
pub struct Leaves {
    /// Middle and half size of the whole crown, metres; one divided by that size.
    middle: Vec3,
    half: Vec3,
    shrink: Vec3,
    tint: Vec3,
    /// Where its patterns begin.
    shift: f32,
}

impl Leaves {
    /// The crown that a box belongs to, if there are leaves in it.
    pub fn of(b: &SceneBox) -> Option<Self> {
        if !matches!(b.kind, ObstacleKind::TreeCrown | ObstacleKind::Bush) {
            return None;
        }
        let [middle, half] = b.whole.map(|v| Vec3::new(v.x, v.y, v.z));
        let (seed, common) = (b.seed, SPECIES.len() - 1);
        // The last species is rare.
        let species = if draw(seed, 8) < 0.03 { common } else { (draw(seed, 7) * common as f32) as usize % common };
        let [red, green, blue] = SPECIES[species];
        let tint = Vec3::new(red, green, blue) * (0.8 + 0.45 * draw(seed, 1));
        Some(Self { middle, half, shrink: half.map(|half| 1.0 / half.max(0.1)), tint, shift: 37.0 * unit(seed) })
    }
}

/// Crowns on the stage, one for each four.
pub struct Crowns {
    middle: [StageRow; 3],
    half: [StageRow; 3],
    shrink: [StageRow; 3],
    tint: [StageRow; 3],
    shift: StageRow,
}

impl Crowns {
    /// Nothing in particular.
    pub const EMPTY: Self = Self {
        middle: [EMPTY_ROW; 3],
        half: [EMPTY_ROW; 3],
        shrink: [EMPTY_ROW; 3],
        tint: [EMPTY_ROW; 3],
        shift: EMPTY_ROW,
    };
}

simd_kernel! {
    /// Puts a crown on the stage from a four on, sixteen fours at a time: what is too much, the next one writes over.
    pub fn put_crown(crowns: &mut Crowns, first: usize, fours: usize, look: &Leaves) {
        for done in (0..fours).step_by(WIDE) {
            let at = first.wrapping_add(done);
            write_three(&mut crowns.middle, at, look.middle);
            write_three(&mut crowns.half, at, look.half);
            write_three(&mut crowns.shrink, at, look.shrink);
            write_three(&mut crowns.tint, at, look.tint);
            write_row(&mut crowns.shift, at, look.shift);
        }
    }
}

simd_kernel! {
    /// Moves places on a crown's boxes to the round crown around them, along the view, and turns normals its way:
    /// light and leaves then know nothing of boxes. Where the view passes the round crown, its nearest place counts.
    pub fn swell(blocks: &mut [Block], crowns: &Crowns, eye: Vec3) {
        for (group, four) in blocks.as_chunks_mut::<FOUR>().0.iter_mut().enumerate() {
            for block in four {
                for k in 0..WIDE {
                    let (middle, half) = (three_of(&crowns.middle, group, k), three_of(&crowns.half, group, k));
                    let shrink = three_of(&crowns.shrink, group, k);
                    let from = (eye - middle) * shrink;
                    let along = (get(&block.world, k) - eye) * shrink;
                    let (a, b, c) = (along.dot(along), along.dot(from), from.dot(from) - 1.25);
                    let reach = most(b * b - a * c, 0.0).sqrt();
                    let out = from + along * ((-b - reach) / a);
                    set(&mut block.world, k, middle + out * half);
                    set(&mut block.normal, k, (out * shrink).unit());
                }
            }
        }
    }
}

simd_kernel! {
    /// The look of leaves.
    pub fn leaves(shared: &[Shared], blocks: &mut [Block], crowns: &Crowns, noise: &NoiseTexture) {
        for (group, (shared, four)) in groups(shared, blocks).enumerate() {
            let shift = Stage::lane(&crowns.shift, group);
            for block in four {
                for (k, shift) in shift.iter().enumerate() {
                    let point = block.point(shared, k);
                    let look = look(&point, three_of(&crowns.tint, group, k), *shift, noise);
                    block.put_bent(k, &look);
                }
            }
        }
    }
}

simd_kernel! {
    /// Crowns in the simple look: of one colour each, darker below.
    pub fn even_leaves(blocks: &mut [Block], crowns: &Crowns) {
        for (group, four) in blocks.as_chunks_mut::<FOUR>().0.iter_mut().enumerate() {
            for block in four {
                for k in 0..WIDE {
                    let normal = get(&block.normal, k);
                    set(&mut block.albedo, k, three_of(&crowns.tint, group, k) * 1.2);
                    set(&mut block.bent, k, normal);
                    block.openness[k] = 0.75 + 0.25 * normal.z;
                    block.sunlight[k] = 1.0;
                }
            }
        }
    }
}

#[inline(always)]
fn look(point: &SurfacePoint, crown_tint: Vec3, shift: f32, noise: &NoiseTexture) -> Look {
    let out = point.normal;
    let size = point.footprint_m;
    let p = point.world * 30.0;
    // Each pattern lies on the plane of two axes that the surface faces most. They change planes in different places.
    let clumps = |weights: [f32; 3], offset: f32| {
        let (u, v) = faced(p, out, weights);
        noise.clumps(u + offset, v - offset, size * 30.0) - 0.5
    };
    let big = clumps([1.0, 1.0, 1.0], shift);
    let aside = clumps([1.2, 0.9, 0.95], shift + 91.0);
    let upward = clumps([0.9, 1.2, 1.05], shift + 173.0);
    let (u, v) = faced(p, out, [1.0, 1.1, 0.85]);
    let small = noise.grain(u * 0.55, v * 0.55, size * 16.5) - 0.5;
    // Every clump of leaves faces its own way.
    let bent = out + Vec3::new(aside - upward, aside + upward - big, upward + 0.5 * big) * 1.7;
    let deep = smoothstep(-0.24, 0.22, big + 0.8 * small);
    // Light shines through leaves at the rim of a clump: they are yellower there.
    let tint = crown_tint.lerp(crown_tint * 0.6 + Vec3::new(0.11, 0.115, 0.02), 0.5 * (small + 0.5) * deep);
    // Darker below, where the crown shades itself.
    let shade = 0.5 + 0.5 * smoothstep(-1.0, 0.6, out.z);
    Look { openness: (0.55 + 0.55 * deep) * shade, ..Look::matt(tint * (0.50 + 0.95 * deep), bent.unit()) }
}

/// Coordinates of a point on the plane of two axes that a direction faces most, by weights of the axes.
#[inline(always)]
fn faced(p: Vec3, direction: Vec3, weights: [f32; 3]) -> (f32, f32) {
    let (x, y, z) = (direction.x.abs() * weights[0], direction.y.abs() * weights[1], direction.z.abs() * weights[2]);
    let is_x = (x > y) & (x > z);
    let is_y = (y > z) & !is_x;
    (if is_x { p.y } else { p.x }, if is_x | is_y { p.z } else { p.y })
}
