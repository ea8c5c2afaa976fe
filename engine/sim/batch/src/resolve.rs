//! Channels from the faces that won: depth from the exact plane of each, ids from its entry.

use crate::canvas::{Canvas, WIDE};
use crate::faces::DrawnFace;
use crate::outputs::Outputs;
use cosfly_frames::simd::Level;
use cosfly_frames::simd_kernel;
use cosfly_render::frame::TARGET_INSTANCE;

/// Fills the channels that are asked for.
pub fn resolve(level: Level, canvas: &Canvas, faces: &[DrawnFace], outputs: &mut Outputs<'_>) {
    if let Some(depth_m) = &mut outputs.depth_m {
        depths(level, canvas, faces, depth_m);
    }
    if let Some(semantic) = &mut outputs.semantic {
        each_row(canvas, semantic, |ids, row| looked_up(faces, ids, row, |face| face.label));
    }
    if let Some(instance) = &mut outputs.instance {
        each_row(canvas, instance, |ids, row| looked_up(faces, ids, row, |face| face.instance));
    }
    if let Some(mask) = &mut outputs.target_mask {
        each_row(canvas, mask, |ids, row| {
            looked_up(faces, ids, row, |face| u8::from(face.instance == TARGET_INSTANCE));
        });
    }
}

/// Calls `fill` with the face numbers of each row and the row of a channel.
fn each_row<T>(canvas: &Canvas, channel: &mut [T], fill: impl Fn(&[u32], &mut [T])) {
    if canvas.width == 0 {
        return;
    }
    for (ids, row) in canvas.face.chunks_exact(canvas.blocks).zip(channel.chunks_exact_mut(canvas.width)) {
        fill(&ids.as_flattened()[..canvas.width], row);
    }
}

#[inline(always)]
fn looked_up<T: Copy>(faces: &[DrawnFace], ids: &[u32], row: &mut [T], value: impl Fn(&DrawnFace) -> T) {
    // Neighbours mostly are of one face.
    let mut last = 0u32;
    let mut known = value(&faces[0]);
    for (id, out) in ids.iter().zip(row) {
        if *id != last {
            last = *id;
            known = value(&faces[*id as usize]);
        }
        *out = known;
    }
}

simd_kernel! {
    /// Depth of each pixel: 1 over the exact inverse depth of its face at the pixel's centre.
    fn depths(canvas: &Canvas, faces: &[DrawnFace], depth_m: &mut [f32]) {
        if canvas.width == 0 {
            return;
        }
        let top = 0.5 - 0.5 * canvas.height as u32 as f64;
        let rows = canvas.face.chunks_exact(canvas.blocks).zip(depth_m.chunks_exact_mut(canvas.width));
        for (row, (blocks, out)) in rows.enumerate() {
            let y = top + row as u32 as f64;
            for ((ids, x), out) in blocks.iter().zip(&canvas.columns).zip(out.chunks_mut(WIDE)) {
                let mut values = [0.0f32; WIDE];
                let mut differences = 0;
                for k in 1..WIDE {
                    differences |= ids[k] ^ ids[0];
                }
                if differences == 0 {
                    let plane = faces[ids[0] as usize].plane;
                    let base = plane[0] + plane[2] * y;
                    for k in 0..WIDE {
                        values[k] = (base + plane[1] * f64::from(x[k])) as f32;
                    }
                } else {
                    for k in 0..WIDE {
                        let plane = faces[ids[k] as usize].plane;
                        values[k] = (plane[0] + plane[2] * y + plane[1] * f64::from(x[k])) as f32;
                    }
                }
                for value in values.iter_mut() {
                    *value = 1.0 / *value;
                }
                let count = out.len();
                out.copy_from_slice(&values[..count]);
            }
        }
    }
}
