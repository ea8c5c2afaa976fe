//! Channels from the faces that won: depth from the exact plane of each, ids from its entry.

use crate::canvas::{Canvas, WIDE};
use crate::faces::{DrawnFace, SKY};
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
        labels(level, canvas, faces, semantic);
    }
    if let Some(instance) = &mut outputs.instance {
        ids(level, canvas, faces, instance);
    }
    if let Some(mask) = &mut outputs.target_mask {
        target(level, canvas, faces, mask);
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
                if is_one(ids) {
                    let plane = face_of(faces, ids[0]).plane;
                    let base = plane[0] + plane[2] * y;
                    for k in 0..WIDE {
                        values[k] = (base + plane[1] * f64::from(x[k])) as f32;
                    }
                } else {
                    for k in 0..WIDE {
                        let plane = &face_of(faces, ids[k]).plane;
                        values[k] = (plane[0] + plane[2] * y + plane[1] * f64::from(x[k])) as f32;
                    }
                }
                for value in values.iter_mut() {
                    *value = 1.0 / *value;
                }
                write(&values, out);
            }
        }
    }
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

/// Writes a block; the last of a row may be cut off.
#[inline(always)]
fn write<T: Copy>(values: &[T; WIDE], out: &mut [T]) {
    match out.first_chunk_mut::<WIDE>() {
        Some(out) => *out = *values,
        None => out.iter_mut().zip(values).for_each(|(out, value)| *out = *value),
    }
}

/// A kernel that writes a number of each pixel's face.
macro_rules! looked_up {
    ($name:ident, $type:ty, $face:ident => $value:expr) => {
        simd_kernel! {
            fn $name(canvas: &Canvas, faces: &[DrawnFace], out: &mut [$type]) {
                if canvas.width == 0 {
                    return;
                }
                let rows = canvas.face.chunks_exact(canvas.blocks).zip(out.chunks_exact_mut(canvas.width));
                for (blocks, out) in rows {
                    for (ids, out) in blocks.iter().zip(out.chunks_mut(WIDE)) {
                        let $face = face_of(faces, ids[0]);
                        let mut values = [$value; WIDE];
                        if !is_one(ids) {
                            for k in 1..WIDE {
                                let $face = face_of(faces, ids[k]);
                                values[k] = $value;
                            }
                        }
                        write(&values, out);
                    }
                }
            }
        }
    };
}

looked_up!(labels, u8, face => face.label);
looked_up!(ids, u32, face => face.instance);
looked_up!(target, u8, face => u8::from(face.instance == TARGET_INSTANCE));
