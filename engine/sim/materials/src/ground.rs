//! Ground: asphalt, pavement slabs, road marks, grass, each from world coordinates.

use super::grass::lawns;
use super::grid::{GridFrame, GridTables};
use super::lanes::{Block, Shared, WIDE, get, groups, set};
use super::pattern::{
    NoiseLevel, NoiseLevels, NoiseTexture, Noises, band, floor_int, hash, lerp, most, smoothstep, stripes, unit,
};
use super::surface::{Look, SurfacePoint};
use super::vector::Vec3;
use cosfly_domain::SemanticLabel;
use cosfly_frames::simd_kernel;

/// Dull surfaces whose colour follows from the place. Not a function: closures are not always inlined, and only what is
/// inlined becomes vector code.
macro_rules! paint_all {
    ($shared:ident, $blocks:ident, $point:ident $(, $noise:ident at $per_m:expr)* => $albedo:expr) => {
        for (shared, four) in groups($shared, $blocks) {
            $(let $noise = NoiseLevels::of(&shared.footprint_m, $per_m);)*
            for block in four {
                for k in 0..WIDE {
                    $(let $noise = $noise.at(k);)*
                    let $point = block.point(shared, k);
                    let look = Look::matt($albedo, $point.normal);
                    block.put(k, &look);
                }
            }
        }
    };
}

/// Pixels painted where a pattern of wide patches is told once for the pixels of a four.
macro_rules! paint_patches {
    ($shared:ident, $blocks:ident, $middle:ident => $patches:expr,
     $point:ident, $patch:ident, $noise:ident at $per_m:expr => $albedo:expr) => {
        for (shared, four) in groups($shared, $blocks) {
            let $noise = NoiseLevels::of(&shared.footprint_m, $per_m);
            let mut patches = [0.0f32; WIDE];
            for k in 0..WIDE {
                let $middle = shared.point(k);
                patches[k] = $patches;
            }
            for block in four {
                for k in 0..WIDE {
                    let ($point, $patch, $noise) = (block.point(shared, k), patches[k], $noise.at(k));
                    let look = Look::matt($albedo, $point.normal);
                    block.put(k, &look);
                }
            }
        }
    };
}

/// Paints over blocks in which a condition holds for any four.
macro_rules! repaint_some {
    ($shared:ident, $blocks:ident, $middle:ident => $wanted:expr, $point:ident, $albedo:ident => $new:expr) => {
        for (shared, four) in groups($shared, $blocks) {
            let mut wanted = 0u32;
            for k in 0..WIDE {
                let $middle = shared.point(k);
                wanted |= u32::from($wanted);
            }
            if wanted != 0 {
                for block in four {
                    for k in 0..WIDE {
                        let ($point, $albedo) = (block.point(shared, k), get(&block.albedo, k));
                        set(&mut block.albedo, k, $new);
                    }
                }
            }
        }
    };
}

simd_kernel! {
    /// The look of ground with a label.
    pub fn ground(
        shared: &[Shared],
        blocks: &mut [Block],
        label: SemanticLabel,
        grid: (&GridTables, &GridFrame),
        lawn: [Vec3; 2],
        noise: &NoiseTexture,
    ) {
        let (tables, frame) = (grid.0, *grid.1);
        match label {
            SemanticLabel::Roads | SemanticLabel::Bridge => {
                paint_all!(shared, blocks, point, fine at 19.0, wide at 1.05 => {
                    asphalt(&point, [fine, wide], noise)
                });
                repaint_some!(shared, blocks, middle => to_manhole(middle.world.x, middle.world.y)
                    < 0.5 + 4.0 * middle.footprint_m, point, albedo => {
                    lid(&point, to_manhole(point.world.x, point.world.y), albedo)
                });
            }
            SemanticLabel::SideWalks => {
                paint_patches!(shared, blocks, middle => wear(&middle, noise), point, worn, fine at 15.0 => {
                    slabs(&point, worn, fine, noise)
                });
            }
            SemanticLabel::RoadLine => paint_all!(shared, blocks, point, worn at 9.0 => paint(&point, worn, noise)),
            SemanticLabel::Ground | SemanticLabel::Static | SemanticLabel::Other => {
                paint_patches!(shared, blocks, middle => stains(&middle, noise), point, stain, fine at 12.0 => {
                    gravel(&point, stain, fine, noise)
                });
            }
            SemanticLabel::Water => {
                paint_all!(shared, blocks, point => Vec3::new(0.02, 0.05, 0.06));
                for (shared, four) in groups(shared, blocks) {
                    for block in four {
                        for k in 0..WIDE {
                            let wave = waves(&block.point(shared, k), noise);
                            block.mirror[k] = 0.62 + 0.5 * wave;
                            block.sunlight[k] *= glitter(wave, shared.footprint_m[k]);
                        }
                    }
                }
            }
            _ => {
                lawns(shared, blocks, (tables, frame), lawn, noise);
            }
        }
    }
}

#[inline(always)]
fn asphalt(point: &SurfacePoint, [fine, wide]: [NoiseLevel; 2], noise: &NoiseTexture) -> Vec3 {
    let (x, y, size) = (point.world.x, point.world.y, point.footprint_m);
    let rough = noise.rough_at(x * 19.0, y * 19.0, fine);
    let wide = noise.clumps_at(x * 1.05 + 50.0, y * 1.05, wide);
    // Mended pieces and cracks: level sets of wide noise.
    let mended = 0.16 * smoothstep(0.63, 0.64 + 0.03 * size, wide) - 0.07 * smoothstep(0.40, 0.39 - 0.03 * size, wide);
    // Cracks fade where a pixel is long: lines thinner than a row of pixels would flicker.
    let long = most(point.footprints_m[0], point.footprints_m[1]);
    let crack = 0.30 * (1.0 - smoothstep(0.0, 0.004 + 0.04 * long, (wide - 0.52).abs())) * most(0.12 - long, 0.0) * 8.0;
    let tone = 0.125 * (0.62 + 0.62 * rough + 0.18 * wide) * (1.0 - mended) * (1.0 - crack);
    Vec3::new(tone, tone * 0.99, tone * 0.975)
}

/// Distance to the middle of the nearest manhole of a square of ground, metres; far where there is none.
#[inline(always)]
fn to_manhole(x: f32, y: f32) -> f32 {
    let (u, v) = (x * (1.0 / MANHOLE_M), y * (1.0 / MANHOLE_M));
    let cell = hash(floor_int(u) as u32, floor_int(v) as u32 ^ 0x3a7e);
    let (middle_u, middle_v) = (0.1 + 0.8 * unit(hash(cell, 1)), 0.1 + 0.8 * unit(hash(cell, 2)));
    let (dx, dy) = (u - floor_int(u) as f32 - middle_u, v - floor_int(v) as f32 - middle_v);
    (dx * dx + dy * dy).sqrt() * MANHOLE_M + if unit(cell) < 0.30 { 0.0 } else { FAR_M }
}

/// Asphalt with the lid of a manhole `away_m` from its middle.
#[inline(always)]
fn lid(point: &SurfacePoint, away_m: f32, asphalt: Vec3) -> Vec3 {
    let (x, y, size) = (point.world.x, point.world.y, point.footprint_m);
    let inside = band(away_m, -FAR_M, 0.34, size);
    let rim = band(away_m, 0.27, 0.34, size);
    let ribs = stripes(x * 12.0, 0.0, 0.5, size * 12.0) * stripes(y * 12.0, 0.0, 0.5, size * 12.0);
    asphalt.lerp(Vec3::splat(0.075) * (0.7 + 0.7 * ribs), inside).lerp(Vec3::splat(0.16), rim)
}

/// Side of the squares of ground that have at most one manhole, metres.
const MANHOLE_M: f32 = 13.0;
/// Farther away than any manhole of a square, metres.
const FAR_M: f32 = 99.0;

#[inline(always)]
fn wear(point: &SurfacePoint, noise: &NoiseTexture) -> f32 {
    noise.clumps(point.world.x * 1.9 + 70.0, point.world.y * 1.9, point.footprint_m * 1.9) - 0.5
}

#[inline(always)]
fn slabs(point: &SurfacePoint, worn: f32, fine: NoiseLevel, noise: &NoiseTexture) -> Vec3 {
    let (x, y, size) = (point.world.x, point.world.y, point.footprint_m);
    let footprints = point.footprints_m;
    const PER_M: f32 = 1.0 / 0.75;
    let (u, v) = (x * PER_M, y * PER_M);
    let (wu, wv) = (footprints[0] * PER_M, footprints[1] * PER_M);
    let joint = most(stripes(u, 0.0, 0.04, wu), stripes(v, 0.0, 0.04, wv));
    let near = 1.0 - smoothstep(0.25, 0.8, size * PER_M);
    let slab = unit(hash(super::pattern::floor_int(u) as u32, super::pattern::floor_int(v) as u32)) - 0.5;
    let rough = noise.rough_at(x * 15.0, y * 15.0, fine) - 0.5;
    let tone = 0.34 * (1.0 + 0.18 * slab * near + 0.42 * rough + 0.28 * worn) * (1.0 - 0.4 * joint);
    Vec3::new(tone, tone * 0.97, tone * 0.925)
}

#[inline(always)]
fn paint(point: &SurfacePoint, worn: NoiseLevel, noise: &NoiseTexture) -> Vec3 {
    let (x, y) = (point.world.x, point.world.y);
    // Some stretches are older than others.
    let old = smoothstep(0.35, 0.75, noise.clumps(x * 0.21 + 11.0, y * 0.21, point.footprint_m * 0.21));
    let worn = smoothstep(0.66 - 0.22 * old, 0.88 - 0.16 * old, noise.clumps_at(x * 9.0, y * 9.0, worn));
    Vec3::splat(0.70 - 0.16 * old).lerp(Vec3::splat(0.15), 0.8 * worn)
}

/// Height of small waves, 0..=1.
#[inline(always)]
fn waves(point: &SurfacePoint, noise: &NoiseTexture) -> f32 {
    let (x, y, size) = (point.world.x, point.world.y, point.footprint_m);
    0.65 * noise.clumps(x * 2.6, y * 4.1, size * 4.1) + 0.35 * noise.rough(x * 8.7 + 40.0, y * 6.9, size * 8.7)
}

/// Share of the sun's image that waves send to the camera: some facets of them, and their mean where pixels are larger.
#[inline(always)]
fn glitter(wave: f32, size: f32) -> f32 {
    let facets = smoothstep(0.54, 0.66, wave);
    lerp(facets, GLITTER, smoothstep(0.02, 0.12, size))
}

/// Mean share of water that glitters.
const GLITTER: f32 = 0.16;

#[inline(always)]
fn stains(point: &SurfacePoint, noise: &NoiseTexture) -> f32 {
    noise.clumps(point.world.x * 1.7, point.world.y * 1.7, point.footprint_m * 1.7)
}

#[inline(always)]
fn gravel(point: &SurfacePoint, stain: f32, fine: NoiseLevel, noise: &NoiseTexture) -> Vec3 {
    let (x, y) = (point.world.x, point.world.y);
    let rough = noise.rough_at(x * 12.0, y * 12.0, fine);
    Vec3::new(0.25, 0.23, 0.20) * (0.45 + 0.7 * rough + 0.5 * (stain - 0.3))
}

#[cfg(test)]
mod tests {
    use super::super::grid::LightGrid;
    use super::super::lanes::FOUR;
    use super::super::pattern::noise_texture;
    use super::*;
    use cosfly_domain::Season;
    use cosfly_frames::simd::Level;

    /// Albedo of road at sixteen places a pixel of 5 cm wide.
    fn road(places: [[f32; 2]; WIDE], grid: &LightGrid, noise: &NoiseTexture) -> [Vec3; WIDE] {
        let (mut shared, mut four) = (Shared::EMPTY, [const { Block::EMPTY }; FOUR]);
        for (k, [x, y]) in places.into_iter().enumerate() {
            set(&mut shared.middle, k, Vec3::new(x, y, 0.0));
            set(&mut shared.normal, k, Vec3::new(0.0, 0.0, 1.0));
            (shared.along_m[k], shared.up_m[k], shared.footprint_m[k]) = (0.05, 0.05, 0.05);
        }
        for block in &mut four {
            (block.world, block.normal) = (shared.middle, shared.normal);
        }
        ground(
            Level::PLAIN,
            &[shared],
            &mut four,
            SemanticLabel::Roads,
            (grid.tables(), &grid.frame()),
            crate::season::row(Season::Summer).lawn,
            noise,
        );
        core::array::from_fn(|k| get(&four[0].albedo, k))
    }

    #[test]
    fn a_manhole_changes_no_place_beside_it() {
        let place = |k: usize| [0.7 * (k % 200) as f32, 0.9 * (k / 200) as f32];
        let lid = (0..40_000).map(place).find(|[x, y]| to_manhole(*x, *y) < 0.3).unwrap();
        let (grid, noise) = (LightGrid::new(&[], &[], &crate::ground_kinds::GroundKinds::default()), noise_texture(3));
        let mut far = (0..40_000).map(place).filter(|[x, y]| to_manhole(*x, *y) > 3.0);
        for _ in 0..60 {
            let mut places: [[f32; 2]; WIDE] = core::array::from_fn(|_| far.next().unwrap());
            let without = road(places, &grid, &noise);
            places[5] = lid;
            let beside = road(places, &grid, &noise);
            assert!((0..WIDE).all(|k| k == 5 || beside[k] == without[k]));
        }
    }
}
