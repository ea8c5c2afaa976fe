//! Trees, cars, lamps and everything else that stands in a street.

use super::light::Light;
use super::pattern::{NoiseTexture, band, draw, hash, smoothstep, stripes, unit};
use super::surface::{Look, SurfacePoint};
use cosfly_maps::ObstacleKind;
use glam::Vec3A as Vec3;

/// Car paints, linear RGB.
const PAINTS: [Vec3; 8] = [
    Vec3::new(0.55, 0.55, 0.57),
    Vec3::new(0.03, 0.03, 0.035),
    Vec3::new(0.68, 0.68, 0.66),
    Vec3::new(0.40, 0.03, 0.03),
    Vec3::new(0.03, 0.08, 0.28),
    Vec3::new(0.18, 0.19, 0.20),
    Vec3::new(0.05, 0.14, 0.10),
    Vec3::new(0.45, 0.38, 0.28),
];

/// The box a thing is made of, as its looks need it.
#[derive(Clone, Copy, Debug)]
pub struct BoxPlace {
    /// The point in the box's own axes from its middle, metres.
    pub local: Vec3,
    /// Half its size.
    pub half: Vec3,
    /// Seed of the thing.
    pub seed: u32,
    /// Outward axis of the face: 0 x, 1 y, 2 z.
    pub axis: usize,
    /// Middle and half size of the whole thing, metres.
    pub whole: [Vec3; 2],
}

/// The look of a box that is not a building.
#[inline(always)]
pub fn look(kind: ObstacleKind, point: &SurfacePoint, place: &BoxPlace, light: &Light, noise: &NoiseTexture) -> Look {
    match kind {
        ObstacleKind::TreeCrown | ObstacleKind::Bush => leaves(point, place, noise),
        ObstacleKind::TreeTrunk => bark(point, place, noise),
        ObstacleKind::Car => car(point, place, light),
        ObstacleKind::Lamp => lamp(point, place, light),
        ObstacleKind::TrafficLight => traffic_light(point, place),
        ObstacleKind::TrafficSign => sign(point, place),
        ObstacleKind::Fence | ObstacleKind::GuardRail => fence(point, place),
        ObstacleKind::Wall | ObstacleKind::Bridge | ObstacleKind::Building => stone(point, place, noise),
        ObstacleKind::Pole => metal(point, Vec3::splat(0.22)),
        ObstacleKind::Static => furniture(point, place, noise),
    }
}

/// Two coordinates on the face: horizontal and vertical (x and y on top).
#[inline(always)]
fn on_face(place: &BoxPlace) -> [f32; 2] {
    match place.axis {
        0 => [place.local.y, place.local.z],
        1 => [place.local.x, place.local.z],
        _ => [place.local.x, place.local.y],
    }
}

/// Leaves: clumps of light and dark, and normals that swell around the whole crown's middle.
fn leaves(point: &SurfacePoint, place: &BoxPlace, noise: &NoiseTexture) -> Look {
    let [u, v] = on_face(place);
    let (u, v) = (u + 37.0 * unit(place.seed) + 3.0 * place.axis as f32, v + 11.0 * place.axis as f32);
    let size = point.footprint_m;
    let big = noise.clumps(u * 14.0, v * 14.0, size * 14.0) - 0.5;
    let small = noise.grain(u * 17.0, v * 17.0, size * 17.0) - 0.5;
    let slope_u = noise.clumps(u * 14.0 + 4.0, v * 14.0, size * 14.0) - 0.5 - big;
    let slope_v = noise.clumps(u * 14.0, v * 14.0 + 4.0, size * 14.0) - 0.5 - big;
    let [middle, half] = place.whole;
    let out = (point.world - middle) / half.max(Vec3::splat(0.1));
    let round = out.normalize_or_zero() * 0.9 + point.normal * 0.2;
    let bent = round + Vec3::new(slope_u, slope_v, slope_u - slope_v) * 2.2;
    let deep = smoothstep(-0.22, 0.30, big + 0.6 * small);
    let hue = draw(place.seed, 1);
    let green = Vec3::new(0.060, 0.135, 0.030).lerp(Vec3::new(0.120, 0.155, 0.036), hue);
    let tint = green.lerp(Vec3::new(0.20, 0.24, 0.07), 0.35 * (small + 0.5) * deep);
    let normal = bent.normalize_or(point.normal);
    // Darker below, and in the hollows between a crown's boxes.
    let hollow = smoothstep(0.45, 0.95, out.length());
    let shade = (0.75 + 0.25 * smoothstep(-1.0, 0.9, out.z)) * (0.6 + 0.4 * hollow);
    Look {
        openness: (0.85 + 0.45 * deep) * shade,
        ..Look::matt(tint * ((0.42 + 1.0 * deep) * (0.5 + 0.5 * shade)), normal)
    }
}

fn bark(point: &SurfacePoint, place: &BoxPlace, noise: &NoiseTexture) -> Look {
    let [u, v] = on_face(place);
    let furrow = noise.clumps(u * 60.0 + 9.0 * unit(place.seed), v * 9.0, point.footprint_m * 30.0);
    Look::matt(Vec3::new(0.115, 0.082, 0.055) * (0.45 + 1.0 * furrow), point.normal)
}

fn car(point: &SurfacePoint, place: &BoxPlace, light: &Light) -> Look {
    let paint = PAINTS[(draw(place.seed, 2) * PAINTS.len() as f32) as usize % PAINTS.len()];
    let long = if place.half.x >= place.half.y { 0 } else { 1 };
    let (along, half_length) = if long == 0 { (place.local.x, place.half.x) } else { (place.local.y, place.half.y) };
    let t = along / half_length.max(0.1);
    let up = (place.local.z + place.half.z) / (2.0 * place.half.z).max(0.1);
    let size = point.footprint_m;
    let (dt, du) = (size / half_length.max(0.1), size / (2.0 * place.half.z).max(0.1));
    let glass = if place.axis == 2 {
        band(t, -0.78, -0.62, dt) + band(t, 0.10, 0.34, dt)
    } else if place.axis == long {
        band(up, 0.60, 0.90, du)
    } else {
        band(up, 0.60, 0.90, du) * band(t, -0.72, 0.36, dt) * (1.0 - band(t, -0.18, -0.14, dt))
    };
    let mut look = Look { mirror: 0.16, ..Look::matt(paint, point.normal) };
    look.albedo = look.albedo.lerp(Vec3::splat(0.02), glass);
    look.mirror += 0.3 * glass;
    if place.axis != 2 {
        let dark = band(up, 0.0, 0.16, du);
        look.albedo = look.albedo.lerp(Vec3::splat(0.012), dark);
        if place.axis != long {
            let radius = 0.21;
            for wheel in [-0.62f32, 0.62] {
                let dx = (t - wheel) * half_length / (2.0 * place.half.z).max(0.1);
                let away = (dx * dx + (up - radius) * (up - radius)).sqrt();
                look.albedo = look.albedo.lerp(Vec3::splat(0.010), 1.0 - smoothstep(radius - du, radius + du, away));
                look.albedo = look.albedo.lerp(Vec3::splat(0.25), 1.0 - smoothstep(0.1 - du, 0.1 + du, away));
            }
        } else {
            let half_width = if long == 0 { place.half.y } else { place.half.x };
            let aside = if long == 0 { place.local.y } else { place.local.x };
            let corner = band(aside.abs(), 0.62 * half_width, 0.95 * half_width, size);
            let lamps = band(up, 0.38, 0.52, du) * corner;
            let colour = if t > 0.0 { Vec3::splat(0.7) } else { Vec3::new(0.45, 0.02, 0.02) };
            look.albedo = look.albedo.lerp(colour, lamps);
            look.emission = colour * (0.02 * light.night * lamps);
        }
    }
    look
}

fn lamp(point: &SurfacePoint, place: &BoxPlace, light: &Light) -> Look {
    let mut look = metal(point, Vec3::new(0.09, 0.10, 0.10));
    // The head: a flat box, or the top end of a mast drawn as one box.
    let flat = place.half.z < 0.6 * place.half.x.max(place.half.y);
    let head = if flat { 1.0 } else { smoothstep(0.25, 0.2, place.half.z - place.local.z) };
    look.emission = Vec3::new(1.0, 0.78, 0.45) * (0.9 * head * light.night);
    look.albedo = look.albedo.lerp(Vec3::splat(0.5), 0.6 * head);
    look
}

fn traffic_light(point: &SurfacePoint, place: &BoxPlace) -> Look {
    let mut look = metal(point, Vec3::new(0.06, 0.065, 0.06));
    let up = place.local.z / place.half.z.max(0.05);
    if place.half.z < 1.0 && place.axis != 2 {
        let lit = (draw(place.seed, 3) * 3.0) as usize % 3;
        let colours = [Vec3::new(0.9, 0.05, 0.03), Vec3::new(0.9, 0.5, 0.03), Vec3::new(0.03, 0.8, 0.25)];
        let center = [0.62, 0.0, -0.62][lit];
        look.emission = colours[lit] * (0.5 * band(up, center - 0.2, center + 0.2, 0.1));
    }
    look
}

fn sign(point: &SurfacePoint, place: &BoxPlace) -> Look {
    let [u, v] = on_face(place);
    let half = if place.axis == 0 { place.half.y } else { place.half.x };
    let edge = (half - u.abs()).min(place.half.z - v.abs());
    let colours = [Vec3::new(0.02, 0.12, 0.45), Vec3::new(0.55, 0.03, 0.03), Vec3::new(0.65, 0.45, 0.02)];
    let face = colours[(draw(place.seed, 4) * 3.0) as usize % 3];
    Look::matt(face.lerp(Vec3::splat(0.75), 1.0 - smoothstep(0.03, 0.06, edge)), point.normal)
}

fn fence(point: &SurfacePoint, place: &BoxPlace) -> Look {
    let [u, _] = on_face(place);
    let bars = stripes(u / 0.14, 0.0, 0.4, point.footprints_m[0] / 0.14);
    Look::matt(Vec3::new(0.10, 0.11, 0.115).lerp(Vec3::splat(0.35), bars), point.normal)
}

fn stone(point: &SurfacePoint, place: &BoxPlace, noise: &NoiseTexture) -> Look {
    let [u, v] = on_face(place);
    let size = point.footprint_m;
    let stain = noise.clumps(u * 3.0, v * 3.0, size * 3.0);
    let grain = noise.grain(u * 20.0, v * 20.0, size * 20.0);
    let joint = stripes(v / 0.4, 0.0, 0.06, point.footprints_m[1] / 0.4);
    let tone = Vec3::new(0.36, 0.33, 0.29) * (0.8 + 0.4 * draw(place.seed, 5));
    Look::matt(tone * ((0.66 + 0.35 * stain + 0.3 * grain) * (1.0 - 0.3 * joint)), point.normal)
}

fn furniture(point: &SurfacePoint, place: &BoxPlace, noise: &NoiseTexture) -> Look {
    let [u, v] = on_face(place);
    let wood = Vec3::new(0.24, 0.14, 0.07);
    let paint = [wood, Vec3::new(0.06, 0.16, 0.09), Vec3::splat(0.20)][(draw(place.seed, 6) * 3.0) as usize % 3];
    let plank = stripes(v / 0.12, 0.0, 0.12, point.footprints_m[1] / 0.12);
    let streak = noise.clumps(u * 8.0 + unit(hash(place.seed, 8)) * 50.0, v * 40.0, point.footprint_m * 20.0);
    Look::matt(paint * ((0.7 + 0.5 * streak) * (1.0 - 0.5 * plank)), point.normal)
}

fn metal(point: &SurfacePoint, albedo: Vec3) -> Look {
    Look { mirror: 0.08, ..Look::matt(albedo, point.normal) }
}
