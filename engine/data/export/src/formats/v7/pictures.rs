//! The files of a frame: `rgb.png`, `depth.npy`, `instance.png`, `debug.png`.

use super::short_ids::ShortIds;
use crate::pixels::{npy, rgb_of};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_images::rgb::png as rgb_png;
use cosfly_read::LoggedFrame;

/// Depth of the sky in CARLA's depth camera, metres.
pub const FAR_M: f32 = 1000.0;
/// Colours of the target's boxes: of the whole body, and of its visible part.
const COLOURS: [[u8; 3]; 2] = [[255, 220, 40], [60, 255, 90]];

/// Calls `put` with names and bytes of the files; `debug.png` is one of them if `with_debug`.
pub fn write(
    logged: &LoggedFrame,
    ids: &ShortIds,
    with_debug: bool,
    put: &mut dyn FnMut(&str, &[u8]) -> Result<()>,
) -> Result<()> {
    let (width, height) = (logged.width, logged.height);
    let mut rgb = rgb_of(logged)?;
    let mut file = vec![];
    rgb_png(&rgb, width, height, &mut file)?;
    put("rgb.png", &file)?;
    let depth_m: Vec<f32> = logged.depth_m.iter().map(|depth| depth.min(FAR_M)).collect();
    put("depth.npy", &npy(&depth_m, [width, height]))?;
    rgb_png(&instance_bytes(logged, ids)?, width, height, &mut file)?;
    put("instance.png", &file)?;
    if !with_debug {
        return Ok(());
    }
    for (edges, colour) in [&logged.target.full_box_px, &logged.target.visible_box_px].into_iter().zip(COLOURS) {
        if let [left, top, right, bottom] = edges[..] {
            outline(&mut rgb, [width, height], [left, top, right, bottom], colour);
        }
    }
    rgb_png(&rgb, width, height, &mut file)?;
    put("debug.png", &file)
}

/// Bytes of CARLA's instance camera: label, low byte of the id, high byte.
fn instance_bytes(logged: &LoggedFrame, ids: &ShortIds) -> Result<Vec<u8>> {
    let mut bytes = Vec::with_capacity(3 * logged.instance.len());
    for (label, id) in logged.semantic.iter().zip(&logged.instance) {
        let number = ids.number(*id).map_err(|id| {
            let message = format!("the id {id} in frame {} has no number of 16 bits", logged.target.frame);
            Diagnostic::new("export-image", Fault::Input, message)
                .hint("export the dataset as `webdataset` or `coco`, which keep ids of 32 bits")
        })?;
        let [low, high] = number.to_le_bytes();
        bytes.extend([*label, low, high]);
    }
    Ok(bytes)
}

/// Colours the pixels on the edges of a box.
fn outline(rgb: &mut [u8], [width, height]: [u32; 2], [left, top, right, bottom]: [u32; 4], colour: [u8; 3]) {
    let mut paint = |x: u32, y: u32| {
        let at = 3 * (y as usize * width as usize + x as usize);
        rgb[at..at + 3].copy_from_slice(&colour);
    };
    if left >= right || top >= bottom || right > width || bottom > height {
        return;
    }
    for x in left..right {
        paint(x, top);
        paint(x, bottom - 1);
    }
    for y in top..bottom {
        paint(left, y);
        paint(right - 1, y);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_is_drawn_on_its_edges_and_one_beyond_the_image_is_not() {
        let mut rgb = vec![0; 3 * 6 * 4];
        outline(&mut rgb, [6, 4], [1, 0, 5, 3], [9; 3]);
        let painted: Vec<usize> = (0..24).filter(|at| rgb[3 * at] == 9).collect();
        assert_eq!(painted, [1, 2, 3, 4, 7, 10, 13, 14, 15, 16]);
        let before = rgb.clone();
        outline(&mut rgb, [6, 4], [1, 0, 7, 3], [1; 3]);
        assert_eq!(rgb, before);
    }
}
