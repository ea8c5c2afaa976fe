//! Channels that a recipe asks for, pixel by pixel from the faces seen and their depths.

use crate::faces::DrawnFace;
use cosfly_domain::FrameImages;
use cosfly_domain::channels::SeenPoint;
use cosfly_frames::DVec3;
use cosfly_raster::eye::Eye;
use cosfly_raster::visibility::Screen;

/// Fills the channels on request of a frame whose other channels are finished; `nearest` are the faces seen.
pub(crate) fn draw(images: &mut FrameImages, nearest: &[u32], faces: &[DrawnFace], eye: &Eye, screen: &Screen) {
    let mut on_request = core::mem::take(&mut images.on_request);
    for_each_point(images, (nearest, faces), (eye, screen), &mut |at, point| {
        for image in on_request.iter_mut().filter(|image| !image.channel.is_of_films()) {
            let size = image.channel.bytes_on_request();
            image.channel.draw(point, &mut image.bytes[size * at..size * (at + 1)]);
        }
    });
    images.on_request = on_request;
}

/// Visits what is seen at each pixel of a frame, by its number.
pub(crate) fn for_each_point(
    images: &FrameImages,
    (nearest, faces): (&[u32], &[DrawnFace]),
    (eye, screen): (&Eye, &Screen),
    visit: &mut dyn FnMut(usize, &SeenPoint),
) {
    let turn = eye.world_from_body;
    for (at, &face) in nearest.iter().enumerate() {
        let (column, row) = ((at % screen.width) as f64, (at / screen.width) as f64);
        let across = (column + 0.5 - screen.center_u) / screen.focal_px;
        let up = (screen.center_v - row - 0.5) / screen.focal_px;
        let ray_in_world = turn * DVec3::new(1.0, across, up);
        let any_side = faces.get(face as usize).map_or(DVec3::ZERO, |face| DVec3::from(face.normal.map(f64::from)));
        let point = SeenPoint {
            depth_m: images.depth_m[at],
            label: images.semantic[at],
            instance: images.instance[at],
            normal_in_world: if any_side.dot(ray_in_world) > 0.0 { -any_side } else { any_side },
            ray_in_world,
            camera_in_world: eye.position_in_world,
        };
        visit(at, &point);
    }
}
