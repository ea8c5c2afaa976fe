//! Squares and streets for people: laid in slabs, setts, clinker or chequers with bands of stone and slotted drains.
//!
//! Ground for people that touches is laid alike; each piece of it along its own longest side.

use super::kerbs::Kerbs;
use super::lanes::{Block, PendingFours, Shared, WIDE, get, groups, set};
use super::pattern::{NoiseTexture, Noises, band, floor_int, hash, lerp, most, one_if, smoothstep, stripes, unit};
use super::square::Square;
use super::vector::Vec3;
use cosfly_domain::{Town, WalkableKind};
use cosfly_frames::{DVec2, simd_kernel};
use cosfly_town::polygons::PolygonIndex;

/// A kind of paving.
struct Kind {
    /// Length and width of a stone, metres, and the share by which each row is moved on.
    stone_m: [f32; 2],
    bond: f32,
    /// Linear RGB, differences between stones, and the share by which every second stone is darker.
    colour: [f32; 3],
    spread: f32,
    chequer: f32,
    /// Distance of bands across and along the rows, metres, and their linear RGB.
    bands_m: [f32; 2],
    band: [f32; 3],
}

const KINDS: [Kind; 4] = [
    // Slabs of sandstone between dark bands.
    Kind {
        stone_m: [0.9, 0.6],
        bond: 0.5,
        colour: [0.33, 0.295, 0.245],
        spread: 0.2,
        chequer: 0.0,
        bands_m: [7.2, FAR_M],
        band: [0.17, 0.165, 0.16],
    },
    // Granite setts in a grid of light stones.
    Kind {
        stone_m: [0.16, 0.14],
        bond: 0.5,
        colour: [0.205, 0.2, 0.195],
        spread: 0.5,
        chequer: 0.0,
        bands_m: [5.2, 5.6],
        band: [0.40, 0.385, 0.36],
    },
    // Clinker with stripes of stone.
    Kind {
        stone_m: [0.22, 0.11],
        bond: 0.5,
        colour: [0.235, 0.125, 0.085],
        spread: 0.45,
        chequer: 0.0,
        bands_m: [FAR_M, 6.6],
        band: [0.34, 0.325, 0.30],
    },
    // Large slabs, light and dark.
    Kind {
        stone_m: [1.2, 1.2],
        bond: 0.0,
        colour: [0.38, 0.37, 0.35],
        spread: 0.14,
        chequer: 0.34,
        bands_m: [FAR_M, FAR_M],
        band: [0.3, 0.3, 0.3],
    },
];
/// Width of bands, and of drains beside every third one, metres.
const BAND_M: f32 = 0.5;
const DRAIN_M: f32 = 0.14;
/// No bands.
const FAR_M: f32 = 1e4;
/// Distance of drains where there are no bands across, metres.
const DRAINS_M: f32 = 14.4;

/// Ground for people of a town, and how it is laid.
pub struct Squares {
    outlines: PolygonIndex,
    laid: Vec<Square>,
}

impl Squares {
    /// Those that the map has.
    pub fn of(town: &Town) -> Self {
        let plazas = town.walkable.iter().filter(|area| area.kind == WalkableKind::Plaza && !area.synthetic);
        let outlines = PolygonIndex::new(plazas.map(|area| area.plan()).collect());
        let mut first: Vec<usize> = (0..outlines.outlines().len()).collect();
        let root = |first: &[usize], mut number: usize| {
            while first[number] != number {
                number = first[number];
            }
            number
        };
        for (number, outline) in outlines.outlines().iter().enumerate() {
            for other in outline.iter().flat_map(|corner| outlines.at(*corner)) {
                let (one, other) = (root(&first, number), root(&first, other));
                first[one.max(other)] = one.min(other);
            }
        }
        let laid = outlines.outlines().iter().enumerate().map(|(number, outline)| {
            let corner = outlines.outlines()[root(&first, number)].first().copied().unwrap_or_default();
            let kind = hash(corner.x.round() as i32 as u32, corner.y.round() as i32 as u32) as usize % KINDS.len() + 1;
            Square { along: longest_side(outline).as_vec2().to_array(), kind: kind as f32 }
        });
        let laid = laid.collect();
        Self { outlines, laid }
    }

    /// How the ground is laid at a place in plan.
    pub fn at(&self, place: DVec2) -> Square {
        self.outlines.at(place).next().map_or(Square::NONE, |number| self.laid[number])
    }
}

fn longest_side(outline: &[DVec2]) -> DVec2 {
    let sides = (0..outline.len()).map(|k| outline[(k + 1) % outline.len()] - outline[k]);
    sides.max_by(|one, other| one.length().total_cmp(&other.length())).unwrap_or_default().normalize_or(DVec2::X)
}

simd_kernel! {
    /// Lays squares over what pavements are.
    pub fn pave(shared: &[Shared], blocks: &mut [Block], kerbs: &Kerbs, noise: &NoiseTexture) {
        let [along_x, along_y] = &kerbs.along;
        for (group, (shared, four)) in groups(shared, blocks).enumerate() {
            let [x, y, kinds] = [along_x, along_y, &kerbs.square].map(|row| PendingFours::lane(row, group));
            if kinds.iter().all(|kind| *kind == 0.0) {
                continue;
            }
            for block in four {
                for k in 0..WIDE {
                    let (point, kind) = (block.point(shared, k), &KINDS[(kinds[k] as usize).wrapping_sub(1) % 4]);
                    let at = [point.world.x, point.world.y];
                    let place = [at[0] * x[k] + at[1] * y[k], at[1] * x[k] - at[0] * y[k]];
                    let stones = laid(kind, at, place, shared.footprint_m[k], noise);
                    let albedo = get(&block.albedo, k);
                    set(&mut block.albedo, k, albedo.lerp(stones, one_if((kinds[k] > 0.0) & (point.normal.z > 0.6))));
                }
            }
        }
    }
}

/// Albedo of a paving at a place of the world, and along and across its rows, where pixels are `size` metres wide.
#[inline(always)]
fn laid(kind: &Kind, [x, y]: [f32; 2], [u, v]: [f32; 2], size: f32, noise: &NoiseTexture) -> Vec3 {
    let [length_m, width_m] = kind.stone_m;
    let row = floor_int(v / width_m);
    let along = u / length_m + kind.bond * (row & 1) as f32;
    let column = floor_int(along);
    let (size_u, size_v) = (size / length_m, size / width_m);
    let joint = most(stripes(along, 0.0, 0.012 / length_m, size_u), stripes(v / width_m, 0.0, 0.012 / width_m, size_v));
    let near = 1.0 - smoothstep(0.3, 1.0, size_v);
    let own = unit(hash(column as u32, row as u32 ^ 0x2c1b)) - 0.5;
    let dark = kind.chequer * lerp(0.5, ((column + row) & 1) as f32, near);
    let rough = noise.rough(x * 15.0, y * 15.0, size * 15.0) - 0.5;
    let worn = noise.clumps(x * 0.7 + 20.0, y * 0.7, size * 0.7) - 0.5;
    let light = (1.0 + kind.spread * own * near + 0.35 * rough + 0.35 * worn) * (1.0 - dark);
    let [across_m, along_m] = kind.bands_m;
    let bands = most(
        one_if(across_m < FAR_M) * stripes(u / across_m, 0.0, BAND_M / across_m, size / across_m),
        one_if(along_m < FAR_M) * stripes(v / along_m, 0.0, BAND_M / along_m, size / along_m),
    );
    let drains_m = if across_m < FAR_M { 3.0 * across_m } else { DRAINS_M };
    let beside = u - drains_m * floor_int(u / drains_m) as f32 - 2.0 * BAND_M;
    let drain = band(beside, 0.0, DRAIN_M, size);
    let slot = stripes(v * 16.0, 0.0, 0.45, size * 16.0);
    let [r, g, b] = kind.colour;
    let stone = Vec3::new(r, g, b) * (light * (1.0 - 0.45 * joint));
    let [r, g, b] = kind.band;
    let stripe = Vec3::new(r, g, b) * (1.0 + 0.4 * rough + 0.3 * worn);
    stone.lerp(stripe, bands).lerp(Vec3::splat(0.14 - 0.1 * slot), drain)
}

#[cfg(test)]
mod tests {
    use super::super::pattern::noise_texture;
    use super::*;
    use cosfly_domain::WalkablePolygon;
    use cosfly_frames::DVec3;

    fn plaza(low: [f64; 2], size: [f64; 2], synthetic: bool) -> WalkablePolygon {
        let corners = [[0.0, 0.0], [size[0], 0.0], size, [0.0, size[1]]];
        let outline_in_world = corners.map(|[x, y]| DVec3::new(low[0] + x, low[1] + y, 0.0)).to_vec();
        WalkablePolygon { kind: WalkableKind::Plaza, outline_in_world, synthetic }
    }

    #[test]
    fn ground_that_touches_is_laid_alike_along_its_own_side() {
        let pavement = WalkablePolygon { kind: WalkableKind::Sidewalk, ..plaza([0.0, 90.0], [9.0, 9.0], false) };
        let walkable = vec![
            plaza([0.0, 0.0], [30.0, 20.0], false),
            plaza([29.0, 5.0], [4.0, 40.0], false),
            plaza([200.0, 0.0], [30.0, 20.0], true),
            pavement,
        ];
        let squares = Squares::of(&Town { walkable, ..Town::default() });
        let [one, other] = [[10.0, 10.0], [31.0, 30.0]].map(|at| squares.at(DVec2::from(at)));
        assert!(one.kind >= 1.0 && one.kind == other.kind);
        assert_eq!([one.along, other.along].map(|it| it.map(f32::abs)), [[1.0, 0.0], [0.0, 1.0]]);
        for elsewhere in [[210.0, 10.0], [4.0, 94.0], [-50.0, 0.0]] {
            assert_eq!(squares.at(DVec2::from(elsewhere)), Square::NONE);
        }
    }

    #[test]
    fn pavings_differ_and_keep_their_mean_from_afar() {
        let noise = noise_texture(3);
        let mean = |kind: &Kind, size: f32| {
            let places = (0..4000).map(|k| [0.37 * (k % 63) as f32, 0.41 * (k / 63) as f32]);
            let all = places.map(|at| laid(kind, at, at, size, &noise)).fold(Vec3::ZERO, |sum, it| sum + it);
            all * (1.0 / 4000.0)
        };
        let near = KINDS.each_ref().map(|kind| mean(kind, 0.02));
        for (kind, near) in KINDS.iter().zip(&near) {
            let far = mean(kind, 1.5);
            for (far, near) in [(far.x, near.x), (far.y, near.y), (far.z, near.z)] {
                assert!((far / near - 1.0).abs() < 0.06, "{far} {near}");
            }
        }
        assert!(near[2].x > 1.4 * near[2].z && near[1].x < 1.2 * near[1].z, "clinker is red, granite grey");
    }
}
