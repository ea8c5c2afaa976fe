//! Balconies of a facade, and the sunlight that they let through.

use super::box_face::Slant;
use super::wall::Facade;
use crate::pattern::{floor_int, hash, least, most, one_if, stripes, unit};
use crate::surface::{Look, SurfacePoint};
use crate::vector::Vec3;

/// Balconies stand out of the wall by this much, metres.
const BALCONY_M: f32 = 1.1;
/// Height of their rails, metres.
const RAIL_M: f32 = 1.0;

impl Facade {
    /// 1 where a column of balconies and a storey meet.
    #[inline(always)]
    fn has_balcony(&self, u: f32, floor: f32) -> f32 {
        let column = unit(hash(floor_int(u) as u32, self.seed ^ 0xba1c));
        one_if((column < self.balconies) & (floor > 1.0) & (floor < self.floors - 0.3))
    }

    /// Whether a balcony may be seen, or may take sunlight.
    #[inline(always)]
    pub(super) fn near_balcony(&self, [along_m, up_m]: [f32; 2], view: Slant, sun: Slant) -> bool {
        let (half, floor) = (0.5 * self.bays_per_m, up_m * self.floors_per_m);
        let (u, passed) = ((along_m - BALCONY_M * view.along) * half, (up_m - BALCONY_M * view.up) * self.floors_per_m);
        let shaded_u = (along_m + 0.6 * BALCONY_M * sun.along) * half;
        let has = self.has_balcony(u, passed) + self.has_balcony(along_m * half, floor);
        has + self.has_balcony(shaded_u, floor + 0.9) > 0.0
    }

    /// A balcony before a look, and the share of sunlight that balconies let through to it.
    #[inline(always)]
    pub(super) fn balcony(
        &self,
        look: &Look,
        point: &SurfacePoint,
        [along_m, up_m]: [f32; 2],
        [view, sun]: [Slant; 2],
    ) -> (Look, f32) {
        let half = 0.5 * self.bays_per_m;
        let (du, dv) = (point.footprints_m[0] * half, point.footprints_m[1] * self.floors_per_m);
        let rail = RAIL_M * self.floors_per_m;
        // Where the line of sight passes the rail.
        let (u, floor) = ((along_m - BALCONY_M * view.along) * half, (up_m - BALCONY_M * view.up) * self.floors_per_m);
        let front = self.has_balcony(u, floor) * stripes(u, 0.08, 0.92, du);
        let slab = front * stripes(floor, 0.0, 0.06, dv);
        let bars = front * stripes(floor, 0.0, rail, dv);
        // Between rail and wall one looks down on the floor of the balcony, or up at it.
        let depth = (up_m * self.floors_per_m - floor).abs();
        let inside =
            self.has_balcony(along_m * half, floor) * stripes(up_m * self.floors_per_m, 0.0, least(depth, 0.5), dv);
        let albedo = look.albedo.lerp(Vec3::splat(0.30), 0.8 * inside * front);
        let albedo = albedo.lerp(self.rail, 0.86 * bars).lerp(self.trim * 0.85, slab);
        let kept = (1.0 - 0.86 * bars) * (1.0 - slab);
        let emission = look.emission * kept;
        let drop = most(BALCONY_M * sun.up * self.floors_per_m, 0.0);
        let shaded_u = (along_m + 0.6 * BALCONY_M * sun.along) * half;
        let shadow = self.has_balcony(shaded_u, up_m * self.floors_per_m + 0.9)
            * stripes(shaded_u, 0.08, 0.92, du)
            * stripes(up_m * self.floors_per_m + drop, 0.0, least(most(drop, rail), 0.95), dv);
        let lit = 1.0 - 0.9 * shadow * (1.0 - most(bars, slab));
        (Look { albedo, emission, mirror: look.mirror * kept, ..*look }, lit)
    }
}
