//! Visible shares by rays and by pixels held against each other: made apart from each other, they should agree, and where
//! they do not there should be a reason.

use crate::report::{LabelGap, VerifyReport};
use crate::rows::{PlacedFlight, PlacedFrame};
use cosfly_diagnose::counted;

/// Shares that differ by more than this are listed.
const AGREEMENT: f64 = 0.05;
/// A body of fewer pixels has an outline of so many of them that pixel centres miss several of 100 points.
const FEW_PIXELS: f64 = 300.0;
/// Pixels that an outline explains, of a body of few pixels.
const MOST_MISSED_PX: f64 = 10.0;
const BOXES: &str = "rays meet boxes, within which roofs, crowns, benches and stalls are drawn";

/// Compares the two shares in all frames of a flight that show the target.
pub fn compare(file: &str, flight: &PlacedFlight, frames: &[PlacedFrame], report: &mut VerifyReport) {
    for frame in frames {
        let (Some(by_rays), by_pixels) = (frame.visible_by_dense_rays, frame.visible_by_pixels) else { continue };
        let place = || format!("row {}, `{}` frame {}", frame.row, frame.trajectory_id, frame.frame);
        if !(0.0..=1.0).contains(&by_rays) || !frame.in_view {
            let message = format!("`visible_by_dense_rays` is {by_rays}; it must lie between 0 and 1, in view only");
            report.find(file, place(), "verify-visibility", message);
        }
        report.labels += 1;
        if (by_rays - by_pixels).abs() > AGREEMENT {
            let reason = reason(flight, frame, by_rays - by_pixels);
            report.note_gap(LabelGap { file: file.to_owned(), place: place(), by_rays, by_pixels, reason });
        }
    }
}

/// Why rays and pixels may differ, as far as the tables tell.
fn reason(flight: &PlacedFlight, frame: &PlacedFrame, gap: f64) -> String {
    let box_px = frame.full_box().unwrap_or_default();
    let box_area_px = (box_px[2] - box_px[0]) * (box_px[3] - box_px[1]);
    // Known from the visible part; a body that is hidden wholly has at most the pixels of its box.
    let all_px = match frame.visible_by_pixels {
        share if share > 0.0 => f64::from(frame.visible_pixels) / share,
        _ => box_area_px,
    };
    let (width, height) = (f64::from(flight.camera.width), f64::from(flight.camera.height));
    let at_edge = box_px[0] <= 0.0 || box_px[1] <= 0.0 || box_px[2] >= width || box_px[3] >= height;
    let is_behind_boxes = gap < 0.0 && frame.occluder_instance != 0;
    if frame.clearance_m <= 0.0 {
        "the drone is inside of an obstacle, which no ray leaves".into()
    } else if gap > 0.0 && frame.occluder_instance == 0 {
        "the ground hides a part of it, which rays pass".into()
    } else if is_behind_boxes && -gap * all_px > MOST_MISSED_PX {
        BOXES.into()
    } else if all_px < FEW_PIXELS {
        let pixels = counted(all_px.round() as u64, "pixel");
        format!("the body has {pixels}, of which one is {:.1} points", 100.0 / all_px.max(1.0))
    } else if at_edge {
        "the body is cut off by the picture's edge".into()
    } else if !flight.lens.is_none() {
        "the lens bends the picture, rays are straight".into()
    } else if is_behind_boxes {
        BOXES.into()
    } else {
        "no reason is known".into()
    }
}
