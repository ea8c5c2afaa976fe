//! Softens stair steps along edges of the RGB image; depth and ids are left as sampled.

use crate::frame::FrameImages;
use crate::renderer::{DrawnFace, FaceSource};
use crate::visibility::{NO_FACE, Visibility};

/// Blends pixels on the border of two surfaces along the border's direction. `scratch` is reused between frames.
pub(crate) fn smooth_edges(nearest: &Visibility, faces: &[DrawnFace], images: &mut FrameImages, scratch: &mut Vec<u8>) {
    let (width, height) = (images.width as usize, images.height as usize);
    if width < 3 || height < 3 {
        return;
    }
    scratch.clear();
    scratch.extend_from_slice(&images.rgb);
    for row in 1..height - 1 {
        for column in 1..width - 1 {
            let at = row * width + column;
            let own = nearest.face[at];
            let around = [at - 1, at + 1, at - width, at + width];
            if around.iter().all(|&other| nearest.face[other] == own) {
                continue;
            }
            if around.iter().all(|&other| same_surface(faces, own, nearest.face[other])) {
                continue;
            }
            blend(scratch, width, at, &mut images.rgb[3 * at..3 * at + 3]);
        }
    }
}

/// Neighbouring triangles of one ground are no edge.
fn same_surface(faces: &[DrawnFace], a: u32, b: u32) -> bool {
    if a == b {
        return true;
    }
    if a == NO_FACE || b == NO_FACE {
        return false;
    }
    let (a, b) = (&faces[a as usize], &faces[b as usize]);
    let ground = |face: &DrawnFace| matches!(face.source, FaceSource::Ground { .. });
    ground(a) && ground(b) && a.label == b.label
}

/// A small tent filter, with more weight along the direction in which brightness changes least.
fn blend(pixels: &[u8], width: usize, at: usize, out: &mut [u8]) {
    let luma = |index: usize| {
        2 * i32::from(pixels[3 * index]) + 5 * i32::from(pixels[3 * index + 1]) + i32::from(pixels[3 * index + 2])
    };
    let (left, right, up, down) = (luma(at - 1), luma(at + 1), luma(at - width), luma(at + width));
    let horizontal = (left + right - 2 * luma(at)).abs();
    let vertical = (up + down - 2 * luma(at)).abs();
    let (across, along) = if horizontal > vertical { (1, width) } else { (width, 1) };
    for (channel, byte) in out.iter_mut().enumerate() {
        let value = |index: usize| i32::from(pixels[3 * index + channel]);
        let sides = value(at - across) + value(at + across);
        let ends = value(at - along) + value(at + along);
        *byte = ((8 * value(at) + 3 * sides + ends + 8) / 16).clamp(0, 255) as u8;
    }
}
