//! Trunks, cars, lamps and everything else that stands in a street.

use super::parts::SceneBox;
use super::pattern::{NoiseTexture, Noises, band, hash, least, most, smoothstep, stripes, unit};
use super::surface::{Look, SurfacePoint};
use super::thing_form::ThingForm;
use super::thing_tints::{FRUIT, tint_of};
use super::vector::Vec3;
use cosfly_domain::ObstacleKind;

/// Half the longer side of the widest crate; awnings are longer, metres.
const WIDEST_CRATE_M: f32 = 0.78;

/// The box a thing is made of, and one of its faces.
#[derive(Clone, Copy, Debug)]
pub struct BoxThing {
    /// Kind.
    pub kind: ObstacleKind,
    /// What the part is, where its kind does not say.
    pub form: ThingForm,
    /// The box's middle, metres.
    pub center: Vec3,
    /// Horizontal axes.
    pub axes: [Vec3; 2],
    /// Half its size.
    pub half: Vec3,
    /// Seed of the thing.
    pub seed: u32,
    /// Outward axis of the face: 0 x, 1 y, 2 z.
    pub axis: usize,
    /// 0 by day, 1 at night.
    pub night: f32,
    /// Colour, drawn from the seed.
    pub(crate) tint: Vec3,
    /// Which of several looks it has, drawn from the seed.
    pub(crate) choice: usize,
}

/// A point in the box's own axes from its middle, and on the face: horizontal and vertical (x and y on top), metres.
#[derive(Clone, Copy)]
pub(crate) struct Place {
    pub local: Vec3,
    pub u: f32,
    pub v: f32,
}

impl BoxThing {
    /// A face of a box.
    pub fn of(b: &SceneBox, axis: usize, night: f32) -> Self {
        let center: Vec3 = b.center_in_world.into();
        let half = Vec3::new(b.half_extents_m.x, b.half_extents_m.y, b.half_extents_m.z);
        let (tint, choice) = tint_of((b.kind, b.thing), b.seed, center);
        let axes = b.axes_in_world.map(Vec3::from);
        Self { kind: b.kind, form: b.thing, center, axes, half, seed: b.seed, axis, night, tint, choice }
    }

    /// Colour without patterns.
    pub fn colour(&self) -> Vec3 {
        match self.kind {
            _ if self.form != ThingForm::Plain => self.tint,
            ObstacleKind::TreeTrunk => Vec3::new(0.115, 0.082, 0.055),
            ObstacleKind::Lamp => Vec3::splat(0.2),
            _ => self.tint,
        }
    }

    /// The face's place under a point.
    #[inline(always)]
    pub(crate) fn place<const AXIS: usize>(&self, point: &SurfacePoint) -> Place {
        let away = point.world - self.center;
        let local = Vec3::new(away.dot(self.axes[0]), away.dot(self.axes[1]), away.z);
        let (u, v) = match AXIS {
            0 => (local.y, local.z),
            1 => (local.x, local.z),
            _ => (local.x, local.y),
        };
        Place { local, u, v }
    }

    #[inline(always)]
    pub(crate) fn bark(&self, point: &SurfacePoint, at: &Place, noise: &NoiseTexture) -> Look {
        let (u, v) = (at.u, at.v);
        let furrow = noise.clumps(u * 60.0 + 9.0 * unit(self.seed), v * 9.0, point.footprint_m * 30.0);
        Look::matt(Vec3::new(0.115, 0.082, 0.055) * (0.45 + 1.0 * furrow), point.normal)
    }

    #[inline(always)]
    pub(crate) fn car<const AXIS: usize>(&self, point: &SurfacePoint, at: &Place) -> Look {
        let long = if self.half.x >= self.half.y { 0 } else { 1 };
        let (along, half_length) = if long == 0 { (at.local.x, self.half.x) } else { (at.local.y, self.half.y) };
        let t = along / half_length.max(0.1);
        let up = (at.local.z + self.half.z) / (2.0 * self.half.z).max(0.1);
        let size = point.footprint_m;
        let (dt, du) = (size / half_length.max(0.1), size / (2.0 * self.half.z).max(0.1));
        let glass = if AXIS == 2 {
            band(t, -0.78, -0.62, dt) + band(t, 0.10, 0.34, dt)
        } else if AXIS == long {
            band(up, 0.60, 0.90, du)
        } else {
            band(up, 0.60, 0.90, du) * band(t, -0.72, 0.36, dt) * (1.0 - band(t, -0.18, -0.14, dt))
        };
        let mut look = Look { mirror: 0.16, ..Look::matt(self.tint, point.normal) };
        look.albedo = look.albedo.lerp(Vec3::splat(0.02), glass);
        look.mirror += 0.3 * glass;
        if AXIS != 2 {
            let dark = band(up, 0.0, 0.16, du);
            look.albedo = look.albedo.lerp(Vec3::splat(0.012), dark);
            if AXIS != long {
                let radius = 0.21;
                for wheel in [-0.62f32, 0.62] {
                    let dx = (t - wheel) * half_length / (2.0 * self.half.z).max(0.1);
                    let away = (dx * dx + (up - radius) * (up - radius)).sqrt();
                    look.albedo =
                        look.albedo.lerp(Vec3::splat(0.010), 1.0 - smoothstep(radius - du, radius + du, away));
                    look.albedo = look.albedo.lerp(Vec3::splat(0.25), 1.0 - smoothstep(0.1 - du, 0.1 + du, away));
                }
            } else {
                let half_width = if long == 0 { self.half.y } else { self.half.x };
                let aside = if long == 0 { at.local.y } else { at.local.x };
                let corner = band(aside.abs(), 0.62 * half_width, 0.95 * half_width, size);
                let lamps = band(up, 0.38, 0.52, du) * corner;
                let colour = if t > 0.0 { Vec3::splat(0.7) } else { Vec3::new(0.45, 0.02, 0.02) };
                look.albedo = look.albedo.lerp(colour, lamps);
                look.emission = colour * (0.02 * self.night * lamps);
            }
        }
        look
    }

    #[inline(always)]
    pub(crate) fn lamp(&self, point: &SurfacePoint, at: &Place) -> Look {
        let mut look = metal(point, Vec3::new(0.09, 0.10, 0.10));
        // The head: a flat box, or the top end of a mast drawn as one box.
        let flat = self.half.z < 0.6 * self.half.x.max(self.half.y);
        let head = if flat { 1.0 } else { smoothstep(0.25, 0.2, self.half.z - at.local.z) };
        look.emission = self.tint * (0.9 * head * self.night);
        look.albedo = look.albedo.lerp(Vec3::splat(0.5), 0.6 * head);
        look
    }

    #[inline(always)]
    pub(crate) fn traffic_light<const AXIS: usize>(&self, point: &SurfacePoint, at: &Place) -> Look {
        let mut look = metal(point, Vec3::new(0.06, 0.065, 0.06));
        let up = at.local.z / self.half.z.max(0.05);
        if self.half.z < 1.0 && AXIS != 2 {
            let center = 0.62 - 0.62 * self.choice as f32;
            look.emission = self.tint * (0.5 * band(up, center - 0.2, center + 0.2, 0.1));
        }
        look
    }

    #[inline(always)]
    pub(crate) fn sign<const AXIS: usize>(&self, point: &SurfacePoint, at: &Place) -> Look {
        let (u, v) = (at.u, at.v);
        let half = if AXIS == 0 { self.half.y } else { self.half.x };
        let edge = least(half - u.abs(), self.half.z - v.abs());
        Look::matt(self.tint.lerp(Vec3::splat(0.75), 1.0 - smoothstep(0.03, 0.06, edge)), point.normal)
    }

    #[inline(always)]
    pub(crate) fn fence(&self, point: &SurfacePoint, at: &Place) -> Look {
        let u = at.u;
        let bars = stripes(u / 0.14, 0.0, 0.4, point.footprints_m[0] / 0.14);
        Look::matt(Vec3::new(0.10, 0.11, 0.115).lerp(Vec3::splat(0.35), bars), point.normal)
    }

    #[inline(always)]
    pub(crate) fn stone(&self, point: &SurfacePoint, at: &Place, noise: &NoiseTexture) -> Look {
        let (u, v) = (at.u, at.v);
        let size = point.footprint_m;
        let stain = noise.clumps(u * 3.0, v * 3.0, size * 3.0);
        let grain = noise.grain(u * 20.0, v * 20.0, size * 20.0);
        let joint = stripes(v / 0.4, 0.0, 0.06, point.footprints_m[1] / 0.4);
        Look::matt(self.tint * ((0.66 + 0.35 * stain + 0.3 * grain) * (1.0 - 0.3 * joint)), point.normal)
    }

    /// Stripes of an awning and of the cloth that hangs from it; crates full of fruit.
    #[inline(always)]
    pub(crate) fn stall(&self, point: &SurfacePoint, at: &Place, noise: &NoiseTexture) -> Look {
        let size = point.footprint_m;
        if most(self.half.x, self.half.y) > WIDEST_CRATE_M {
            let along = if self.half.x >= self.half.y { at.local.x } else { at.local.y };
            let stripe = stripes(along / 0.5, 0.0, 0.5, size / 0.5);
            let fold = noise.clumps(at.u * 2.5, at.v * 2.5, size * 2.5);
            return Look::matt(Vec3::splat(0.62).lerp(self.tint, stripe) * (0.86 + 0.2 * fold), point.normal);
        }
        let fruit = FRUIT[self.choice];
        let heap = noise.clumps(at.u * 9.0, at.v * 9.0, size * 9.0);
        Look::matt(fruit * (0.55 + 0.8 * heap), point.normal)
    }

    #[inline(always)]
    pub(crate) fn furniture(&self, point: &SurfacePoint, at: &Place, noise: &NoiseTexture) -> Look {
        let (u, v) = (at.u, at.v);
        let plank = stripes(v / 0.12, 0.0, 0.12, point.footprints_m[1] / 0.12);
        let streak = noise.clumps(u * 8.0 + unit(hash(self.seed, 8)) * 50.0, v * 40.0, point.footprint_m * 20.0);
        Look::matt(self.tint * ((0.7 + 0.5 * streak) * (1.0 - 0.5 * plank)), point.normal)
    }
}

#[inline(always)]
pub(crate) fn metal(point: &SurfacePoint, albedo: Vec3) -> Look {
    Look { mirror: 0.08, ..Look::matt(albedo, point.normal) }
}
