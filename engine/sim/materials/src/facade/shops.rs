//! The street floor of a facade: shop windows, doors, signs, awnings and entrances.

use super::box_face::Slant;
use super::draws;
use super::family::{MEAN_SIGN, SIGNS};
use super::wall::Facade;
use crate::pattern::{band, floor_int, hash, least, lerp, most, one_if, smoothstep, stripes, unit};
use crate::surface::{Look, SurfacePoint};
use crate::vector::Vec3;

/// Awnings stand out by this much, metres.
const AWNING_M: f32 = 1.0;
/// Pairs of stripes in a metre of an awning.
const STRIPES_PER_M: f32 = 3.6;

impl Facade {
    /// The street floor: shop windows, doors and a sign band.
    #[inline(always)]
    pub(super) fn shop(
        &self,
        point: &SurfacePoint,
        along_m: f32,
        up_m: f32,
        view: Slant,
        night: Option<f32>,
        [grain, courses]: [f32; 2],
    ) -> Look {
        let bay = along_m * self.bays_per_m;
        let (du, dv) = (point.footprints_m[0] * self.bays_per_m, point.footprints_m[1]);
        let wall = self.wall_at(point, up_m, grain, 1.0, courses);
        let top = self.floor_m;
        let third = bay * (1.0 / 3.0);
        let unit_number = floor_int(third);
        let shop = hash(unit_number as u32, self.seed ^ 0x5407);
        // At a slant a pixel spans several shops.
        let many = smoothstep(0.10, 0.45, du * (1.0 / 3.0));
        let sign = SIGNS[(shop >> 29) as usize & 7].lerp(MEAN_SIGN, many);
        let place = floor_int(bay).wrapping_sub(unit_number.wrapping_mul(3));
        let door = one_if(place == ((shop & 0xffff).wrapping_mul(3) >> 16) as i32);
        let door = lerp(door, 1.0 / 3.0, smoothstep(0.35, 0.9, du));
        let (left, right, low) = (lerp(0.06, 0.28, door), lerp(0.94, 0.72, door), lerp(0.45, 0.02, door));
        let across = stripes(bay, left, right, du);
        let glass = across * band(up_m, low, top - 1.05, dv);
        let sign_share = band(up_m, top - 0.85, top - 0.25, dv) * stripes(third, 0.02, 0.98, du * (1.0 / 3.0));
        let mut look = Look::matt(wall.lerp(sign, sign_share), point.normal);
        self.glaze(&mut look, (glass, 0.4), hash(shop, draws::SHOP_WINDOW), lerp(0.35, 1.0, many), night);
        look.albedo = look.albedo.lerp(sign * 0.5, 0.55 * glass * door);
        if let Some(night) = night {
            let open = lerp(one_if(unit(hash(shop, draws::OPEN)) < 0.6), 0.6, many) * night;
            look.emission += (sign * 1.2 + Vec3::splat(0.03)) * (sign_share * 0.12 * open)
                + Vec3::new(0.30, 0.21, 0.11) * (glass * (0.06 + 0.22 * unit(hash(shop, draws::GLOW))) * open);
        }
        // An awning: cloth that stands out, and glass in its shade.
        let has = lerp(one_if(unit(hash(shop, draws::AWNING)) < 0.4), 0.4, many);
        let (out_along, out_up) = (along_m - 0.5 * AWNING_M * view.along, up_m - 0.5 * AWNING_M * view.up);
        let out_third = out_along * (self.bays_per_m / 3.0);
        let width = stripes(out_third, 0.03, 0.97, du * (1.0 / 3.0));
        let cloth = has * width * band(out_up, top - 1.35, top - 0.85, dv);
        let pale = stripes(out_along * STRIPES_PER_M, 0.0, 0.5, point.footprints_m[0] * STRIPES_PER_M);
        look.albedo = look.albedo.lerp(sign.lerp(Vec3::splat(0.62), 0.85 * pale), cloth);
        (look.emission, look.mirror) = (look.emission * (1.0 - cloth), look.mirror * (1.0 - cloth));
        look
    }

    /// A house door among the windows of the street floor.
    #[inline(always)]
    pub(super) fn entrance(&self, look: Look, point: &SurfacePoint, along_m: f32, up_m: f32) -> Look {
        let bay = along_m * self.bays_per_m;
        let (du, dv) = (point.footprints_m[0] * self.bays_per_m, point.footprints_m[1]);
        let number = floor_int(bay) as u32;
        let is_sure = one_if(number as i32 == self.door_bay as i32);
        let [doors, half_m, high_m] = self.doors;
        let here = most(one_if(unit(hash(number, self.seed ^ 0xd005)) < doors), is_sure);
        let (wide, high) = (half_m * self.bays_per_m, least(high_m, self.floor_m - 0.4));
        let door = here * stripes(bay, 0.5 - wide, 0.5 + wide, du) * band(up_m, 0.08, high, dv);
        let framed = here * stripes(bay, 0.5 - 1.3 * wide, 0.5 + 1.3 * wide, du) * band(up_m, 0.0, high + 0.18, dv);
        let colour = self.door;
        let bare = Look { mirror: look.mirror * (1.0 - framed), ..look };
        Look { albedo: look.albedo.lerp(self.trim, framed).lerp(colour, door), ..bare }
    }
}
