//! Channels from the faces that won: depth from the exact plane of each, ids from its entry.

use crate::canvas::{Canvas, WIDE};
use crate::faces::{DrawnFace, SKY};
use crate::outputs::Outputs;
use cosfly_domain::TARGET_INSTANCE;
use cosfly_frames::simd_kernel;
use std::ops::Range;

simd_kernel! {
    /// Fills the channels that are asked for.
    pub fn resolve(canvas: &Canvas, faces: &[DrawnFace], outputs: &mut Outputs<'_>) {
        let width = canvas.width;
        if width == 0 {
            return;
        }
        let top = 0.5 - 0.5 * canvas.height as u32 as f64;
        for (row, blocks) in canvas.face.chunks_exact(canvas.blocks).enumerate() {
            let start = row.wrapping_mul(width);
            let pixels = start..start.wrapping_add(width);
            let y = top + row as u32 as f64;
            let mut depth_m = row_of(&mut outputs.depth_m, &pixels);
            let mut semantic = row_of(&mut outputs.semantic, &pixels);
            let mut instance = row_of(&mut outputs.instance, &pixels);
            let mut mask = row_of(&mut outputs.target_mask, &pixels);
            for ((block, numbers), x) in blocks.iter().enumerate().zip(&canvas.columns) {
                let at = block.wrapping_mul(WIDE);
                let face = face_of(faces, numbers[0]);
                let mut inverse = [0.0f32; WIDE];
                let base = face.plane[0] + face.plane[2] * y;
                for k in 0..WIDE {
                    inverse[k] = (base + face.plane[1] * f64::from(x[k])) as f32;
                }
                let mut labels = [face.label; WIDE];
                let mut ids = [face.instance; WIDE];
                if !is_one(numbers) {
                    for k in 1..WIDE {
                        let face = face_of(faces, numbers[k]);
                        inverse[k] = (face.plane[0] + face.plane[2] * y + face.plane[1] * f64::from(x[k])) as f32;
                        (labels[k], ids[k]) = (face.label, face.instance);
                    }
                }
                if let Some(depth_m) = &mut depth_m {
                    let mut depths = [0.0f32; WIDE];
                    for k in 0..WIDE {
                        depths[k] = 1.0 / inverse[k];
                    }
                    write(&depths, depth_m, at);
                }
                if let Some(semantic) = &mut semantic {
                    write(&labels, semantic, at);
                }
                if let Some(instance) = &mut instance {
                    write(&ids, instance, at);
                }
                if let Some(mask) = &mut mask {
                    write(&ids.map(|id| u8::from(id == TARGET_INSTANCE)), mask, at);
                }
            }
        }
    }
}

/// A row of a channel that is asked for.
#[inline(always)]
fn row_of<'a, T>(channel: &'a mut Option<&mut [T]>, pixels: &Range<usize>) -> Option<&'a mut [T]> {
    channel.as_mut().and_then(|channel| channel.get_mut(pixels.clone()))
}

/// Whether all pixels of a block are of one face.
#[inline(always)]
fn is_one(ids: &[f32; WIDE]) -> bool {
    let mut differences = 0;
    for k in 1..WIDE {
        differences |= ids[k].to_bits() ^ ids[0].to_bits();
    }
    differences == 0
}

#[inline(always)]
fn face_of(faces: &[DrawnFace], number: f32) -> &DrawnFace {
    faces.get(number as i32 as usize).unwrap_or(&SKY)
}

/// Writes a block of a row; the last may be cut off.
#[inline(always)]
fn write<T: Copy>(values: &[T; WIDE], row: &mut [T], at: usize) {
    let Some(rest) = row.get_mut(at..) else { return };
    match rest.first_chunk_mut::<WIDE>() {
        Some(out) => *out = *values,
        None => rest.iter_mut().zip(values).for_each(|(out, value)| *out = *value),
    }
}
