//! Windows of a facade: panes behind the wall, frames, curtains, light at night.

use super::box_face::{BoxFace, Slant};
use super::draws;
use super::wall::Facade;
use crate::pattern::{floor_int, hash, most, one_if, smoothstep, stripes, unit};
use crate::surface::{Look, SurfacePoint};
use crate::vector::Vec3;

const GLASS: Vec3 = Vec3::new(0.035, 0.045, 0.055);

impl Facade {
    /// Share of glass at a point, and 1 where the window there is lit at night.
    #[inline(always)]
    pub fn pane(&self, place: &BoxFace, point: &SurfacePoint) -> (f32, f32) {
        let bay = place.along_m(point) * self.bays_per_m;
        let floor = (point.world.z - place.foot_m) * self.floors_per_m;
        let (du, dv) = (point.footprints_m[0] * self.bays_per_m, point.footprints_m[1] * self.floors_per_m);
        let glass = stripes(bay, self.window[0], self.window[1], du) * stripes(floor, self.sill[0], self.sill[1], dv);
        let cell = hash(floor_int(bay) as u32, floor_int(floor) as u32 ^ self.seed);
        (glass, one_if(unit(hash(cell, draws::LIT)) < 0.30))
    }

    /// A window in an opening of the wall: the pane lies deeper than the wall, within a frame.
    #[inline(always)]
    pub(super) fn window(
        &self,
        look: &Look,
        opening: f32,
        point: &SurfacePoint,
        [along_m, up_m]: [f32; 2],
        view: Slant,
        night: Option<f32>,
    ) -> Look {
        let (bay, floor) = (along_m * self.bays_per_m, up_m * self.floors_per_m);
        let (du, dv) = (point.footprints_m[0] * self.bays_per_m, point.footprints_m[1] * self.floors_per_m);
        let (deep_along, deep_up) = (self.reveal_m * view.along, self.reveal_m * view.up);
        let (deep_bay, deep_floor) = (bay + deep_along * self.bays_per_m, floor + deep_up * self.floors_per_m);
        let pane = opening
            * stripes(deep_bay, self.window[0] + 0.02, self.window[1] - 0.02, du)
            * stripes(deep_floor, self.sill[0] + 0.02, self.sill[1] - 0.02, dv);
        let frame = most(opening - pane, 0.0);
        let mullion = self.mullions * stripes(deep_bay, 0.488, 0.512, du);
        let mut look = Look { albedo: look.albedo.lerp(self.trim * 0.82, frame), ..*look };
        let cell = hash(floor_int(deep_bay) as u32, floor_int(floor) as u32 ^ self.seed);
        let glass = pane * (1.0 - 0.8 * mullion);
        // Blinds and curtains hang from the lintel down to a height of their own.
        let height = (deep_floor - floor_int(deep_floor) as f32 - self.sill[0]) / (self.sill[1] - self.sill[0]);
        let hangs = 1.15 * unit(hash(cell, draws::BLIND)) + 0.25;
        let cloth = smoothstep(1.0 - hangs, 1.03 - hangs + dv, height);
        self.glaze(&mut look, (glass, cloth), cell, smoothstep(0.35, 0.9, du), night);
        look
    }

    /// The share of sunlight that lintels and jambs let through to an opening.
    #[inline(always)]
    pub(super) fn lit(
        &self,
        point: &SurfacePoint,
        opening: f32,
        [along_m, up_m]: [f32; 2],
        [view, sun]: [Slant; 2],
    ) -> f32 {
        let (bay, floor) = (along_m * self.bays_per_m, up_m * self.floors_per_m);
        let (du, dv) = (point.footprints_m[0] * self.bays_per_m, point.footprints_m[1] * self.floors_per_m);
        let (across, up) = (self.reveal_m * (view.along + sun.along), self.reveal_m * (view.up + sun.up));
        let open = stripes(bay + across * self.bays_per_m, self.window[0], self.window[1], du)
            * stripes(floor + up * self.floors_per_m, self.sill[0], self.sill[1], dv);
        1.0 - opening * (1.0 - open)
    }

    /// Puts glass of a window over a share of the pixel, with `cloth` behind it where it has any; `mean` 1 where windows are too
    /// small to tell apart.
    #[inline(always)]
    pub(super) fn glaze(&self, look: &mut Look, (share, cloth): (f32, f32), cell: u32, mean: f32, night: Option<f32>) {
        let (curtains, pane) = (unit(hash(cell, draws::CURTAINS)), unit(hash(cell, draws::PANE)));
        let drawn = one_if(curtains > 0.5) * cloth;
        // Rooms are dark to a different degree; cloth is white to sand.
        let room = GLASS * (0.45 + 1.5 * pane * pane);
        let colour = Vec3::splat(0.52).lerp(Vec3::new(0.30, 0.25, 0.18), pane) * (self.clear * (1.3 * curtains - 0.45));
        let inside = room.lerp(colour, drawn);
        let inside = inside.lerp(Vec3::new(0.09, 0.09, 0.085), mean);
        look.albedo = look.albedo.lerp(inside, share);
        // Panes lean a little: each mirrors another part of the sky.
        look.mirror = share * self.gloss * (1.0 + self.uneven * (pane - 0.5) * (1.0 - mean));
        if let Some(night) = night {
            let lit = unit(hash(cell, draws::LIT));
            let one = one_if(lit < 0.30) * (0.12 + 1.3 * lit);
            let strength = one + (0.09 - one) * mean;
            let warm =
                Vec3::new(1.0, 0.62, 0.26).lerp(Vec3::new(0.80, 0.85, 0.95), unit(hash(cell, draws::WARMTH)) * 0.45);
            look.emission = warm * (strength * share * 0.34 * night);
        }
    }
}
