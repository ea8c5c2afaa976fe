//! From looks to bytes: sun, sky, lamps, wetness, mirrors, haze and the tone curve.

use super::geometry::View;
use super::outskirts::{self, Outskirts, Sight};
use cosfly_frames::simd_kernel;
use cosfly_materials::grid::{GridFrame, GridTables};
use cosfly_materials::lanes::{Block, FOUR, PendingFours, Shared, WIDE, get, groups, set};
use cosfly_materials::light::Light;
use cosfly_materials::pattern::{NoiseTexture, Noises, least, lerp, most, share, smoothstep};
use cosfly_materials::tone::ToneCurve;
use cosfly_materials::vector::Vec3;

/// Rays that rise or fall by less (sine of the angle) may have others beside them on the other side of the horizon.
const LEVEL: f32 = 1e-3;

/// Texels of noise to the height of mirrored clouds.
const CLOUDS: f32 = 30.0;

/// Which kinds of light a material answers to.
#[derive(Clone, Copy, Debug)]
pub struct Answers {
    /// Rain makes it dark and shiny, puddles gather on it.
    pub wettable: bool,
    /// A little mirroring, dry too.
    pub shiny: bool,
    /// Light of its own.
    pub glows: bool,
}

/// How a surface mirrors.
#[derive(Clone, Copy, Debug)]
pub struct Mirror {
    /// Share of light at right angles, and how much more where it grazes.
    from_above: f32,
    along: f32,
    /// Strength of the sun's image, and how small it is: 0 to 1.
    image: f32,
    sharp: f32,
    /// Brightness of the sky in it, in brightnesses of the sky that is drawn, and how much clouds differ from it.
    sky: f32,
    clouds: f32,
    /// Light of the ground in it, in light that the ground throws back; 0 where what is below the horizon is houses.
    ground: f32,
    /// Cosine below which it does not graze: no more than bent sheet within a pixel does.
    flattest: f32,
    /// How sharply roofs and the road end in it: bent sheet shows them over some pixels.
    crisp: f32,
}

impl Mirror {
    /// A film of water: it mirrors more along it than from above.
    pub const FILM: Self = Self {
        from_above: 0.26,
        along: 2.0,
        image: 1.6,
        sharp: 0.0,
        sky: 1.0,
        clouds: 0.0,
        ground: 0.0,
        flattest: 0.0,
        crisp: 1.0,
    };
    /// Panes and paint of houses and things.
    pub const PANE: Self = Self { from_above: 0.30, along: 0.9, ..Self::FILM };
    /// The smooth coat over the paint of vehicles, and their glass: as much as its optics say. The sky sends more light than its
    /// picture shows, and a coat mirrors what it sends. Seen from above and along, sides mirror the road beyond.
    pub const COAT: Self = Self {
        from_above: 0.0,
        along: 1.0,
        image: 24.0,
        sharp: 1.0,
        sky: 2.4,
        clouds: 1.0,
        ground: 0.65,
        flattest: 0.12,
        crisp: 0.3,
    };
}

simd_kernel! {
    /// Wet ground: darker, and a mirror where water stands.
    pub fn wet(shared: &[Shared], blocks: &mut [Block], light: &Light, noise: &NoiseTexture) {
        let wetness = light.wet;
        let edge = 0.82 - 0.32 * light.puddles;
        for (shared, four) in groups(shared, blocks) {
            for block in four {
                for k in 0..WIDE {
                    let point = block.point(shared, k);
                    let level = noise.clumps(point.world.x * 2.1, point.world.y * 2.1, point.footprint_m * 2.1);
                    let flat = if point.normal.z > 0.9 { wetness } else { 0.0 };
                    let puddle = smoothstep(edge, edge + 0.05, level) * flat;
                    let albedo = get(&block.albedo, k) * (1.0 - 0.42 * flat - 0.10 * puddle);
                    set(&mut block.albedo, k, albedo);
                    block.mirror[k] += most(0.32 * flat + 0.55 * puddle - block.mirror[k], 0.0);
                }
            }
        }
    }
}

simd_kernel! {
    /// Light on flat surfaces from sun, sky and lamps, and haze before them.
    pub fn arriving(shared: &mut [Shared], light: &Light, haze: Vec3) {
        let light = *light;
        for shared in shared.iter_mut() {
            for k in 0..WIDE {
                let normal = get(&shared.normal, k);
                set(&mut shared.sunny, k, light.sun * most(normal.dot(light.to_sun), 0.0));
                let lamps = light.lamp * (shared.lamps[k] * (0.75 + 0.25 * normal.z));
                set(&mut shared.soft, k, light.ambient(normal) * shared.sky[k] + lamps);
                let kept = shared.kept[k];
                set(&mut shared.fog, k, haze * ((1.0 - kept) * light.exposure));
                shared.kept[k] = kept * light.exposure;
            }
        }
    }
}

simd_kernel! {
    /// Sky, houses across the street and lamps as surfaces mirror them.
    pub fn mirrored(
        shared: &mut [Shared],
        light: &Light,
        mirror: Mirror,
        grid: (&GridTables, &GridFrame),
        noise: &NoiseTexture,
    ) {
        let (light, tables, frame) = (*light, grid.0, *grid.1);
        let Mirror { from_above, along, image, sharp, sky, clouds, ground, flattest, crisp } = mirror;
        // An overcast sky is three times as bright overhead as at the horizon (CIE 110); the drawn one is even.
        let veil = clouds * smoothstep(0.05, 0.95, light.clouds);
        let mirrors_ground = ground > 0.0;
        // Roads and pavements send back a seventh of the light that they get.
        let (ground, lit_by_lamps) = (light.bounce * ground, light.lamp * 0.14);
        // Most differs a sky of which a half is blue.
        let uneven = clouds * most(4.0 * light.clouds * (1.0 - light.clouds), 0.3);
        for shared in shared.iter_mut() {
            for k in 0..WIDE {
                let (ray, normal) = (get(&shared.ray, k), get(&shared.normal, k));
                let view = ray * (1.0 / ray.dot(ray).sqrt());
                let cosine = share(-view.dot(normal));
                let grazing = 1.0 - most(cosine, flattest);
                let grazing2 = grazing * grazing;
                let fresnel = 0.05 + 0.95 * grazing2 * grazing2 * grazing;
                let out = view + normal * (2.0 * cosine);
                shared.fresnel[k] = from_above + along * fresnel;
                // A wall mirrors the houses across the street up to their roofs, and ground beside it its own houses: as
                // high as a place some way along the mirrored ray sees little of the sky.
                let level_m = 16.0 / (out.x * out.x + out.y * out.y + 0.02).sqrt();
                let middle = get(&shared.middle, k);
                let there = frame.place(middle.x + out.x * level_m, middle.y + out.y * level_m);
                let roof_m = 26.0 * (1.0 - there.sky(tables));
                let height_m = middle.z - there.ground_m(tables) + out.z * level_m;
                let above = share(0.5 + (height_m - roof_m) * (0.16 * crisp));
                let open = (0.16 + 0.84 * above) * (0.45 + 0.55 * shared.sky[k]);
                // Lamps stand near the horizon of what a street mirrors.
                let level = 1.0 - share(1.4 * out.z);
                let from_lamps = shared.lamps[k] * (0.6 + 2.4 * level * level);
                let near = light.ambient(normal) * (0.10 * shared.sky[k]) + light.lamp * from_lamps;
                let cloud = if uneven > 0.0 {
                    let per_height = CLOUDS / (most(out.z, 0.0) + 0.22);
                    let there = noise.clumps(out.x * per_height, out.y * per_height, 3.0);
                    1.0 + uneven * lerp(-0.55, 0.75, smoothstep(0.38, 0.62, there))
                } else {
                    1.0
                };
                let overhead = 1.0 + veil * (0.86 * most(out.z, 0.0) - 0.57);
                let far = light.sky(out) * (open * sky * cloud * overhead) + near;
                let seen = if mirrors_ground {
                    let below = share(0.5 - 0.5 * crisp * height_m);
                    far.lerp(ground * (0.45 + 0.55 * shared.sky[k]) + lit_by_lamps * shared.lamps[k], below)
                } else {
                    far
                };
                set(&mut shared.mirrored, k, seen);
                // The sun's own image, from facets that lean halfway to it: wide on rough water, and long where the view is flat.
                let halfway = light.to_sun - view;
                let lean = most(halfway.dot(normal), 0.0);
                let toward = lean * lean / (halfway.dot(halfway) + 1e-6);
                let toward8 = fourth(toward) * fourth(toward);
                let wide = fourth(fourth(toward8));
                shared.glint[k] = lerp(wide, fourth(wide), sharp) * image;
            }
        }
    }
}

/// A number to the power of four.
#[inline(always)]
fn fourth(x: f32) -> f32 {
    let square = x * x;
    square * square
}

/// What a flat surface's light has beside that of sun, sky and street lamps.
#[derive(Clone, Copy, Debug)]
pub struct Kinds {
    /// Light of its own.
    pub glows: bool,
    /// A mirror.
    pub shiny: bool,
    /// Openness that differs from pixel to pixel.
    pub shaded: bool,
}

simd_kernel! {
    /// From flat surfaces' looks to sRGB bytes.
    pub fn develop(shared: &[Shared], blocks: &mut [Block], light: &Light, tone: &ToneCurve, kinds: Kinds) {
        let Kinds { glows, shiny, shaded } = kinds;
        match (glows, shiny, shaded) {
            (false, false, false) => develop_all::<false, false, false>(shared, blocks, light, tone),
            (false, true, false) => develop_all::<false, true, false>(shared, blocks, light, tone),
            (true, false, false) => develop_all::<true, false, false>(shared, blocks, light, tone),
            (true, true, false) => develop_all::<true, true, false>(shared, blocks, light, tone),
            (false, false, true) => develop_all::<false, false, true>(shared, blocks, light, tone),
            (false, true, true) => develop_all::<false, true, true>(shared, blocks, light, tone),
            (true, false, true) => develop_all::<true, false, true>(shared, blocks, light, tone),
            (true, true, true) => develop_all::<true, true, true>(shared, blocks, light, tone),
        }
    }
}

#[inline(always)]
fn develop_all<const GLOWS: bool, const SHINY: bool, const SHADED: bool>(
    shared: &[Shared],
    blocks: &mut [Block],
    light: &Light,
    tone: &ToneCurve,
) {
    let sun = light.sun;
    for (shared, four) in groups(shared, blocks) {
        for block in four {
            for k in 0..WIDE {
                let sunlight = block.sunlight[k];
                let open = if SHADED { block.openness[k] } else { 1.0 };
                let arriving = get(&shared.sunny, k) * sunlight + get(&shared.soft, k) * open;
                let mut colour = get(&block.albedo, k) * arriving;
                if GLOWS {
                    colour += get(&block.emission, k);
                }
                if SHINY {
                    let mirror = least(block.mirror[k] * shared.fresnel[k], 0.85);
                    let seen = get(&shared.mirrored, k) * open + sun * (shared.glint[k] * sunlight);
                    colour = colour.lerp(seen, mirror);
                }
                block.bytes[k] = tone.pixel(colour * shared.kept[k] + get(&shared.fog, k));
            }
        }
    }
}

simd_kernel! {
    /// From looks of surfaces with normals of their own to sRGB bytes.
    pub fn develop_bent(shared: &[Shared], blocks: &mut [Block], light: &Light, tone: &ToneCurve) {
        let light = *light;
        for (shared, four) in groups(shared, blocks) {
            for block in four {
                for k in 0..WIDE {
                    let bent = get(&block.bent, k);
                    let toward = most(bent.dot(light.to_sun), 0.0);
                    let arriving = light.sun * (toward * block.sunlight[k])
                        + light.ambient(bent) * (shared.sky[k] * block.openness[k])
                        + light.lamp * (shared.lamps[k] * (0.75 + 0.25 * bent.z));
                    let colour = get(&block.albedo, k) * arriving;
                    block.bytes[k] = tone.pixel(colour * shared.kept[k] + get(&shared.fog, k));
                }
            }
        }
    }
}

simd_kernel! {
    /// The sky and the land below it, where no face is.
    pub fn sky(
        blocks: &mut [Block],
        stage: &PendingFours,
        view: &View,
        air: (&Light, Vec3, &Outskirts),
        tone: &ToneCurve,
        noise: &NoiseTexture,
    ) {
        let (view, light, haze, outskirts) = (*view, *air.0, air.1, *air.2);
        let pixel = view.across.dot(view.across).sqrt();
        for (group, four) in blocks.as_chunks_mut::<FOUR>().0.iter_mut().enumerate() {
            let [u, v] = [&stage.u, &stage.v].map(|row| PendingFours::lane(row, group));
            // The sky changes slowly: it is blended between the ends of fours, which neighbours share.
            let mut ends = [[[0.0f32; WIDE]; 3]; 2];
            let (mut lowest, mut highest) = (1.0f32, -1.0f32);
            for aside in [-0.5, 3.5] {
                for k in 0..WIDE {
                    let rise = view.ray(u[k] + aside, v[k]).unit().z;
                    (lowest, highest) = (least(lowest, rise), most(highest, rise));
                }
            }
            // The plain covers everything below the horizon, and nothing above it.
            let over_land = view.position.z > outskirts.ground_m();
            let is_plain = over_land & (highest < -LEVEL);
            if !is_plain {
                for (end, aside) in ends.iter_mut().zip([-0.5, 3.5]) {
                    for k in 0..WIDE {
                        let direction = view.ray(u[k] + aside, v[k]).unit();
                        set(end, k, super::sky::colour(&light, direction, haze, noise));
                    }
                }
            }
            for (aside, block) in four.iter_mut().enumerate() {
                let aside = aside as i32 as f32;
                let [first, last] = &ends;
                for k in 0..WIDE {
                    set(&mut block.albedo, k, get(first, k).lerp(get(last, k), 0.125 + 0.25 * aside));
                }
                let sight = |k: usize| {
                    let direction = view.ray(u[k] + aside, v[k]).unit();
                    Sight { position: view.position, direction, pixel, haze }
                };
                if (lowest < outskirts::HIGHEST) & !is_plain {
                    for k in 0..WIDE {
                        let behind = get(&block.albedo, k);
                        set(&mut block.albedo, k, outskirts.hills(behind, &light, &sight(k), noise));
                    }
                }
                if over_land & (lowest < LEVEL) {
                    for k in 0..WIDE {
                        let behind = get(&block.albedo, k);
                        set(&mut block.albedo, k, outskirts.plain(behind, &light, &sight(k), noise));
                    }
                }
                if lowest < outskirts::HIGHEST && highest > outskirts::LOWEST {
                    for ring in outskirts::RINGS {
                        let mut reaches = false;
                        for k in 0..WIDE {
                            reaches |= outskirts.reaches(&ring, &sight(k));
                        }
                        if !reaches {
                            continue;
                        }
                        for k in 0..WIDE {
                            let behind = get(&block.albedo, k);
                            set(&mut block.albedo, k, outskirts.houses(behind, &ring, &light, &sight(k), noise));
                        }
                    }
                }
                for k in 0..WIDE {
                    block.bytes[k] = tone.pixel(get(&block.albedo, k) * light.exposure);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_frames::simd::Level;
    use cosfly_materials::grid::LightGrid;
    use cosfly_materials::pattern::noise_texture;

    /// What a coat 1 m above open ground mirrors, by its normal and the ray that meets it: its light and share.
    fn coat(light: &Light, normal: Vec3, ray: Vec3) -> (Vec3, f32) {
        let (grid, noise) =
            (LightGrid::new(&[], &[], &cosfly_materials::ground_kinds::GroundKinds::default()), noise_texture(1));
        let mut shared = Shared::EMPTY;
        set(&mut shared.normal, 0, normal);
        set(&mut shared.ray, 0, ray);
        set(&mut shared.middle, 0, Vec3::new(0.0, 0.0, 1.0));
        shared.sky[0] = 1.0;
        let mut shared = [shared];
        mirrored(Level::best(), &mut shared, light, Mirror::COAT, (grid.tables(), &grid.frame()), &noise);
        (get(&shared[0].mirrored, 0), shared[0].fresnel[0])
    }

    #[test]
    fn sides_seen_along_mirror_the_road_and_a_veiled_sky_is_bright_overhead() {
        for weather in ["ClearNoon", "CloudyNoon", "HardRainNoon", "ClearSunset"] {
            let light = Light::new(&cosfly_materials::presets::preset(weather).expect("a preset"));
            let road = (light.sun * light.to_sun.z + light.dome).y * 0.14;
            for aside in [0.0, 0.02, 0.2] {
                let (seen, share) = coat(&light, Vec3::new(1.0, 0.0, 0.0), Vec3::new(-aside, 0.7, -0.7));
                assert!((0.5 * road..1.6 * road).contains(&seen.y), "{weather} {aside}: {seen:?}, a road sends {road}");
                assert!(share < 0.62, "{weather} {aside}: {share}");
            }
        }
        let light = Light::new(&cosfly_materials::presets::preset("HardRainNoon").expect("a preset"));
        let up = Vec3::new(0.0, 0.0, 1.0);
        let [overhead, level] =
            [Vec3::new(0.0, 0.05, -1.0), Vec3::new(0.0, 1.0, -0.3)].map(|ray| coat(&light, up, ray).0);
        assert!(overhead.y > 1.4 * level.y, "{overhead:?} {level:?}");
    }
}
