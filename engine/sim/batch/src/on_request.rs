//! Channels of the list that are drawn pixel by pixel, from the faces that won.

use crate::canvas::{Canvas, WIDE};
use crate::eye::Eye;
use crate::faces::{DrawnFace, SKY};
use cosfly_domain::channels::SeenPoint;
use cosfly_frames::{DMat3, DVec3};

/// A channel on request: how a pixel is drawn, and the buffer of the caller.
pub enum OnRequest<'a> {
    /// A number for each pixel.
    Numbers(fn(&SeenPoint) -> f32, &'a mut [f32]),
    /// Three bytes for each pixel.
    Bytes(fn(&SeenPoint) -> [u8; 3], &'a mut [u8]),
}

impl<'a> OnRequest<'a> {
    /// Number of pixels in the buffer; none where they are not whole.
    pub(crate) fn pixels(&self) -> Option<usize> {
        match self {
            Self::Numbers(_, numbers) => Some(numbers.len()),
            Self::Bytes(_, bytes) => bytes.len().is_multiple_of(3).then_some(bytes.len() / 3),
        }
    }

    /// Takes the first `pixels` pixels away.
    pub(crate) fn split_off(&mut self, pixels: usize) -> OnRequest<'a> {
        match self {
            Self::Numbers(number, rest) => OnRequest::Numbers(*number, first(rest, pixels)),
            Self::Bytes(bytes, rest) => OnRequest::Bytes(*bytes, first(rest, 3 * pixels)),
        }
    }

    /// Fills a pixel.
    pub(crate) fn set(&mut self, at: usize, point: &SeenPoint) {
        match self {
            Self::Numbers(number, numbers) => numbers[at] = number(point),
            Self::Bytes(three, bytes) => bytes[3 * at..3 * at + 3].copy_from_slice(&three(point)),
        }
    }
}

/// Takes the first elements of a buffer away.
pub fn first<'a, T>(buffer: &mut &'a mut [T], count: usize) -> &'a mut [T] {
    let (head, rest) = core::mem::take(buffer).split_at_mut(count);
    *buffer = rest;
    head
}

/// Fills the channels on request of one picture.
pub fn draw(eye: &Eye, canvas: &Canvas, faces: &[DrawnFace], channels: &mut [OnRequest<'_>]) {
    let world_from_body = eye.body_from_world.transpose();
    let [ahead, right, down] = eye.ray_in_world;
    let top = 0.5 - 0.5 * canvas.height as f64;
    for row in 0..canvas.height {
        let y = top + row as f64;
        for column in 0..canvas.width {
            let (block, lane) = (column / WIDE, column % WIDE);
            let number = canvas.face[row * canvas.blocks + block][lane];
            let face = faces.get(number as usize).unwrap_or(&SKY);
            let x = f64::from(canvas.columns[block][lane]);
            // As where depth is an output.
            let inverse = (face.plane[0] + face.plane[2] * y + face.plane[1] * x) as f32;
            let point = SeenPoint {
                depth_m: 1.0 / inverse,
                label: face.label,
                instance: face.instance,
                normal_in_world: normal_in_world(face, eye, world_from_body),
                ray_in_world: ahead + right * x + down * y,
                camera_in_world: eye.position_in_world,
            };
            channels.iter_mut().for_each(|channel| channel.set(row * canvas.width + column, &point));
        }
    }
}

/// Unit normal of a face on the camera's side; zero for the sky. The inverse depth of a plane is the component of the ray along its
/// normal over the plane's distance, and positive where the plane is seen: its gradient points away from the camera.
fn normal_in_world(face: &DrawnFace, eye: &Eye, world_from_body: DMat3) -> DVec3 {
    let [center, across, down] = face.plane;
    let away = DVec3::new(center, across * eye.focal_px, -down * eye.focal_px);
    -(world_from_body * away).normalize_or_zero()
}
