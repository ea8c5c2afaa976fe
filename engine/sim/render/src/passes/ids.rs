//! Planar depth, semantic and instance ids of one row, from the faces seen in it.

use crate::frame::FrameImages;
use crate::renderer::DrawnFace;
use crate::visibility::NO_FACE;
use cosfly_maps::SemanticLabel;
use std::ops::Range;

/// Fills a row. Depth is `1 / (plane at the pixel centre)` in f64, rounded once.
pub(crate) fn resolve_row(
    row: usize,
    seen: &[u32],
    faces: &[DrawnFace],
    pixels: Range<usize>,
    images: &mut FrameImages,
) {
    let depth = &mut images.depth_m[pixels.clone()];
    let semantic = &mut images.semantic[pixels.clone()];
    let instance = &mut images.instance[pixels];
    for_each_run(seen, |run, number| {
        if number == NO_FACE {
            depth[run.clone()].fill(f32::INFINITY);
            semantic[run.clone()].fill(SemanticLabel::Sky.id());
            instance[run].fill(0);
            return;
        }
        let face = &faces[number as usize];
        let base = face.plane.constant + face.plane.down * (row as f64 + 0.5);
        let first = run.start as f64 + 0.5;
        for (k, out) in depth[run.clone()].iter_mut().enumerate() {
            *out = (1.0 / (base + face.plane.across * (first + k as i32 as f64))) as f32;
        }
        semantic[run.clone()].fill(face.label);
        instance[run].fill(face.instance);
    });
}

/// Calls `visit` with every run of equal face numbers in a row.
#[inline]
pub(crate) fn for_each_run(seen: &[u32], mut visit: impl FnMut(Range<usize>, u32)) {
    let mut start = 0;
    while start < seen.len() {
        let number = seen[start];
        let length = seen[start..].iter().position(|&other| other != number).unwrap_or(seen.len() - start);
        visit(start..start + length, number);
        start += length;
    }
}
