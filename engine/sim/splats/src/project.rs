//! Splats of a block on the screen: the affine approximation of Zwicker et al. 2001 (EWA) as in 3D Gaussian Splatting, section 4.

use crate::block::{Block, WIDE};
use crate::cloud::LEAST_ALPHA;
use crate::exponential::logarithm;
use crate::footprint::Footprint;
use crate::harmonics;
use crate::view::{MOST_ASIDE, NEAR_M, SplatView};
use cosfly_frames::simd_kernel;

/// Variance that every footprint gains, square pixels: none is smaller than a pixel.
pub const LOW_PASS_PX2: f64 = 0.3;
/// Least factor of opacities in Mip-Splatting, squared.
pub const LEAST_COMPENSATION: f64 = 0.000_025;

/// A view in single precision.
#[derive(Clone, Copy, Debug)]
pub struct Lens {
    eye: [f32; 3],
    /// Rows: right, down, ahead.
    rows: [[f32; 3]; 3],
    focal_px: f32,
    centre_px: [f32; 2],
    last: [f32; 2],
    most_aside: [f32; 2],
    is_antialiased: bool,
}

impl Lens {
    /// The numbers of a view.
    pub fn new(view: &SplatView) -> Self {
        let turn = view.camera_from_file;
        let centre = view.centre_px();
        Self {
            eye: view.eye.as_vec3().to_array(),
            rows: [turn.row(0), turn.row(1), turn.row(2)].map(|row| row.as_vec3().to_array()),
            focal_px: view.focal_px as f32,
            centre_px: centre.map(|at| at as f32),
            last: [view.width as f32 - 1.0, view.height as f32 - 1.0],
            most_aside: centre.map(|half| (MOST_ASIDE * half / view.focal_px) as f32),
            is_antialiased: view.is_antialiased,
        }
    }
}

/// Numbers of a block's footprints.
struct Lanes {
    place: [[f32; WIDE]; 2],
    profile: [[f32; WIDE]; 3],
    least_power: [f32; WIDE],
    opacity: [f32; WIDE],
    depth_m: [f32; WIDE],
    slope: [[f32; WIDE]; 2],
    first: [[f32; WIDE]; 2],
    last: [[f32; WIDE]; 2],
    direction: [[f32; WIDE]; 3],
    is_seen: [bool; WIDE],
}

const NO_LANES: Lanes = Lanes {
    place: [[0.0; WIDE]; 2],
    profile: [[0.0; WIDE]; 3],
    least_power: [0.0; WIDE],
    opacity: [0.0; WIDE],
    depth_m: [0.0; WIDE],
    slope: [[0.0; WIDE]; 2],
    first: [[0.0; WIDE]; 2],
    last: [[0.0; WIDE]; 2],
    direction: [[0.0; WIDE]; 3],
    is_seen: [false; WIDE],
};

simd_kernel! {
    /// Writes the footprints that a picture sees of some blocks one after the other, and says how many they are.
    pub fn project(blocks: &[Block], harmonics: &[[f32; WIDE]], lens: &Lens, out: &mut [Footprint]) -> usize {
        let lens = *lens;
        let mut lanes = NO_LANES;
        let mut count = 0usize;
        let width = harmonics.len() / blocks.len().max(1);
        for (block, harmonics) in blocks.iter().zip(harmonics.chunks_exact(width.max(1))) {
            measure(block, &lens, &mut lanes);
            let mut any = 0u32;
            for seen in &lanes.is_seen {
                any |= u32::from(*seen);
            }
            if any == 0 {
                continue;
            }
            let colours = colours(harmonics, &lanes.direction);
            let seen = lanes.is_seen.iter().enumerate().filter(|(_, is_seen)| **is_seen);
            for (k, _) in seen {
                let Some(footprint) = out.get_mut(count) else { return count };
                *footprint = Footprint {
                    place: [lanes.place[0][k], lanes.place[1][k]],
                    profile: [lanes.profile[0][k], lanes.profile[1][k], lanes.profile[2][k]],
                    least_power: lanes.least_power[k],
                    opacity: lanes.opacity[k],
                    colour: [colours[0][k], colours[1][k], colours[2][k]],
                    depth_m: lanes.depth_m[k],
                    slope: [lanes.slope[0][k], lanes.slope[1][k]],
                    first: [lanes.first[0][k] as u16, lanes.first[1][k] as u16],
                    last: [lanes.last[0][k] as u16, lanes.last[1][k] as u16],
                };
                count = count.wrapping_add(1);
            }
        }
        count
    }
}

/// Ellipses of a block.
#[inline(always)]
fn measure(block: &Block, lens: &Lens, out: &mut Lanes) {
    let [right, down, ahead] = lens.rows;
    let low_pass = LOW_PASS_PX2 as f32;
    // Of the profile: a half, as a power of two.
    let half = -0.5 * core::f32::consts::LOG2_E;
    for k in 0..WIDE {
        let d = [0, 1, 2].map(|axis| block.middle[axis][k] - lens.eye[axis]);
        let z = dot(ahead, d);
        let near = 1.0 / z;
        let aside = [dot(right, d) * near, dot(down, d) * near];
        let held = [0, 1].map(|axis| clamp(aside[axis], lens.most_aside[axis]));
        let scale = lens.focal_px * near;
        // Rows of the Jacobian times the turn: pixels per unit of the file.
        let across = [0, 1, 2].map(|axis| scale * (right[axis] - held[0] * ahead[axis]));
        let along = [0, 1, 2].map(|axis| scale * (down[axis] - held[1] * ahead[axis]));
        let (s, t) = (times(block, k, across), times(block, k, along));
        let (a, b, c) = (dot(across, s), dot(across, t), dot(along, t));
        let (wide, high) = (a + low_pass, c + low_pass);
        let (sharp, det) = (a * c - b * b, wide * high - b * b);
        let inverse = 1.0 / det;
        let conic = [high * inverse, -b * inverse, wide * inverse];
        let share = sharp * inverse;
        let least = LEAST_COMPENSATION as f32;
        let kept = if share > least { share } else { least }.sqrt();
        let opacity = block.opacity[k] * if lens.is_antialiased { kept } else { 1.0 };
        let (zx, zy) = (dot(ahead, s), dot(ahead, t));
        let place = [lens.centre_px[0] + lens.focal_px * aside[0], lens.centre_px[1] + lens.focal_px * aside[1]];
        // Power of two of the profile at which the least opacity is left, and the square of that distance in deviations.
        let least_power = -logarithm(opacity * (1.0 / LEAST_ALPHA));
        let reach = least_power / half;
        let extent = [(reach * wide).sqrt(), (reach * high).sqrt()];
        let mut is_seen = (z > NEAR_M as f32) & (det > 0.0) & (opacity > LEAST_ALPHA);
        for axis in 0..2 {
            // Pixels whose centres it reaches.
            let first = most((place[axis] - extent[axis] - 0.5).ceil(), 0.0);
            let last = least_of((place[axis] + extent[axis] - 0.5).floor(), lens.last[axis]);
            is_seen &= first <= last;
            (out.first[axis][k], out.last[axis][k]) = (first, last);
            out.place[axis][k] = place[axis];
        }
        out.profile[0][k] = half * conic[0];
        out.profile[1][k] = 2.0 * half * conic[1];
        out.profile[2][k] = half * conic[2];
        out.least_power[k] = least_power;
        out.slope[0][k] = zx * conic[0] + zy * conic[1];
        out.slope[1][k] = zx * conic[1] + zy * conic[2];
        out.opacity[k] = opacity;
        out.depth_m[k] = z;
        let length = 1.0 / (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
        for (lanes, part) in out.direction.iter_mut().zip(d) {
            lanes[k] = part * length;
        }
        out.is_seen[k] = is_seen;
    }
}

/// Colours of a block in the directions of view, at least 0.
#[inline(always)]
fn colours(harmonics: &[[f32; WIDE]], direction: &[[f32; WIDE]; 3]) -> [[f32; WIDE]; 3] {
    let mut basis = [[0.0f32; WIDE]; 16];
    for k in 0..WIDE {
        let values = harmonics::single([direction[0][k], direction[1][k], direction[2][k]]);
        for (lanes, value) in basis.iter_mut().zip(values) {
            lanes[k] = value;
        }
    }
    let mut colours = [[0.5f32; WIDE]; 3];
    for (of_channels, basis) in harmonics.as_chunks::<3>().0.iter().zip(&basis) {
        for (colour, of_channel) in colours.iter_mut().zip(of_channels) {
            for k in 0..WIDE {
                colour[k] += of_channel[k] * basis[k];
            }
        }
    }
    for colour in &mut colours {
        for value in colour {
            *value = most(*value, 0.0);
        }
    }
    colours
}

#[inline(always)]
fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Covariance of lane `k` times a vector.
#[inline(always)]
fn times(block: &Block, k: usize, v: [f32; 3]) -> [f32; 3] {
    let [xx, xy, xz, yy, yz, zz] = &block.covariance;
    [
        xx[k] * v[0] + xy[k] * v[1] + xz[k] * v[2],
        xy[k] * v[0] + yy[k] * v[1] + yz[k] * v[2],
        xz[k] * v[0] + yz[k] * v[1] + zz[k] * v[2],
    ]
}

#[inline(always)]
fn most(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

#[inline(always)]
fn least_of(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[inline(always)]
fn clamp(value: f32, limit: f32) -> f32 {
    most(least_of(value, limit), -limit)
}
