//! The look of a facade, sixteen pixels at a time: step by step over all of them, so that each step is one loop over lanes.

use super::box_face::{BoxFace, Slant, slant};
use super::wall::{Facade, GRAIN_PER_M};
use crate::lanes::{Block, PixelLane, Shared, WIDE, get, groups, set};
use crate::light::Light;
use crate::pattern::{NoiseLevels, NoiseTexture, lerp, most, one_if, share};
use crate::surface::SurfacePoint;
use crate::vector::Vec3;
use cosfly_frames::simd_kernel;

/// Shadows within windows fade until pixels are as large as this, metres.
const FINE_M: f32 = 0.2;
/// Balconies fade until pixels are as large as this, metres.
const COARSE_M: f32 = 0.8;

simd_kernel! {
    /// The look of a facade.
    pub fn facade(
        shared: &[Shared],
        blocks: &mut [Block],
        facade: &Facade,
        place: &BoxFace,
        light: &Light,
        noise: &NoiseTexture,
    ) {
        let (facade, place, night, to_sun) = (*facade, *place, light.night, light.to_sun);
        if night > 0.0 {
            facade.paint_all(shared, blocks, &place, (Some(night), to_sun), noise);
        } else {
            facade.paint_all(shared, blocks, &place, (None, to_sun), noise);
        }
    }
}

/// Values that the blocks of a group share.
struct Group<'a> {
    facade: &'a Facade,
    place: &'a BoxFace,
    shared: &'a Shared,
    night: Option<f32>,
    /// Slants of lines of sight and of sunlight.
    views: [PixelLane; 2],
    suns: [PixelLane; 2],
    /// Strength of shadows within windows, and of balconies.
    fine: PixelLane,
    coarse: PixelLane,
    any_fine: u32,
    any_coarse: u32,
    /// Light that dirt leaves.
    dirt: PixelLane,
}

impl Facade {
    #[inline(always)]
    fn paint_all(
        &self,
        shared: &[Shared],
        blocks: &mut [Block],
        place: &BoxFace,
        (night, to_sun): (Option<f32>, Vec3),
        noise: &NoiseTexture,
    ) {
        let sunny = shared.first().is_some_and(|shared| get(&shared.normal, 0).dot(to_sun) > 0.0);
        for (shared, four) in groups(shared, blocks) {
            let group = Group::new(self, place, shared, (night, to_sun), noise);
            let fine_grain = NoiseLevels::of(&shared.footprint_m, GRAIN_PER_M);
            for block in four {
                let (mut in_street, mut at_ends) = (0u32, 0u32);
                let mut grain = [0.0f32; WIDE];
                for (k, grain) in grain.iter_mut().enumerate() {
                    let point = block.point(shared, k);
                    let up_m = point.world.z - place.foot_m;
                    *grain = self.grain(place.along_m(&point), up_m, fine_grain.at(k), noise);
                    in_street |= u32::from(up_m < self.floor_m);
                    at_ends |= u32::from(!self.is_middle(&point, up_m));
                }
                let courses = group.courses(block);
                group.put_wall(block, [&grain, &courses], at_ends != 0);
                let opens = group.put_openings(block);
                // Between two rows of windows there are none.
                if opens != 0 {
                    group.put_windows(block);
                }
                let mut is_lit = 0u32;
                for lit in block.sunlight {
                    is_lit |= u32::from(lit > 0.0);
                }
                if opens & is_lit & group.any_fine != 0 && sunny {
                    group.shade_openings(block);
                }
                if self.shops && in_street != 0 {
                    group.put_shops(block, [&grain, &courses]);
                }
                if self.has_doors && !self.shops && in_street != 0 {
                    group.put_entrances(block);
                }
                if self.balconies > 0.0 && group.any_coarse != 0 {
                    group.put_balconies(block);
                }
            }
        }
    }
}

impl<'a> Group<'a> {
    #[inline(always)]
    fn new(
        facade: &'a Facade,
        place: &'a BoxFace,
        shared: &'a Shared,
        (night, to_sun): (Option<f32>, Vec3),
        noise: &NoiseTexture,
    ) -> Self {
        let mut views = [[0.0f32; WIDE]; 2];
        let mut suns = [[0.0f32; WIDE]; 2];
        let (mut fine, mut coarse) = ([0.0f32; WIDE], [0.0f32; WIDE]);
        let (mut any_fine, mut any_coarse) = (0u32, 0u32);
        for ((fine, coarse), pixel_m) in fine.iter_mut().zip(&mut coarse).zip(shared.footprint_m) {
            (*fine, *coarse) = (fade(pixel_m, FINE_M), fade(pixel_m, COARSE_M));
            any_fine |= u32::from(*fine > 0.0);
            any_coarse |= u32::from(*coarse > 0.0);
        }
        let mut dirt = [1.0f32; WIDE];
        for (k, dirt) in dirt.iter_mut().enumerate() {
            let middle = shared.point(k);
            *dirt = facade.dirt(&middle, [place.along_m(&middle), middle.world.z - place.foot_m], noise);
            let (ray, normal) = (get(&shared.ray, k), get(&shared.normal, k));
            let deep = 1.0 / most(-ray.dot(normal), 0.2 * ray.dot(ray).sqrt());
            (views[0][k], views[1][k]) = (ray.dot(place.along) * deep, ray.z * deep);
            let out = 1.0 / most(to_sun.dot(normal), 0.2);
            (suns[0][k], suns[1][k]) = (to_sun.dot(place.along) * out, to_sun.z * out);
        }
        Self { facade, place, shared, night, views, suns, fine, coarse, any_fine, any_coarse, dirt }
    }

    /// A point of a block, and its place on the face: along and up from its edge and foot, metres.
    #[inline(always)]
    fn point(&self, block: &Block, k: usize) -> (SurfacePoint, [f32; 2]) {
        let point = block.point(self.shared, k);
        let at = [self.place.along_m(&point), point.world.z - self.place.foot_m];
        (point, at)
    }

    /// Slants of the line of sight and of sunlight at pixel `k`.
    #[inline(always)]
    fn slants(&self, k: usize) -> [Slant; 2] {
        [slant(&self.views, k), slant(&self.suns, k)]
    }

    /// Light that joints between bricks leave.
    #[inline(always)]
    fn courses(&self, block: &Block) -> PixelLane {
        let mut courses = [1.0f32; WIDE];
        if self.facade.brick > 0.0 {
            for (k, courses) in courses.iter_mut().enumerate() {
                let (point, [_, up_m]) = self.point(block, k);
                *courses = self.facade.courses(&point, up_m);
            }
        }
        courses
    }

    /// The bare wall.
    #[inline(always)]
    fn put_wall(&self, block: &mut Block, [grain, courses]: [&PixelLane; 2], is_at_ends: bool) {
        let dirt = &self.dirt;
        if is_at_ends {
            for k in 0..WIDE {
                let (point, [_, up_m]) = self.point(block, k);
                set(&mut block.albedo, k, self.facade.wall_at(&point, up_m, grain[k], dirt[k], courses[k]));
            }
        } else {
            for k in 0..WIDE {
                set(&mut block.albedo, k, self.facade.plaster(grain[k], 1.0, dirt[k], courses[k]));
            }
        }
    }

    /// Ledges, joints and the share of openings; not 0 where there is any opening.
    #[inline(always)]
    fn put_openings(&self, block: &mut Block) -> u32 {
        let mut opens = 0u32;
        for k in 0..WIDE {
            let (point, at) = self.point(block, k);
            let (look, opening) = self.facade.wall_and_opening(&point, at, get(&block.albedo, k));
            block.put(k, &look);
            block.openness[k] = opening;
            opens |= u32::from(opening > 0.0);
        }
        opens
    }

    #[inline(always)]
    fn put_windows(&self, block: &mut Block) {
        for k in 0..WIDE {
            let (point, at) = self.point(block, k);
            let [view, _] = self.slants(k);
            let look = self.facade.window(&block.look(k), block.openness[k], &point, at, view, self.night);
            block.put(k, &look);
        }
    }

    /// Shadows of lintels and jambs.
    #[inline(always)]
    fn shade_openings(&self, block: &mut Block) {
        for (k, fine) in self.fine.iter().enumerate() {
            let (point, at) = self.point(block, k);
            let opening = fine * block.openness[k];
            block.sunlight[k] *= self.facade.lit(&point, opening, at, self.slants(k));
        }
    }

    #[inline(always)]
    fn put_shops(&self, block: &mut Block, [grain, courses]: [&PixelLane; 2]) {
        for k in 0..WIDE {
            let (point, [along_m, up_m]) = self.point(block, k);
            let [view, _] = self.slants(k);
            let shop = self.facade.shop(&point, along_m, up_m, view, self.night, [grain[k], courses[k]]);
            let look = block.look(k).lerp(&shop, one_if(up_m < self.facade.floor_m));
            block.put(k, &look);
        }
    }

    #[inline(always)]
    fn put_entrances(&self, block: &mut Block) {
        for k in 0..WIDE {
            let (point, [along_m, up_m]) = self.point(block, k);
            let door = self.facade.entrance(block.look(k), &point, along_m, up_m);
            let look = block.look(k).lerp(&door, one_if(up_m < self.facade.floor_m));
            block.put(k, &look);
        }
    }

    #[inline(always)]
    fn put_balconies(&self, block: &mut Block) {
        let mut any = 0u32;
        for k in 0..WIDE {
            let (_, at) = self.point(block, k);
            let [view, sun] = self.slants(k);
            any |= u32::from(self.facade.near_balcony(at, view, sun));
        }
        if any == 0 {
            return;
        }
        for (k, coarse) in self.coarse.iter().enumerate() {
            let (point, at) = self.point(block, k);
            let bare = block.look(k);
            let (look, lit) = self.facade.balcony(&bare, &point, at, self.slants(k));
            block.put(k, &bare.lerp(&look, *coarse));
            block.sunlight[k] *= lerp(1.0, lit, *coarse);
        }
    }
}

/// 1 where pixels are much smaller than a size, 0 from there on, metres.
#[inline(always)]
fn fade(pixel_m: f32, size_m: f32) -> f32 {
    share((1.0 - pixel_m * (1.0 / size_m)) * 4.0)
}
