//! Disparity of a stereo pair: exact, from the depth of the picture.

use cosfly_domain::channels::disparity;
use cosfly_domain::{Camera, FrameImages};

/// Fills the channel from the finished depths of a frame, where it was asked for; 0 without a pair.
pub(super) fn draw(images: &mut FrameImages, camera: &Camera, base_line_m: Option<f64>) {
    let FrameImages { depth_m, on_request, .. } = images;
    let Some(image) = on_request.iter_mut().find(|image| *image.channel == disparity::CHANNEL) else { return };
    let scale = camera.focal_px() * base_line_m.unwrap_or_default();
    let (pixels, _) = image.bytes.as_chunks_mut::<4>();
    for (pixel, depth_m) in pixels.iter_mut().zip(depth_m) {
        *pixel = ((scale / f64::from(*depth_m)) as f32).to_le_bytes();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_domain::ChannelImage;

    #[test]
    fn the_disparity_is_the_base_line_in_the_picture_and_0_for_the_sky() {
        let camera = Camera { width: 2, height: 1, horizontal_fov_rad: 1.4 };
        let on_request = vec![ChannelImage::new(&disparity::CHANNEL, 2)];
        let mut images = FrameImages { depth_m: vec![6.0, f32::INFINITY], on_request, ..FrameImages::default() };
        draw(&mut images, &camera, Some(0.3));
        let (bytes, _) = images.on_request[0].bytes.as_chunks::<4>();
        let found = [0, 1].map(|at| f32::from_le_bytes(bytes[at]));
        assert!((f64::from(found[0]) - camera.focal_px() * 0.05).abs() < 1e-6 && found[1] == 0.0, "{found:?}");
    }
}
