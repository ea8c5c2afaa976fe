//! The published equations pixel by pixel, in double precision, without tiles, bounds or an early end: to compare with.

use crate::cloud::LEAST_ALPHA;
use crate::harmonics;
use crate::project::{LEAST_COMPENSATION, LOW_PASS_PX2};
use crate::splat::Splat;
use crate::tile::MOST_ALPHA;
use crate::view::{MOST_ASIDE, NEAR_M, SplatView};
use cosfly_frames::{DMat3, DVec3, real};

/// A pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExactPixel {
    /// Red, green, blue, times the share of the pixel that splats cover.
    pub colour: [f64; 3],
    /// Share of the light behind that comes through.
    pub transmittance: f64,
    /// Planar depth at which half of the light is gone, metres.
    pub depth_m: f64,
}

/// A splat on the screen.
struct Ellipse {
    place: [f64; 2],
    conic: [f64; 3],
    opacity: f64,
    colour: [f64; 3],
    depth_m: f64,
    slope: [f64; 2],
}

/// A picture of splats, row by row.
pub fn picture(splats: &[Splat], harmonics: usize, view: &SplatView) -> Vec<ExactPixel> {
    let mut seen: Vec<Ellipse> = splats.iter().filter_map(|splat| ellipse(splat, harmonics, view)).collect();
    seen.sort_by(|a, b| a.depth_m.total_cmp(&b.depth_m));
    let places = (0..view.height).flat_map(|row| (0..view.width).map(move |column| [column, row]));
    places.map(|place| pixel(&seen, place.map(|at| at as f64 + 0.5))).collect()
}

fn pixel(seen: &[Ellipse], at: [f64; 2]) -> ExactPixel {
    let mut pixel = ExactPixel { colour: [0.0; 3], transmittance: 1.0, depth_m: f64::INFINITY };
    for ellipse in seen {
        let [x, y] = [at[0] - ellipse.place[0], at[1] - ellipse.place[1]];
        let [a, b, c] = ellipse.conic;
        let profile = real::exp(-0.5 * (a * x * x + 2.0 * b * x * y + c * y * y));
        let alpha = (ellipse.opacity * profile).min(MOST_ALPHA.into());
        if alpha < LEAST_ALPHA.into() {
            continue;
        }
        let share = alpha * pixel.transmittance;
        let left = pixel.transmittance - share;
        pixel.colour.iter_mut().zip(ellipse.colour).for_each(|(sum, colour)| *sum += share * colour);
        if pixel.transmittance >= 0.5 && left < 0.5 {
            pixel.depth_m = ellipse.depth_m + ellipse.slope[0] * x + ellipse.slope[1] * y;
        }
        pixel.transmittance = left;
    }
    pixel
}

fn ellipse(splat: &Splat, harmonics: usize, view: &SplatView) -> Option<Ellipse> {
    let away = DVec3::from_array(splat.middle.map(f64::from)) - view.eye;
    let seen = view.camera_from_file * away;
    if seen.z <= NEAR_M {
        return None;
    }
    let [xx, xy, xz, yy, yz, zz] = splat.covariance();
    let covariance = DMat3::from_cols_array(&[xx, xy, xz, xy, yy, yz, xz, yz, zz]);
    let in_camera = view.camera_from_file * covariance * view.camera_from_file.transpose();
    let centre = view.centre_px();
    let most = centre.map(|half| MOST_ASIDE * half / view.focal_px);
    let scale = view.focal_px / seen.z;
    let held = [(seen.x / seen.z).clamp(-most[0], most[0]), (seen.y / seen.z).clamp(-most[1], most[1])];
    let across = scale * DVec3::new(1.0, 0.0, -held[0]);
    let along = scale * DVec3::new(0.0, 1.0, -held[1]);
    let (s, t) = (in_camera * across, in_camera * along);
    let (a, b, c) = (across.dot(s), across.dot(t), along.dot(t));
    let (wide, high) = (a + LOW_PASS_PX2, c + LOW_PASS_PX2);
    let det = wide * high - b * b;
    let kept = ((a * c - b * b) / det).max(LEAST_COMPENSATION).sqrt();
    let conic = [high / det, -b / det, wide / det];
    let basis = harmonics::double(away.normalize().to_array());
    let colour = [0, 1, 2].map(|channel| {
        let terms = splat.harmonics.iter().zip(basis).take(harmonics);
        terms.map(|(own, basis)| f64::from(own[channel]) * basis).sum::<f64>() + 0.5
    });
    Some(Ellipse {
        place: [centre[0] + scale * seen.x, centre[1] + scale * seen.y],
        conic,
        opacity: f64::from(splat.opacity) * if view.is_antialiased { kept } else { 1.0 },
        colour: colour.map(|value| value.max(0.0)),
        depth_m: seen.z,
        slope: [s.z * conic[0] + t.z * conic[1], s.z * conic[1] + t.z * conic[2]],
    })
}
