//! Normals of what stands: against the surfaces that the depths of the same picture make.

use super::rows::{PlacedFlight, PlacedFrame};
use cosfly_domain::SemanticLabel;
use cosfly_frames::{DVec3, Pose};

/// Every so many pixels are compared.
const EVERY: usize = 61;
/// Pixels between the points that make a surface: depths have steps of a millimetre.
const APART: usize = 3;
/// Cosine of the angle between normals that are the same.
const SAME: f64 = 0.9;
/// Cosine of the angle to the vertical below which a surface is steep: the ground alone cannot tell swapped axes.
const STEEP: f64 = 0.5;
/// Least number of points of a kind, and the share of them that may differ: curbs, frames of windows and figures lie between points.
const LEAST: usize = 20;
const MOST_SHARE: f64 = 0.4;

/// Normals of some pixels by their depths, world frame.
#[derive(Default)]
pub struct Surfaces(Vec<(usize, DVec3)>);

impl Surfaces {
    /// Those of a frame: of pixels that show one thing that stands, but no leaves, with those to the right and below; none through a lens.
    pub fn of(
        flight: &PlacedFlight,
        row: &PlacedFrame,
        (depths, labels, ids): (&[u8], Option<&[u8]>, &[u32]),
        stands: &dyn Fn(u32) -> bool,
    ) -> Self {
        let Some(labels) = labels.filter(|_| flight.lens.is_none() && flight.readout_s == 0.0) else {
            return Self::default();
        };
        let width = flight.camera.width as usize;
        let leaves = SemanticLabel::Vegetation.id();
        let pose: &Pose = &row.camera_pose;
        let point = |pixel: usize| {
            let four = depths.get(4 * pixel..4 * pixel + 4)?;
            let depth_m = f64::from(f32::from_le_bytes(four.try_into().ok()?));
            let (u, v) = ((pixel % width) as f64 + 0.5, (pixel / width) as f64 + 0.5);
            depth_m.is_finite().then(|| depth_m * flight.camera.ray_in_world(pose, u, v))
        };
        let normal = |pixel: usize| {
            let beside = [pixel + APART, pixel + APART * width];
            let is_one = pixel % width + APART < width
                && beside
                    .iter()
                    .all(|other| ids.get(*other) == ids.get(pixel) && labels.get(*other) == labels.get(pixel));
            let is_plain = ids.get(pixel).is_some_and(|id| stands(*id)) && labels.get(pixel) != Some(&leaves);
            let here = point(pixel).filter(|_| is_one && is_plain)?;
            let normal = (point(beside[1])? - here).cross(point(beside[0])? - here).normalize_or_zero();
            Some((pixel, if normal.dot(here) > 0.0 { -normal } else { normal }))
        };
        Self((0..ids.len()).step_by(EVERY).filter_map(normal).collect())
    }

    /// Fault of the normals of the frame, in words.
    pub fn finding(&self, stored: &[u8]) -> Option<String> {
        let part = |byte: u8| (f64::from(byte) - 128.0) / 127.0;
        let found = |pixel: usize| match *stored.get(3 * pixel..3 * pixel + 3)? {
            [x, y, z] => Some(DVec3::new(part(x), part(y), part(z))),
            _ => None,
        };
        [true, false].into_iter().find_map(|is_steep| {
            let own = self.0.iter().filter(|(_, normal)| (normal.z.abs() < STEEP) == is_steep);
            let both: Vec<(usize, DVec3, DVec3)> =
                own.filter_map(|(pixel, normal)| Some((*pixel, *normal, found(*pixel)?))).collect();
            let wrong: Vec<_> = both.iter().filter(|(_, normal, found)| normal.dot(*found) < SAME).collect();
            let (pixel, normal, found) = wrong.first()?;
            let is_off = both.len() >= LEAST && wrong.len() as f64 > MOST_SHARE * both.len() as f64;
            is_off.then(|| {
                format!(
                    "{} of {} normals are not those of the surfaces that the depths make; the first, pixel {pixel}, is {found:.2}, by depth \
                     {normal:.2}",
                    wrong.len(),
                    both.len()
                )
            })
        })
    }
}
