//! Leaves of trees and bushes: clumps of light and dark over round crowns.
//!
//! Boxes of crowns are small on the screen: all of a picture are shaded together, each four with the numbers of its crown.

use super::clumps::{CLUMPS, CrownRay, CrownRays, NearestClump, SWAY, outwards};
use super::lanes::{
    Block, EMPTY_ROW, FOUR, PendingFours, PixelLane, Shared, StageRow, WIDE, get, groups, set, three_of, write_row,
    write_three,
};
use super::pattern::{NoiseTexture, Noises, draw, floor_int, hash, least, lerp, most, one_if, share, smoothstep, unit};
use super::surface::Look;
use super::vector::Vec3;
use crate::parts::SceneBox;
use crate::season;
use cosfly_domain::{ObstacleKind, Season};
use cosfly_frames::{real, simd_kernel};

/// Leaves by species, linear RGB: plane, lime, maple, oak, ash, willow, cherry, olive, birch, and copper beech.
const SPECIES: [[f32; 3]; 10] = [
    [0.063, 0.096, 0.030],
    [0.070, 0.112, 0.034],
    [0.052, 0.088, 0.025],
    [0.048, 0.074, 0.025],
    [0.060, 0.088, 0.036],
    [0.096, 0.120, 0.050],
    [0.056, 0.080, 0.028],
    [0.082, 0.093, 0.058],
    [0.090, 0.108, 0.034],
    [0.048, 0.020, 0.021],
];

/// Colours of these leaves in autumn, linear RGB; olives stay green.
const AUTUMN: [[f32; 3]; 10] = [
    [0.230, 0.150, 0.040],
    [0.330, 0.240, 0.040],
    [0.330, 0.100, 0.030],
    [0.190, 0.095, 0.035],
    [0.250, 0.215, 0.050],
    [0.230, 0.210, 0.070],
    [0.270, 0.075, 0.035],
    [0.105, 0.120, 0.070],
    [0.360, 0.260, 0.050],
    [0.190, 0.085, 0.035],
];
/// Size of the round crown as a share of half the size of the box around the whole crown.
const ROUND: f32 = 1.118_034;
/// Species whose leaves stay green: olives.
const EVERGREEN: usize = 7;
/// Share of bushes that are evergreen.
const EVERGREEN_BUSHES: f32 = 0.6;

/// How far leaves of a clump are aside of where it is, for shadows, metres.
const ASIDE_M: f32 = 1.2;

/// Texels of clumps per metre.
const PER_M: f32 = 24.0;

/// Ground below bare crowns, linear RGB.
const BELOW: Vec3 = Vec3::new(0.150, 0.131, 0.096);

/// Twigs of a bare crown, linear RGB.
fn twigs(seed: u32) -> Vec3 {
    Vec3::new(0.094, 0.074, 0.056).lerp(Vec3::new(0.080, 0.068, 0.055), draw(seed, 10))
}

/// A crown.
#[derive(Clone, Copy, Debug)]
pub struct Leaves {
    /// Middle and half size of the whole crown, metres; one divided by that size.
    middle: Vec3,
    half: Vec3,
    shrink: Vec3,
    tint: Vec3,
    /// Light that shines through its leaves, as a share of that of green ones.
    through: f32,
    /// Where its patterns begin.
    shift: f32,
    /// Cosine and sine of how its clumps are turned around the upright.
    turn: [f32; 2],
}

impl Leaves {
    /// The crown that a box belongs to, if there are leaves or twigs in it.
    pub fn of(b: &SceneBox, season: Season) -> Option<Self> {
        if !matches!(b.kind, ObstacleKind::TreeCrown | ObstacleKind::Bush) {
            return None;
        }
        let [middle, half] = b.whole.map(|v| Vec3::new(v.x, v.y, v.z));
        let (seed, common) = (b.seed, SPECIES.len() - 1);
        // The last species is rare.
        let species = if draw(seed, 8) < 0.015 { common } else { (draw(seed, 7) * common as f32) as usize % common };
        let [green, late] = [SPECIES, AUTUMN].map(|leaves| leaves[species]).map(|[r, g, b]| Vec3::new(r, g, b));
        let is_evergreen = species == EVERGREEN || (b.kind == ObstacleKind::Bush && draw(seed, 11) < EVERGREEN_BUSHES);
        let look = season::row(season);
        let is_bare = look.is_bare && !is_evergreen;
        // Shrubs of a hedge share a seed, and differ.
        let place = if b.kind == ObstacleKind::Bush { middle.x.to_bits() ^ middle.y.to_bits() } else { 0 };
        let leaves = match look.turned {
            _ if is_bare => twigs(seed),
            // Trees of a town turn one after the other.
            Some([slope, offset]) => green.lerp(late, share(slope * draw(seed, 9) + offset)),
            None => green * look.leaf,
        };
        let shift = 37.0 * unit(if place == 0 { seed } else { hash(seed, place) });
        let (sin, cos) = real::sin_cos(f64::from(shift) * core::f64::consts::TAU / 37.0);
        Some(Self {
            middle,
            half,
            shrink: half.map(|half| 1.0 / half.max(0.1)),
            tint: leaves * (0.8 + 0.45 * draw(seed, 1)),
            through: if is_bare { 0.0 } else { 1.0 },
            shift,
            turn: [cos as f32, sin as f32],
        })
    }

    /// Whether the crown has twigs and no leaves.
    pub fn is_bare(&self) -> bool {
        self.through == 0.0
    }

    /// The round crown.
    pub fn outline(&self) -> LeafCrown {
        LeafCrown { middle: self.middle, shrink: self.shrink, turn: self.turn }
    }

    /// Half the lesser width of the crown, metres.
    pub fn half_width_m(&self) -> f32 {
        least(self.half.x, self.half.y)
    }
}

/// The round crown that leaves are drawn on; corners of boxes stand out of it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LeafCrown {
    /// Middle, metres.
    pub middle: Vec3,
    /// One divided by half the size of the whole crown, 1/m.
    pub shrink: Vec3,
    /// Cosine and sine of how its clumps are turned around the upright.
    pub turn: [f32; 2],
}

impl LeafCrown {
    /// A ray from the eye in the crown's own measure.
    #[inline(always)]
    pub fn ray(&self, eye: Vec3, along: Vec3) -> CrownRay {
        let from = turned((eye - self.middle) * self.shrink, self.turn);
        CrownRay::new(from, turned(along * self.shrink, self.turn).unit())
    }
}

/// A direction or place of the world in a crown's measure, turned as clumps are.
#[inline(always)]
fn turned(v: Vec3, [cos, sin]: [f32; 2]) -> Vec3 {
    Vec3::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y, v.z)
}

/// Crowns on the stage, one for each four.
pub struct Crowns {
    middle: [StageRow; 3],
    half: [StageRow; 3],
    shrink: [StageRow; 3],
    tint: [StageRow; 3],
    through: StageRow,
    shift: StageRow,
    turn: [StageRow; 2],
}

impl Crowns {
    /// Nothing in particular.
    pub const EMPTY: Self = Self {
        middle: [EMPTY_ROW; 3],
        half: [EMPTY_ROW; 3],
        shrink: [EMPTY_ROW; 3],
        tint: [EMPTY_ROW; 3],
        through: EMPTY_ROW,
        shift: EMPTY_ROW,
        turn: [EMPTY_ROW; 2],
    };

    #[inline(always)]
    fn seen(&self, eye: Vec3, group: usize, k: usize) -> Seen {
        let [middle, half, shrink] = [&self.middle, &self.half, &self.shrink].map(|rows| three_of(rows, group, k));
        Seen { eye, middle, half, shrink }
    }
}

simd_kernel! {
    /// Puts a crown on the stage from a four on, sixteen fours at a time: what is too much, the next one writes over.
    pub fn put_crown(crowns: &mut Crowns, first: usize, fours: usize, look: &Leaves) {
        for done in (0..fours).step_by(WIDE) {
            let at = first.wrapping_add(done);
            write_three(&mut crowns.middle, at, look.middle);
            write_three(&mut crowns.half, at, look.half);
            write_three(&mut crowns.shrink, at, look.shrink);
            write_three(&mut crowns.tint, at, look.tint);
            write_row(&mut crowns.through, at, look.through);
            write_row(&mut crowns.shift, at, look.shift);
            write_row(&mut crowns.turn[0], at, look.turn[0]);
            write_row(&mut crowns.turn[1], at, look.turn[1]);
        }
    }
}

/// Half the width of a tree of a wood, for half its height, and at least and at most, metres.
const TREE_HALF: [f32; 3] = [1.25, 2.5, 4.5];
/// Trees of a wood reach this far into each other, of half their width.
const INTO_NEXT: f32 = 1.3;
/// How far edges between them sway, of half the width of a tree, and texels of clumps per metre for that.
const SWAY_SHARE: f32 = 1.4;
const WAVES: f32 = 8.0;

simd_kernel! {
    /// Parts crowns that are much wider than high, where trees stand so close that a map takes them for one: each four, whose middle is
    /// on the boxes, shows a tree of its own from here on.
    pub fn part_woods(crowns: &mut Crowns, shared: &[Shared], noise: &NoiseTexture) {
        for (group, shared) in shared.iter().enumerate() {
            let at = group.wrapping_mul(WIDE);
            for k in 0..WIDE {
                let [middle, half] = [&crowns.middle, &crowns.half].map(|rows| three_of(rows, group, k));
                let tree_m = least(most(TREE_HALF[0] * half.z, TREE_HALF[1]), TREE_HALF[2]);
                let trees = |half_m: f32| most(floor_int(0.8 * half_m / tree_m + 0.5) as f32, 1.0);
                // Hedges and rows of shrubs stay.
                let is_wood = one_if(least(half.x, half.y) > 2.0);
                let (across, along) = (lerp(1.0, trees(half.x), is_wood), lerp(1.0, trees(half.y), is_wood));
                let own = half * Vec3::new(1.0 / across, 1.0 / along, 1.0);
                let place = get(&shared.middle, k);
                let sway = [0.0, 90.0].map(|aside| noise.clumps(place.x * WAVES + aside, place.y * WAVES - aside, 4.0) - 0.5);
                let from = place - middle + half + Vec3::new(sway[0], sway[1], 0.0) * (SWAY_SHARE * tree_m);
                let row = least(most(floor_int(0.5 * from.y / own.y) as f32, 0.0), along - 1.0);
                // Every other row stands aside by half a tree.
                let aside_m = (row - 2.0 * floor_int(0.5 * row) as f32 - 0.5) * one_if(across > 1.0) * own.x;
                let column = least(most(floor_int(0.5 * (from.x - aside_m) / own.x) as f32, 0.0), across - 1.0);
                let parted = one_if(across * along > 1.0);
                let tree = Vec3::new((2.0 * column + 1.0) * own.x + aside_m, (2.0 * row + 1.0) * own.y, half.z) - half;
                let half = half.lerp(own * Vec3::new(INTO_NEXT, INTO_NEXT, 1.0), parted);
                let (leaves, shift) = (three_of(&crowns.tint, group, k), PendingFours::lane(&crowns.shift, group)[k]);
                let drawn = unit(hash(shift.to_bits(), (row * 64.0 + column) as u32));
                // Half a turn at most, without angles.
                let (way, tint) = (2.0 * drawn - 1.0, lerp(1.0, 0.80 + 0.4 * drawn, parted));
                let turn = [1.0 - way * way, 2.0 * way].map(|part| part / (1.0 + way * way));
                let at = at.wrapping_add(k);
                for (rows, value) in [
                    (&mut crowns.middle, middle + tree * parted),
                    (&mut crowns.half, half),
                    (&mut crowns.shrink, Vec3::new(1.0 / most(half.x, 0.1), 1.0 / most(half.y, 0.1), 1.0 / most(half.z, 0.1))),
                    (&mut crowns.tint, leaves * tint),
                ] {
                    (rows[0][at], rows[1][at], rows[2][at]) = (value.x, value.y, value.z);
                }
                crowns.shift[at] += 37.0 * drawn * parted;
                for (row, turn) in crowns.turn.iter_mut().zip(turn) {
                    row[at] = lerp(row[at], turn, parted);
                }
            }
        }
    }
}

/// A crown on the stage at four `k` of a group, and the eye that sees it.
#[derive(Clone, Copy)]
struct Seen {
    eye: Vec3,
    middle: Vec3,
    half: Vec3,
    shrink: Vec3,
}

impl Seen {
    /// The place on the round crown on the way from the eye to a place, and the normal there. Where the way passes the round
    /// crown by, the far side counts, as far around as the way passes it by: corners of boxes stand out there.
    #[inline(always)]
    fn round(self, place: Vec3) -> (Vec3, Vec3) {
        let from = (self.eye - self.middle) * self.shrink;
        let along = (place - self.eye) * self.shrink;
        let (a, b, c) = (along.dot(along), along.dot(from), from.dot(from) - ROUND * ROUND);
        let reach = most(b * b - a * c, 0.0).sqrt();
        let out = from + along * ((-b - reach) / a);
        let beyond = most(out.dot(out).sqrt() - ROUND, 0.0);
        let out = out + along * (beyond / a.sqrt());
        let out = out * (ROUND / out.dot(out).sqrt());
        (self.middle + out * self.half, (out * self.shrink).unit())
    }
}

simd_kernel! {
    /// Moves the middles of fours on a crown's boxes to the round crown around them, along the view, and turns normals its way:
    /// light then knows nothing of boxes. `pixel` is the size of a pixel at a distance of 1.
    pub fn swell(shared: &mut [Shared], crowns: &Crowns, eye: Vec3, pixel: f32) {
        for (group, shared) in shared.iter_mut().enumerate() {
            for k in 0..WIDE {
                let crown = crowns.seen(eye, group, k);
                let (place, normal) = crown.round(get(&shared.middle, k));
                let away = place - eye;
                set(&mut shared.middle, k, place);
                set(&mut shared.normal, k, normal);
                shared.footprint_m[k] = pixel * away.dot(away).sqrt();
            }
        }
    }
}

simd_kernel! {
    /// The look of leaves. Places move from the crown's boxes to the round crown and on by `off_crown`, to where the light on them is
    /// that of the crown's surroundings: no box of its own shades another. Leaves of a clump move aside with it, so that shadows on
    /// crowns are ragged.
    pub fn leaves(
        shared: &[Shared],
        blocks: &mut [Block],
        crowns: &Crowns,
        eye: Vec3,
        off_crown: Vec3,
        noise: &NoiseTexture,
    ) {
        for (group, (shared, four)) in groups(shared, blocks).enumerate() {
            for block in four {
                let mut nearest = NearestClumps::EMPTY;
                for k in 0..WIDE {
                    let (place, normal) = crowns.seen(eye, group, k).round(get(&block.world, k));
                    set(&mut block.world, k, place);
                    set(&mut block.normal, k, normal);
                }
                for (k, ragged) in nearest.ragged.iter_mut().enumerate() {
                    let place = get(&block.world, k) - three_of(&crowns.middle, group, k);
                    let (shift, normal) = (PendingFours::lane(&crowns.shift, group)[k], get(&block.normal, k));
                    *ragged = raggedness(place, normal, shift, shared.footprint_m[k], noise);
                }
                let rays = crowns.clumps(group, block, eye, &mut nearest);
                // Noise is scattered over memory: it is read between vector code.
                let (mut spots, mut grains) = ([[0.0; WIDE]; 5], [[0.0; WIDE]; 2]);
                for k in 0..WIDE {
                    let (seen, crown) = (crowns.on_clump(group, k, block, &nearest, &rays), crowns.on_map(group, k));
                    let spot = spot(&seen, &crown, shared.footprint_m[k], nearest.ragged[k]);
                    for (lane, number) in spots.iter_mut().zip(spot) {
                        lane[k] = number;
                    }
                }
                for k in 0..WIDE {
                    let [big, small] = grain(core::array::from_fn(|number| spots[number][k]), noise);
                    (grains[0][k], grains[1][k]) = (big, small);
                }
                let (mut albedo, mut bent, mut aside) = ([[0.0; WIDE]; 3], [[0.0; WIDE]; 3], [[0.0; WIDE]; 3]);
                let mut openness = [0.0; WIDE];
                for k in 0..WIDE {
                    let (seen, crown) = (crowns.on_clump(group, k, block, &nearest, &rays), crowns.on_map(group, k));
                    let grains = [grains[0][k], grains[1][k]];
                    let (look, turn) = look(&seen, &crown, nearest.ragged[k], spots[4][k], grains);
                    set(&mut albedo, k, look.albedo);
                    set(&mut bent, k, look.normal);
                    set(&mut aside, k, turn * ASIDE_M);
                    openness[k] = look.openness;
                }
                for (k, openness) in openness.into_iter().enumerate() {
                    block.put_bent(k, &Look { openness, ..Look::matt(get(&albedo, k), get(&bent, k)) });
                    let place = get(&block.world, k);
                    set(&mut block.world, k, place + off_crown + get(&aside, k));
                }
            }
        }
    }
}

/// The nearest clumps of sixteen pixels.
struct NearestClumps {
    /// How far their leaves stand out or back, as a share of the clump.
    ragged: PixelLane,
    reach: PixelLane,
    middle: [PixelLane; 3],
    met: PixelLane,
}

impl NearestClumps {
    const EMPTY: Self = Self { ragged: [0.0; WIDE], reach: [0.0; WIDE], middle: [[0.0; WIDE]; 3], met: [0.0; WIDE] };

    #[inline(always)]
    fn at(&self, k: usize) -> NearestClump {
        NearestClump { reach: self.reach[k], middle: get(&self.middle, k), met: self.met[k] }
    }

    #[inline(always)]
    fn put(&mut self, k: usize, nearest: NearestClump) {
        (self.reach[k], self.met[k]) = (nearest.reach, nearest.met);
        set(&mut self.middle, k, nearest.middle);
    }
}

/// What a pixel shows: a clump, the ray to it, and the round crown's normal and place, metres from its middle.
struct OnClump {
    nearest: NearestClump,
    ray: CrownRay,
    round: Vec3,
    place: Vec3,
}

impl Crowns {
    #[inline(always)]
    fn on_clump(
        &self,
        group: usize,
        k: usize,
        block: &Block,
        nearest: &NearestClumps,
        rays: &CrownRays<WIDE>,
    ) -> OnClump {
        let place = get(&block.world, k) - three_of(&self.middle, group, k);
        OnClump { nearest: nearest.at(k), ray: rays.at(k), round: get(&block.normal, k), place }
    }

    #[inline(always)]
    fn on_map(&self, group: usize, k: usize) -> OnMap {
        let [tint, half, shrink] = [&self.tint, &self.half, &self.shrink].map(|rows| three_of(rows, group, k));
        let [shift, through] = [&self.shift, &self.through].map(|row| PendingFours::lane(row, group)[k]);
        let turn = [0, 1].map(|number| PendingFours::lane(&self.turn[number], group)[k]);
        OnMap { tint, half, shrink, turn, through, shift }
    }

    /// Finds which clumps sixteen pixels show; the rays from the round crown to them.
    #[inline(always)]
    fn clumps(&self, group: usize, block: &Block, eye: Vec3, nearest: &mut NearestClumps) -> CrownRays<WIDE> {
        let mut rays = CrownRays::EMPTY;
        for k in 0..WIDE {
            let (place, crown) = (get(&block.world, k), self.on_map(group, k));
            let from = turned((place - three_of(&self.middle, group, k)) * crown.shrink, crown.turn);
            let ray = CrownRay::new(from, turned((place - eye) * crown.shrink, crown.turn).unit());
            rays.put(k, ray);
            nearest.put(k, NearestClump::inside(ray));
        }
        for ([x, y, z, radius], sway) in CLUMPS.into_iter().zip(SWAY) {
            for k in 0..WIDE {
                let radius = radius * (1.0 + sway * nearest.ragged[k]);
                nearest.put(k, nearest.at(k).or(rays.at(k), Vec3::new(x, y, z), radius * radius));
            }
        }
        rays
    }
}

simd_kernel! {
    /// Crowns in the simple look: of one colour each, darker below.
    pub fn even_leaves(blocks: &mut [Block], crowns: &Crowns, eye: Vec3) {
        for (group, four) in blocks.as_chunks_mut::<FOUR>().0.iter_mut().enumerate() {
            for block in four {
                for k in 0..WIDE {
                    let (_, normal) = crowns.seen(eye, group, k).round(get(&block.world, k));
                    set(&mut block.albedo, k, three_of(&crowns.tint, group, k) * 1.2);
                    set(&mut block.bent, k, normal);
                    block.openness[k] = 0.75 + 0.25 * normal.z;
                    block.sunlight[k] = 1.0;
                }
            }
        }
    }
}

/// How far the leaves of clumps stand out or back, as a share of the clump; `place` is from the middle of the crown, and the
/// pattern lies on the side of the crown that it is on, so that it is drawn out nowhere.
#[inline(always)]
fn raggedness(place: Vec3, normal: Vec3, shift: f32, size: f32, noise: &NoiseTexture) -> f32 {
    let (u, v) = facing(place * PER_M, normal);
    0.5 * (noise.rough(u + shift, v - shift, 1.5 * size * PER_M) - 0.5)
}

/// Where a place on a clump lies, from the middle of the clump, the way out of the clump, and where it meets the ray. Beyond the edges of
/// clumps, patterns lie on the round crown: nothing is drawn out long there.
#[inline(always)]
fn on_clump(seen: &OnClump, crown: &OnMap) -> [Vec3; 3] {
    let met = seen.nearest.place(seen.ray);
    let on_clump =
        crown.back(met - seen.nearest.middle).lerp(seen.place * crown.shrink, one_if(seen.nearest.met < 0.0));
    [on_clump, (on_clump * crown.shrink).unit(), met]
}

/// How fine the smaller pattern is.
#[inline(always)]
fn fineness(through: f32) -> f32 {
    lerp(0.85, 1.0, through)
}

/// Where the patterns of a place on a clump are read: two coordinates, how far apart from other clumps, how fine the smaller pattern
/// is, and the size of a pixel there. Patterns lie on each clump as seen from outside.
#[inline(always)]
fn spot(seen: &OnClump, crown: &OnMap, size: f32, ragged: f32) -> [f32; 5] {
    let [on_clump, out, met] = on_clump(seen, crown);
    // Where sides of a clump meet, leaves hide the seam.
    let (u, v) = facing(on_clump * crown.half * PER_M, out + Vec3::new(ragged, -ragged, 0.0) * 2.0);
    // Sides of clumps that the eye sees at a slant are finer.
    let radius = met - seen.nearest.middle;
    let passed = one_if(seen.nearest.met < 0.0);
    let slant = most(share(seen.nearest.met / (radius.dot(radius) + 1e-6)), 0.5 * passed);
    let apart = crown.shift + 60.0 * (seen.nearest.middle.x + seen.nearest.middle.y);
    [u, v, apart, fineness(crown.through), size / most(slant.sqrt(), 0.4)]
}

/// The patterns at a [`spot`], from -0.5 to 0.5.
#[inline(always)]
fn grain([u, v, apart, fine, size]: [f32; 5], noise: &NoiseTexture) -> [f32; 2] {
    let big = noise.rough(u + apart, v - apart, 1.7 * size * PER_M) - 0.5;
    [big, noise.grain(u * fine, v * fine, 1.7 * size * PER_M * fine) - 0.5]
}

/// The look of a place on a clump where a pixel has the size `size`, and the way that its leaves are turned.
#[inline(always)]
fn look(seen: &OnClump, crown: &OnMap, ragged: f32, size: f32, [big, small]: [f32; 2]) -> (Look, Vec3) {
    let ([_, out, met], bare, round) = (on_clump(seen, crown), 1.0 - crown.through, seen.round);
    let (clear, fine) = (share(1.0 + 12.0 * seen.nearest.met), fineness(crown.through));
    // Leaves have edges: light ones before dark gaps.
    let leaf = share(0.5 + small * (4.0 - 3.0 * share(size * PER_M * fine - 0.25))) - 0.5;
    // Twigs are lines, level sets of the same noise, with what lies below the crown between them; they fade where a
    // pixel is as large as a texel.
    let open = bare * share((small.abs() - 0.01) / (0.10 + 0.40 * least(size * PER_M * fine, 1.0)));
    let small = small * crown.through;
    // Every twig of leaves faces its own way.
    let turn = Vec3::new(2.0 * ragged - big, 2.0 * ragged + leaf, big + ragged);
    let bent =
        (out.lerp(round, 0.5) + turn * 1.4 + Vec3::new(0.0, 0.0, 0.25)).lerp(Vec3::new(0.0, 0.0, 1.0), 0.6 * bare);
    let outer = lerp(outwards(met) * lerp(0.5, 1.0, clear), 0.75, 0.7 * bare);
    let deep = smoothstep(-0.75, 1.15, 1.6 * outer - 0.8 + 2.7 * big + 1.1 * leaf * crown.through);
    // Light shines through leaves at the rim of a clump: they are yellower there.
    let through = Vec3::new(1.9, 1.45, 1.1) * crown.through + Vec3::splat(0.6 * bare);
    let tint = crown.tint.lerp(crown.tint * through, 0.5 * (small + 0.5) * deep);
    let tint = (tint * (0.45 + 0.95 * deep)).lerp(BELOW, open * (0.2 + 0.2 * deep));
    // Darker below, where the crown shades itself.
    let shade = 0.4 + 0.3 * smoothstep(-1.0, 0.6, round.z + bare) + 0.3 * smoothstep(-0.7, 0.5, out.z + bare);
    let openness = lerp((0.30 + 0.80 * deep) * shade, 0.85, 0.5 * open);
    (Look { openness, ..Look::matt(tint, bent.unit()) }, turn)
}

/// A crown as its patterns know it.
struct OnMap {
    tint: Vec3,
    half: Vec3,
    shrink: Vec3,
    turn: [f32; 2],
    through: f32,
    shift: f32,
}

impl OnMap {
    /// A direction or place among clumps, turned back into the world.
    #[inline(always)]
    fn back(&self, v: Vec3) -> Vec3 {
        turned(v, [self.turn[0], -self.turn[1]])
    }
}

/// Where a place lies seen along the axis that faces it most.
#[inline(always)]
fn facing(place: Vec3, normal: Vec3) -> (f32, f32) {
    let (x, y, z) = (normal.x.abs(), normal.y.abs(), normal.z.abs());
    let (up, ahead) = (one_if(z > most(x, y)), one_if(x > y));
    (lerp(lerp(place.x, place.y, ahead), place.x, up), lerp(place.z, place.y, up))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pattern::noise_texture;

    #[test]
    fn places_of_a_wood_show_a_tree_near_them_and_single_crowns_stay() {
        let noise = noise_texture(5);
        let trees = |half: Vec3| -> Vec<[f32; 4]> {
            let middle = Vec3::new(40.0, -30.0, 6.0);
            let shrink = half.map(|half| 1.0 / half);
            let look =
                Leaves { middle, half, shrink, tint: Vec3::splat(0.1), through: 1.0, shift: 3.0, turn: [0.8, 0.6] };
            let mut crowns = Box::new(Crowns::EMPTY);
            put_crown(cosfly_frames::simd::Level::best(), &mut crowns, 0, WIDE, &look);
            let mut shared = Shared::EMPTY;
            let across = |k: usize| half * Vec3::new((k % 4) as f32 / 1.6 - 0.94, (k / 4) as f32 / 1.6 - 0.94, 1.0);
            (0..WIDE).for_each(|k| set(&mut shared.middle, k, middle + across(k)));
            part_woods(cosfly_frames::simd::Level::best(), &mut crowns, &[shared], &noise);
            let tree = |k: usize| {
                let (tree, own) = (three_of(&crowns.middle, 0, k), three_of(&crowns.half, 0, k));
                let away = tree - (middle + across(k));
                [tree.x, tree.y, own.x.max(own.y), away.x.abs().max(away.y.abs())]
            };
            (0..WIDE).map(tree).collect()
        };
        for [x, y, half_m, _] in trees(Vec3::new(3.0, 2.5, 2.5)) {
            assert_eq!([x, y, half_m], [40.0, -30.0, 3.0]);
        }
        let wood = trees(Vec3::new(14.0, 11.0, 3.5));
        assert!(wood.iter().all(|[_, _, half_m, away_m]| *half_m < 7.5 && *away_m < 7.5), "{wood:?}");
        let mut places: Vec<[u32; 2]> = wood.iter().map(|[x, y, ..]| [x.to_bits(), y.to_bits()]).collect();
        places.sort_unstable();
        places.dedup();
        assert!(places.len() > 4, "{wood:?}");
    }

    #[test]
    fn leaves_have_no_streaks_on_any_side() {
        let noise = noise_texture(5);
        let (half, shrink) = (Vec3::splat(2.0), Vec3::splat(0.5));
        let crown = OnMap { tint: Vec3::splat(0.1), half, shrink, turn: [0.8, 0.6], through: 1.0, shift: 3.0 };
        // A place on a clump as large as a hill, seen from straight above it.
        let openness = |world: Vec3, normal: Vec3| {
            let (up, middle) = (turned(normal, crown.turn), turned(normal * -40.0, crown.turn) * 0.5);
            let from = turned(world + normal, crown.turn) * 0.5;
            let nearest = NearestClump { reach: 0.5, middle, met: 400.0 };
            let seen = OnClump { nearest, ray: CrownRay::new(from, up * -1.0), round: normal, place: world };
            let spot = spot(&seen, &crown, 0.02, 0.0);
            look(&seen, &crown, 0.0, spot[4], grain(spot, &noise)).0.openness
        };
        // Mean change over a step along a face.
        let change = |normal: Vec3, step: Vec3, across: Vec3| {
            let places = (0..2000).map(|k| across * (0.11 * (k % 50) as f32) + step * (1.7 * (k / 50) as f32));
            let change = places.map(|place| (openness(place + step, normal) - openness(place, normal)).abs());
            change.sum::<f32>() / 2000.0
        };
        let (x, y, z) = (Vec3::new(0.2, 0.0, 0.0), Vec3::new(0.0, 0.2, 0.0), Vec3::new(0.0, 0.0, 0.2));
        for [out, step, across] in [[x, y, z], [y, x, z], [z, x, y]] {
            let [one, other] = [change(out * 5.0, step, across), change(out * 5.0, across, step)];
            assert!(one < 1.7 * other && other < 1.7 * one, "{one} along, {other} across");
        }
    }
}
