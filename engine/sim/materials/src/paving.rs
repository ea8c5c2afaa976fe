//! Squares and streets for people: laid in slabs, setts in rows or arcs, or clinker, with bands of stone, mended pieces
//! and slotted drains.
//!
//! Ground for people that touches is laid alike; each piece of it along its own longest side.

use super::kerbs::Kerbs;
use super::lanes::{Block, PendingFours, Shared, WIDE, get, groups, set};
use super::pattern::{
    NoiseLevels, NoiseTexture, Noises, band, floor_int, hash, most, one_if, smoothstep, stripes, unit,
};
use super::square::Square;
use super::vector::Vec3;
use cosfly_disjoint_sets::DisjointSets;
use cosfly_domain::{Town, WalkableKind};
use cosfly_frames::{DVec2, simd_kernel};
use cosfly_town::polygons::{PolygonIndex, twice_area_m2};

/// A kind of paving.
#[derive(Clone, Copy)]
struct Kind {
    /// Length and width of a stone, metres, and the share by which each row is moved on.
    stone_m: [f32; 2],
    bond: f32,
    /// How far rows bend to arcs, metres; 0 where they are straight.
    rise_m: f32,
    /// Linear RGB, and differences between stones.
    colour: [f32; 3],
    spread: f32,
    /// Distance of bands across and along the rows, metres, and their linear RGB.
    bands_m: [f32; 2],
    band: [f32; 3],
}

const KINDS: [Kind; 4] = [
    // Slabs of sandstone between dark bands.
    Kind {
        stone_m: [0.9, 0.6],
        bond: 0.5,
        rise_m: 0.0,
        colour: [0.33, 0.295, 0.245],
        spread: 0.2,
        bands_m: [7.2, FAR_M],
        band: [0.17, 0.165, 0.16],
    },
    // Granite setts in a grid of light stones.
    Kind {
        stone_m: [0.16, 0.14],
        bond: 0.5,
        rise_m: 0.0,
        colour: [0.205, 0.2, 0.195],
        spread: 0.5,
        bands_m: [5.2, 5.6],
        band: [0.40, 0.385, 0.36],
    },
    // Clinker with stripes of stone.
    Kind {
        stone_m: [0.22, 0.11],
        bond: 0.5,
        rise_m: 0.0,
        colour: [0.235, 0.125, 0.085],
        spread: 0.45,
        bands_m: [FAR_M, 6.6],
        band: [0.34, 0.325, 0.30],
    },
    // Small setts in arcs, with gutters of dark stone along them.
    Kind {
        stone_m: [0.12, 0.11],
        bond: 0.5,
        rise_m: 0.24,
        colour: [0.265, 0.243, 0.222],
        spread: 0.5,
        bands_m: [FAR_M, 5.4],
        band: [0.19, 0.184, 0.178],
    },
];
/// Width of bands, and of drains beside every third one, metres.
const BAND_M: f32 = 0.5;
const DRAIN_M: f32 = 0.14;
/// Width of joints, metres.
const JOINT_M: f32 = 0.012;
/// Width of arcs, metres.
const ARC_M: f32 = 1.5;
/// Sides of the pieces of ground that have at most one mended patch, metres; the share that has one, and how its stones differ.
const PIECE_M: [f32; 2] = [6.3, 4.7];
const MENDED: f32 = 0.3;
const MENDED_TONE: f32 = 0.38;
/// No bands.
const FAR_M: f32 = 1e4;
/// Distance of drains where there are no bands across, metres.
const DRAINS_M: f32 = 14.4;

/// Ground for people of a town, and how it is laid.
pub struct Squares {
    outlines: PolygonIndex,
    laid: Vec<Square>,
    /// How the largest of them is laid.
    largest: Square,
}

impl Squares {
    /// Those that the map has.
    pub fn of(town: &Town) -> Self {
        let plazas = town.walkable.iter().filter(|area| area.kind == WalkableKind::Plaza && !area.synthetic);
        let outlines = PolygonIndex::new(plazas.map(|area| area.plan()).collect());
        let mut squares = DisjointSets::new(outlines.outlines().len());
        for (number, outline) in outlines.outlines().iter().enumerate() {
            for other in outline.iter().flat_map(|corner| outlines.at(*corner)) {
                squares.join(number, other);
            }
        }
        let laid = outlines.outlines().iter().enumerate().map(|(number, outline)| {
            let corner = outlines.outlines()[squares.smallest(number)].first().copied().unwrap_or_default();
            let kind = hash(corner.x.round() as i32 as u32, corner.y.round() as i32 as u32) as usize % KINDS.len() + 1;
            Square { along: longest_side(outline).as_vec2().to_array(), kind: kind as f32 }
        });
        let laid: Vec<Square> = laid.collect();
        let area = |number: &usize| twice_area_m2(&outlines.outlines()[*number]).abs();
        let largest = (0..laid.len()).max_by(|one, other| area(one).total_cmp(&area(other)));
        Self { largest: largest.map_or(Square::NONE, |number| laid[number]), outlines, laid }
    }

    /// How a polygon of ground is laid: as the piece in which its middle lies, or as the largest where people may cross other parts of it.
    pub fn of_polygon(&self, middle: DVec2, mut corners: impl Iterator<Item = DVec2>) -> Square {
        match self.at(middle) {
            own if own == Square::NONE && corners.any(|corner| self.at(0.5 * (middle + corner)) != Square::NONE) => {
                self.largest
            }
            own => own,
        }
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
            let mut highest = 0.0f32;
            for kind in kinds {
                highest = most(highest, *kind);
            }
            if highest == 0.0 {
                continue;
            }
            let (fine, mut worn) = (NoiseLevels::of(&shared.footprint_m, 15.0), [0.0f32; WIDE]);
            for (k, worn) in worn.iter_mut().enumerate() {
                let middle = get(&shared.middle, k);
                *worn = noise.clumps(middle.x * 0.7 + 20.0, middle.y * 0.7, shared.footprint_m[k] * 0.7) - 0.5;
            }
            // One kind at a time: what is the same of all pixels is looked up once.
            for (number, kind) in (1u8..).zip(&KINDS) {
                let mut is_kind = [0.0f32; WIDE];
                let mut wanted = 0.0f32;
                for k in 0..WIDE {
                    is_kind[k] = one_if(kinds[k] == f32::from(number));
                    wanted = most(wanted, is_kind[k]);
                }
                if wanted == 0.0 {
                    continue;
                }
                let laid = Laid::new(kind);
                for block in &mut *four {
                    for k in 0..WIDE {
                        let point = block.point(shared, k);
                        let at = [point.world.x, point.world.y];
                        let place = [at[0] * x[k] + at[1] * y[k], at[1] * x[k] - at[0] * y[k]];
                        let rough = noise.rough_at(at[0] * 15.0, at[1] * 15.0, fine.at(k)) - 0.5;
                        let stones = laid.albedo(place, [rough, worn[k]], shared.footprint_m[k]);
                        let share = is_kind[k] * one_if(point.normal.z > 0.6);
                        let before = get(&block.albedo, k);
                        set(&mut block.albedo, k, before.lerp(stones, share));
                    }
                }
            }
        }
    }
}

/// A kind as pixels are worked out: lengths by their inverse.
#[derive(Clone, Copy)]
struct Laid {
    stone: Vec3,
    band: Vec3,
    per_stone: [f32; 2],
    per_band: [f32; 2],
    has_bands: [f32; 2],
    drains_m: f32,
    bond: f32,
    rise_m: f32,
    spread: f32,
}

impl Laid {
    #[inline(always)]
    fn new(&Kind { stone_m, bond, rise_m, colour: [r, g, b], spread, bands_m, band }: &Kind) -> Self {
        Self {
            stone: Vec3::new(r, g, b),
            band: Vec3::new(band[0], band[1], band[2]),
            per_stone: [1.0 / stone_m[0], 1.0 / stone_m[1]],
            per_band: [1.0 / bands_m[0], 1.0 / bands_m[1]],
            has_bands: [one_if(bands_m[0] < FAR_M), one_if(bands_m[1] < FAR_M)],
            drains_m: if bands_m[0] < FAR_M { 3.0 * bands_m[0] } else { DRAINS_M },
            bond,
            rise_m,
            spread,
        }
    }

    /// Albedo at a place along and across the rows, in metres, where pixels are `size` metres wide.
    #[inline(always)]
    fn albedo(&self, [u, v]: [f32; 2], [rough, worn]: [f32; 2], size: f32) -> Vec3 {
        let from_arc = u * (1.0 / ARC_M) - floor_int(u * (1.0 / ARC_M)) as f32 - 0.5;
        let across = (v - self.rise_m * 4.0 * from_arc * from_arc) * self.per_stone[1];
        let row = floor_int(across);
        let along = u * self.per_stone[0] + self.bond * (row & 1) as f32;
        let column = floor_int(along);
        let [size_u, size_v] = [size * self.per_stone[0], size * self.per_stone[1]];
        let joints = self.per_stone.map(|per_m| JOINT_M * per_m);
        let joint = most(stripes(along, 0.0, joints[0], size_u), stripes(across, 0.0, joints[1], size_v));
        let near = 1.0 - smoothstep(0.3, 1.0, size_v);
        let own = unit(hash(column as u32, row as u32 ^ 0x2c1b)) - 0.5;
        // Arcs rise to their middles and are worn there.
        let crest = 0.6 * self.rise_m * (0.33 - 4.0 * from_arc * from_arc) * (1.0 - smoothstep(0.3, 1.2, size));
        let light = (1.0 + crest + self.spread * own * near + 0.35 * rough + 0.35 * worn) * mended([u, v], size);
        let [across_share, along_share] = self.per_band.map(|per_m| BAND_M * per_m);
        let bands = most(
            self.has_bands[0] * stripes(u * self.per_band[0], 0.0, across_share, size * self.per_band[0]),
            self.has_bands[1] * stripes(v * self.per_band[1], 0.0, along_share, size * self.per_band[1]),
        );
        let beside = u - self.drains_m * floor_int(u / self.drains_m) as f32 - 2.0 * BAND_M;
        let drain = band(beside, 0.0, DRAIN_M, size);
        let slot = stripes(v * 16.0, 0.0, 0.45, size * 16.0);
        // Some stones are warmer than others.
        let warm = 0.3 * self.spread * near * (2.0 * own * own.abs() - 0.5 * rough);
        let hue = Vec3::new(self.stone.x * (1.0 + warm), self.stone.y, self.stone.z * (1.0 - warm));
        let stone = hue * (light * (1.0 - 0.45 * joint));
        let stripe = self.band * (1.0 + 0.4 * rough + 0.3 * worn);
        stone.lerp(stripe, bands).lerp(Vec3::splat(0.14 - 0.1 * slot), drain)
    }
}

/// Light of stones as a share of that of most: those of mended patches are newer or older.
#[inline(always)]
fn mended([u, v]: [f32; 2], size: f32) -> f32 {
    let (across, along) = (u * (1.0 / PIECE_M[0]), v * (1.0 / PIECE_M[1]));
    let (column, row) = (floor_int(across), floor_int(along));
    let piece = hash(column as u32, row as u32 ^ 0x5e77);
    let [place_u, place_v, half_u, half_v] = [(1, 0.4, 0.3), (2, 0.4, 0.3), (3, 0.1, 0.2), (4, 0.1, 0.18)]
        .map(|(k, from, span)| from + span * unit(hash(piece, k)) - if k < 3 { 0.05 } else { 0.0 });
    let share = band(across - column as f32, place_u - half_u, place_u + half_u, size * (1.0 / PIECE_M[0]))
        * band(along - row as f32, place_v - half_v, place_v + half_v, size * (1.0 / PIECE_M[1]));
    1.0 + one_if(unit(piece) < MENDED) * share * MENDED_TONE * (unit(hash(piece, 5)) - 0.5)
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
        let wide = [[-90.0, -90.0], [20.0, -90.0], [20.0, 40.0]].map(DVec2::from);
        assert_eq!(squares.of_polygon(DVec2::new(-40.0, -40.0), wide.into_iter()), Square::NONE);
        assert_eq!(squares.of_polygon(DVec2::new(0.0, -4.0), wide.into_iter()), one, "the largest");
        for elsewhere in [[210.0, 10.0], [4.0, 94.0], [-50.0, 0.0]] {
            assert_eq!(squares.at(DVec2::from(elsewhere)), Square::NONE);
        }
    }

    #[test]
    fn pavings_differ_and_keep_their_mean_from_afar() {
        let noise = noise_texture(3);
        let mean = |kind: &Kind, size: f32| {
            let places = (0..4000).map(|k| [0.37 * (k % 63) as f32, 0.41 * (k / 63) as f32]);
            let rough = |[x, y]: [f32; 2]| noise.rough(x * 15.0, y * 15.0, size * 15.0) - 0.5;
            let all = places
                .map(|at| Laid::new(kind).albedo(at, [rough(at), 0.0], size))
                .fold(Vec3::ZERO, |sum, it| sum + it);
            all * (1.0 / 4000.0)
        };
        let near = KINDS.each_ref().map(|kind| mean(kind, 0.02));
        for (kind, near) in KINDS.iter().zip(&near) {
            let far = mean(kind, 1.5);
            for (far, near) in [(far.x, near.x), (far.y, near.y), (far.z, near.z)] {
                assert!((far / near - 1.0).abs() < 0.06, "{far} {near}");
            }
        }
        // Of no kind is every second stone darker.
        for kind in &KINDS {
            let stone = |k: u32| {
                let [u, v] = [(k % 40) as f32 + 0.5, (k / 40) as f32 + 0.5];
                let flat = Kind { bond: 0.0, rise_m: 0.0, bands_m: [FAR_M, FAR_M], ..*kind };
                Laid::new(&flat).albedo([u * kind.stone_m[0], v * kind.stone_m[1]], [0.0, 0.0], 0.01).x
            };
            let mean = |odd: u32| {
                let of = (0..1600u32).filter(|k| (k % 40 + k / 40) & 1 == odd).map(stone);
                of.sum::<f32>() / 800.0
            };
            assert!((mean(0) / mean(1) - 1.0).abs() < 0.05, "{} {}", mean(0), mean(1));
        }
        assert!(near[2].x > 1.4 * near[2].z && near[1].x < 1.2 * near[1].z, "clinker is red, granite grey");
    }
}
