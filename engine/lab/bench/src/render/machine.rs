//! Limits of the machine's memory: filling, copying, and the simplest depth test, in the bytes of a frame.

use crate::clock::timed;
use cosfly_frames::simd::Level;
use cosfly_frames::simd_kernel;
use serde::Serialize;
use std::hint::black_box;

/// Bytes per pixel of all channels: colour 3, depth 4, semantic 1, instance 4.
pub const PIXEL_BYTES: usize = 12;
/// Buffer size beyond the caches of one core, bytes.
const FAR_BYTES: usize = 256 << 20;

/// Limits of one core.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Machine {
    /// Fill rate beyond the core's own caches, GB/s.
    pub far_fill_gbps: f64,
    /// Copy rate beyond the core's own caches, GB/s of copied bytes.
    pub far_copy_gbps: f64,
    /// Fill rate of a frame's channels, again and again, GB/s.
    pub frame_fill_gbps: f64,
    /// Time to write every channel of a frame once, milliseconds: a lower limit for any renderer.
    pub frame_fill_ms: f64,
    /// Rate of vectorised depth tests (read, compare and replace depth and face), millions of pixels per second.
    pub depth_tests_mpps: f64,
    /// Time of one depth test per pixel of a frame, milliseconds.
    pub frame_depth_test_ms: f64,
}

impl Machine {
    /// Measures the limits; takes about half a second.
    pub fn measure(pixels: usize) -> Self {
        let frame_bytes = PIXEL_BYTES * pixels;
        let mut far = vec![1u8; FAR_BYTES];
        let far_fill_s = least_s(3, |round| far.fill(round as u8));
        let (from, to) = far.split_at_mut(FAR_BYTES / 2);
        let far_copy_s = least_s(3, |_| to.copy_from_slice(from));
        let mut frame = vec![1u8; frame_bytes];
        let frame_fill_s = least_s(20, |round| frame.fill(round as u8));
        let mut depth = vec![f32::INFINITY; pixels];
        let mut face = vec![0u32; pixels];
        let mut tested_s = f64::INFINITY;
        for round in 0..20 {
            depth.fill(f32::INFINITY);
            // Each pixel is drawn twice: once nearer, once farther.
            let once = timed(|| {
                test_depths(Level::best(), &mut depth, &mut face, 10.0, 1e-3, round);
                test_depths(Level::best(), &mut depth, &mut face, 20.0, 1e-3, round + 1);
            });
            tested_s = tested_s.min(0.5 * once.1);
        }
        black_box((&far, &frame, &depth, &face));
        Self {
            far_fill_gbps: 1e-9 * FAR_BYTES as f64 / far_fill_s,
            far_copy_gbps: 1e-9 * (FAR_BYTES / 2) as f64 / far_copy_s,
            frame_fill_gbps: 1e-9 * frame_bytes as f64 / frame_fill_s,
            frame_fill_ms: 1e3 * frame_fill_s,
            depth_tests_mpps: 1e-6 * pixels as f64 / tested_s,
            frame_depth_test_ms: 1e3 * tested_s,
        }
    }
}

fn least_s(rounds: u32, mut work: impl FnMut(u32)) -> f64 {
    (0..rounds).map(|round| timed(|| work(black_box(round))).1).fold(f64::INFINITY, f64::min)
}

simd_kernel! {
    /// Draws a slanted plane over all pixels.
    fn test_depths(depth: &mut [f32], face: &mut [u32], first: f32, step: f32, number: u32) {
        let ramp: [f32; 64] = core::array::from_fn(|i| i as f32);
        let blocks = depth.as_chunks_mut::<64>().0.iter_mut().zip(face.as_chunks_mut::<64>().0);
        for (block, (depth, face)) in blocks.enumerate() {
            let start = first + step * (block % 64) as f32;
            for i in 0..64 {
                let here = start + step * ramp[i];
                let nearer = here < depth[i];
                face[i] = if nearer { number } else { face[i] };
                depth[i] = if nearer { here } else { depth[i] };
            }
        }
    }
}
