//! Visible part of people in a frame, counted in pixels; of the target, against the target drawn alone.

use cosfly_domain::channels::mask_amodal;
use cosfly_domain::{BodyView, FrameImages, PixelBox, TARGET_INSTANCE, TargetView};
use cosfly_figures::FigureInPicture;
use cosfly_frames::simd::Level;
use cosfly_frames::simd_kernel;
use cosfly_raster::visibility::{NO_FACE, VisibilityBuffer};

/// The view of a target that is not in the image.
pub(crate) const NOT_IN_VIEW: TargetView = TargetView {
    in_view: false,
    visible_by_rays: 0.0,
    visible_by_pixels: 0.0,
    pixels: 0,
    visible_box: None,
    full_box: None,
    occluder_instance: 0,
};

/// Indices of the pixels that the target would cover without obstacles, ascending.
pub(crate) fn covered_pixels(alone: &VisibilityBuffer, width: usize, covered: &mut Vec<u32>) {
    covered.clear();
    let (first_row, end_row) = alone.drawn_rows();
    let pixels = first_row * width..end_row * width;
    covered.extend(pixels.filter(|pixel| alone.face[*pixel] != NO_FACE).map(|pixel| pixel as u32));
}

/// Fills the channel `mask_amodal`, where it was asked for, from the pixels that the target would cover without obstacles.
pub(crate) fn draw_alone(images: &mut FrameImages, covered: &[u32]) {
    let Some(image) = images.on_request.iter_mut().find(|image| *image.channel == mask_amodal::CHANNEL) else { return };
    image.bytes.fill(0);
    covered.iter().for_each(|pixel| image.bytes[*pixel as usize] = 1);
}

/// View of the target in `images`, when it would cover the pixels `covered` without obstacles; `visible_by_rays` is
/// left 0: rays are of another room. `occluders` is scratch.
pub fn measure(images: &FrameImages, covered: &[u32], occluders: &mut Vec<u32>) -> TargetView {
    let width = images.width.max(1);
    let (mut visible, mut full) = (Extent::default(), Extent::default());
    occluders.clear();
    for &pixel in covered {
        let (column, row) = (pixel % width, pixel / width);
        full.add(column, row);
        match images.instance[pixel as usize] {
            TARGET_INSTANCE => visible.add(column, row),
            other => occluders.push(other),
        }
    }
    if full.count == 0 {
        return NOT_IN_VIEW;
    }
    TargetView {
        in_view: true,
        visible_by_rays: 0.0,
        visible_by_pixels: f64::from(visible.count) / f64::from(full.count),
        pixels: visible.count,
        visible_box: visible.pixel_box,
        full_box: full.pixel_box,
        occluder_instance: most_frequent(occluders),
    }
}

/// Views of `others` in `images`, by instance id.
pub(crate) fn measure_bodies(
    level: Level,
    images: &FrameImages,
    others: &[FigureInPicture],
    views: &mut Vec<BodyView>,
) {
    views.clear();
    // People's ids come after those of objects: most pixels are told by one comparison.
    let ids = others.iter().map(|other| other.instance);
    let (Some(least), Some(most)) = (ids.clone().min(), ids.max()) else { return };
    let is_person = |id: u32| (least..=most).contains(&id);
    let width = images.width.max(1) as usize;
    for (row, line) in images.instance.chunks(width).enumerate() {
        for (place, part) in line.chunks(64).enumerate() {
            if !holds_any(level, part, least, most) {
                continue;
            }
            let people = part.iter().enumerate().filter(|(_, id)| is_person(**id));
            people.for_each(|(at, id)| add_pixel(views, *id, (64 * place + at) as u32, row as u32));
        }
    }
    views.retain(|view| others.iter().any(|other| other.instance == view.instance));
    views.sort_unstable_by_key(|view| view.instance);
}

simd_kernel! {
    /// Whether an id lies between two, ends included.
    fn holds_any(ids: &[u32], least: u32, most: u32) -> bool {
        let mut any = 0u32;
        for id in ids {
            any |= u32::from((*id >= least) & (*id <= most));
        }
        any != 0
    }
}

fn add_pixel(views: &mut Vec<BodyView>, instance: u32, u: u32, v: u32) {
    // The person seen last comes first in the search.
    match views.iter_mut().rev().find(|view| view.instance == instance) {
        Some(view) => {
            view.pixels += 1;
            view.visible_box.add(u, v);
        }
        None => {
            let visible_box = PixelBox { u_min: u, v_min: v, u_max: u, v_max: v };
            views.push(BodyView { instance, pixels: 1, visible_box });
        }
    }
}

/// The most frequent number other than 0, the smaller one of two equals; 0 when there is none.
fn most_frequent(numbers: &mut [u32]) -> u32 {
    numbers.sort_unstable();
    let (mut best, mut best_count) = (0, 0);
    for group in numbers.chunk_by(|a, b| a == b) {
        if group[0] != 0 && group.len() > best_count {
            (best, best_count) = (group[0], group.len());
        }
    }
    best
}

#[derive(Default)]
struct Extent {
    count: u32,
    pixel_box: Option<PixelBox>,
}

impl Extent {
    fn add(&mut self, u: u32, v: u32) {
        self.count += 1;
        self.pixel_box.get_or_insert(PixelBox { u_min: u, v_min: v, u_max: u, v_max: v }).add(u, v);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_main_occluder_is_the_most_frequent_object() {
        assert_eq!(most_frequent(&mut [7, 0, 3, 7, 0, 0, 0]), 7);
        assert_eq!(most_frequent(&mut [9, 4]), 4);
        assert_eq!(most_frequent(&mut []), 0);
    }
}
