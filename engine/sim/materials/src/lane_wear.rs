//! Wear of carriageways along their lanes: wheel tracks, oil between them, mended trenches and patches.
//!
//! Cells of ground near a lane know where the lane runs: [`LaneWear`]. Wear is drawn in the lane's own coordinates, so it follows
//! bends and goes on from one lane to the next; it fades before pixels are as large as what they show. Towards junctions, where
//! lanes part, tracks fade to even wear, which is as dark in the mean.

use super::lanes::{Block, PixelLane, Shared, WIDE, get, groups, set};
use super::pattern::{NoiseTexture, Noises, band, draw, floor_int, hash, lerp, most, one_if, share, smoothstep};
use cosfly_domain::{Lane as TownLane, LaneKind};
use cosfly_frames::{DVec2, simd_kernel};

/// Side of a cell, and cells along a side of a tile.
const CELL_M: f64 = 1.0;
const TILE: usize = 8;
/// Tiles along a side of the index, a power of two; ground beyond it is even.
const TILES: usize = 512;
/// Ground farther from a lane's middle is even, metres.
const REACH_M: f64 = 2.6;
/// Lanes are looked at in pieces of this length at most, metres.
const PIECE_M: f64 = 12.0;
/// Tracks grow over this length from a junction on, metres.
const FADE_M: f64 = 7.0;
/// Pixels larger than this show none, metres.
const COARSE_M: f32 = 0.45;
/// Distance of wheel tracks from the middle of a lane, metres.
const TRACK_M: f32 = 0.78;
/// Length of a lane that has one mended place at most, metres.
const MENDED_M: f32 = 11.0;
/// Share of these lengths that have one, and width of the tar around it, metres.
const MENDED_SHARE: f32 = 0.30;
const SEAM_M: f32 = 0.045;
/// Share of light that even wear takes in the mean.
const EVENLY: f32 = 0.085;

/// Where the nearest lane runs, packed.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cell {
    /// Place of the cell's middle along the lane, metres, and to its right, millimetres.
    along_m: f32,
    aside_mm: i16,
    /// Direction of the lane, a vector of length [`UNIT`].
    direction: [i16; 2],
    /// Strength of tracks and mended places, up to [`UNIT`].
    strength: i16,
    seed: u16,
}

const UNIT: f32 = 32767.0;
const EVEN: Cell = Cell { along_m: 0.0, aside_mm: i16::MAX, direction: [0; 2], strength: 0, seed: 0 };

/// A place in the coordinates of a lane.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Place {
    /// Direction of the lane, a unit vector.
    direction: [f32; 2],
    /// Along the lane and to its right, metres.
    at_m: [f32; 2],
    strength: f32,
    seed: u32,
}

/// Where lanes run, in cells of ground.
pub struct LaneWear {
    low: [f32; 2],
    /// Number of each tile's first cell over the number of cells in a tile; the first tile is even.
    index: Vec<u32>,
    cells: Vec<Cell>,
}

impl LaneWear {
    /// The wear of a town's driving lanes.
    pub fn new(lanes: &[TownLane], town: u32) -> Self {
        let streets = streets(lanes);
        let worn = || lanes.iter().zip(&streets).filter(|(lane, _)| lane.kind == LaneKind::Driving);
        let points = worn().flat_map(|(lane, _)| &lane.middle_in_world).filter(|point| point.is_finite());
        let low = points.fold(DVec2::INFINITY, |low, point| low.min(point.truncate())) - REACH_M;
        let low = if low.is_finite() { low.floor() } else { DVec2::ZERO };
        let low_m = low.as_vec2().to_array();
        let mut wear = Self { low: low_m, index: vec![0; TILES * TILES], cells: vec![EVEN; TILE * TILE] };
        for (lane, street) in worn() {
            wear.add(lane, street, low, hash(street.first, town ^ 0x3d1f));
        }
        wear
    }

    fn add(&mut self, lane: &TownLane, street: &Street, low: DVec2, seed: u32) {
        let mut done_m = street.begin_m;
        for pair in lane.middle_in_world.windows(2) {
            let (from, to) = (pair[0].truncate() - low, pair[1].truncate() - low);
            let span_m = (to - from).length();
            let pieces = (span_m / PIECE_M).ceil().clamp(1.0, 1e4);
            for piece in 0..pieces as u32 {
                let ends = [0.0, 1.0].map(|end| from.lerp(to, (f64::from(piece) + end) / pieces));
                self.add_piece(ends, done_m + span_m * f64::from(piece) / pieces, street.tracks_m, seed);
            }
            done_m += span_m;
        }
    }

    /// Adds a straight piece of a lane that begins so far along its street; tracks lie between two places along it.
    fn add_piece(&mut self, [from, to]: [DVec2; 2], begin_m: f64, tracks_m: [f64; 2], seed: u32) {
        let along = (to - from).normalize_or_zero();
        let span_m = (to - from).dot(along);
        let cell = |at: f64| (at / CELL_M).floor().clamp(0.0, (TILE * TILES - 1) as f64) as usize;
        let (low, high) = (from.min(to) - REACH_M, from.max(to) + REACH_M);
        for row in cell(low.y)..=cell(high.y) {
            for column in cell(low.x)..=cell(high.x) {
                let middle = (DVec2::new(column as f64, row as f64) + 0.5) * CELL_M;
                let way_m = (middle - from).dot(along);
                let beyond_m = way_m - way_m.clamp(0.0, span_m);
                let aside_m = along.perp_dot(middle - from);
                // Beyond the ends of a piece the next one counts.
                if beyond_m.abs() > CELL_M || aside_m.abs() > REACH_M {
                    continue;
                }
                let known = self.cell_mut(column, row);
                let away_m = aside_m.abs() + beyond_m.abs();
                if 1e3 * away_m < f64::from(known.aside_mm.unsigned_abs()) {
                    let place_m = begin_m + way_m;
                    let to_end_m = (place_m - tracks_m[0]).min(tracks_m[1] - place_m);
                    *known = Cell {
                        along_m: place_m as f32,
                        aside_mm: (1e3 * aside_m) as i16,
                        direction: [along.x, along.y].map(|part| (part * f64::from(UNIT)).round() as i16),
                        strength: ((to_end_m / FADE_M).clamp(0.0, 1.0) * f64::from(UNIT)) as i16,
                        seed: seed as u16,
                    };
                }
            }
        }
    }

    fn cell_mut(&mut self, column: usize, row: usize) -> &mut Cell {
        let tile = row / TILE * TILES + column / TILE;
        if self.index[tile] == 0 {
            self.index[tile] = (self.cells.len() / (TILE * TILE)) as u32;
            self.cells.resize(self.cells.len() + TILE * TILE, EVEN);
        }
        &mut self.cells[self.index[tile] as usize * TILE * TILE + row % TILE * TILE + column % TILE]
    }

    /// A place in the coordinates of the nearest lane.
    #[inline(always)]
    fn at(&self, x_m: f32, y_m: f32) -> Place {
        let (x, y) = (x_m - self.low[0], y_m - self.low[1]);
        let (column, row) = (floor_int(x) as u32 as usize, floor_int(y) as u32 as usize);
        let tile = match (column / TILE < TILES) & (row / TILE < TILES) {
            true => self.index.get(row / TILE * TILES + column / TILE).copied().unwrap_or(0) as usize,
            false => 0,
        };
        let cell = self.cells.get(tile * TILE * TILE + row % TILE * TILE + column % TILE).unwrap_or(&EVEN);
        let away = [x - floor_int(x) as f32 - 0.5, y - floor_int(y) as f32 - 0.5];
        let [x, y] = cell.direction;
        let direction = [f32::from(x) * (1.0 / UNIT), f32::from(y) * (1.0 / UNIT)];
        let (along_m, aside_m) = (cell.along_m, f32::from(cell.aside_mm) * 1e-3);
        Place {
            direction,
            at_m: in_lane([along_m, aside_m], direction, away),
            strength: f32::from(cell.strength) * (1.0 / UNIT),
            seed: u32::from(cell.seed),
        }
    }
}

/// Driving lanes one after the other between two junctions, as one of them sees them.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Street {
    /// Number of the first lane.
    first: u32,
    /// Where the own lane begins along all of them, metres.
    begin_m: f64,
    /// Where tracks begin and end along all of them, metres: nowhere within junctions.
    tracks_m: [f64; 2],
}

/// The street of each lane. Of a street in a circle, it begins with the lane of the least number.
fn streets(lanes: &[TownLane]) -> Vec<Street> {
    let is_street = |lane: &TownLane| lane.kind == LaneKind::Driving && !lane.in_junction;
    let mut before: Vec<Vec<u32>> = vec![vec![]; lanes.len()];
    for (number, lane) in (0u32..).zip(lanes) {
        for next in &lane.successors {
            if let Some(all) = before.get_mut(*next as usize) {
                all.push(number);
            }
        }
    }
    // The one lane that goes on where a lane ends, unless several come together there.
    let follower = |lane: &TownLane| match lane.successors[..] {
        [next] if is_street(lane) && before.get(next as usize)?.len() == 1 => {
            lanes.get(next as usize).is_some_and(is_street).then_some(next)
        }
        _ => None,
    };
    let followers: Vec<Option<u32>> = lanes.iter().map(follower).collect();
    let mut is_first = vec![true; lanes.len()];
    followers.iter().flatten().for_each(|next| is_first[*next as usize] = false);
    let meets =
        |numbers: &[u32]| numbers.iter().filter_map(|number| lanes.get(*number as usize)).any(|it| it.in_junction);
    let none = Street { first: u32::MAX, begin_m: 0.0, tracks_m: [f64::INFINITY, f64::NEG_INFINITY] };
    let mut streets = vec![none; lanes.len()];
    let heads = (0..lanes.len()).filter(|number| is_first[*number]);
    for first in heads.chain(0..lanes.len()) {
        let mut next = is_street(&lanes[first]).then_some(first as u32);
        let (mut chain, mut begin_m) = (vec![], 0.0);
        while let Some(number) = next.filter(|number| streets[*number as usize] == none) {
            streets[number as usize] = Street { first: first as u32, begin_m, ..none };
            chain.push(number as usize);
            begin_m += lanes[number as usize].length_m();
            next = followers[number as usize];
        }
        let (Some(head), Some(last)) = (chain.first(), chain.last()) else { continue };
        let from_m = if meets(&before[*head]) { 0.0 } else { f64::NEG_INFINITY };
        let to_m = if meets(&lanes[*last].successors) { begin_m } else { f64::INFINITY };
        chain.iter().for_each(|number| streets[*number].tracks_m = [from_m, to_m]);
    }
    streets
}

/// A place of a lane that lies away from another one, in the world.
#[inline(always)]
fn in_lane([along_m, aside_m]: [f32; 2], [x, y]: [f32; 2], away: [f32; 2]) -> [f32; 2] {
    [along_m + away[0] * x + away[1] * y, aside_m + away[1] * x - away[0] * y]
}

/// Coordinates of lanes at the middles of sixteen fours.
struct Places {
    direction: [PixelLane; 2],
    at_m: [PixelLane; 2],
    strength: PixelLane,
    /// Wear of the whole lane, where it has no tracks.
    evenly: PixelLane,
    seed: [u32; WIDE],
}

simd_kernel! {
    /// Darkens and mends asphalt that is painted already.
    pub fn worn(shared: &[Shared], blocks: &mut [Block], wear: &LaneWear, noise: &NoiseTexture) {
        let (none, seed) = ([0.0; WIDE], [0; WIDE]);
        let mut places = Places { direction: [none; 2], at_m: [none; 2], strength: none, evenly: none, seed };
        for (shared, four) in groups(shared, blocks) {
            let (mut strongest, mut most_evenly) = (0.0f32, 0.0f32);
            for k in 0..WIDE {
                let middle = get(&shared.middle, k);
                let near = 1.0 - smoothstep(0.4 * COARSE_M, COARSE_M, most(shared.along_m[k], shared.up_m[k]));
                let place = wear.at(middle.x, middle.y);
                for axis in 0..2 {
                    places.direction[axis][k] = place.direction[axis];
                    places.at_m[axis][k] = place.at_m[axis];
                }
                places.strength[k] = place.strength * near;
                places.seed[k] = place.seed;
                places.evenly[k] =
                    (near - places.strength[k]) * (1.0 - smoothstep(1.2, REACH_M as f32, place.at_m[1].abs()));
                strongest = most(strongest, places.strength[k]);
                most_evenly = most(most_evenly, places.evenly[k]);
            }
            if most_evenly > 0.0 {
                for block in &mut *four {
                    for k in 0..WIDE {
                        let (point, size) = (get(&block.world, k), shared.footprint_m[k]);
                        let uneven = noise.clumps(point.x * 1.7, point.y * 1.7, size * 1.7);
                        let kept = 1.0 - places.evenly[k] * EVENLY * (0.4 + 1.2 * uneven);
                        let albedo = get(&block.albedo, k) * kept;
                        set(&mut block.albedo, k, albedo);
                    }
                }
            }
            if strongest <= 0.0 {
                continue;
            }
            for block in four {
                for k in 0..WIDE {
                    let away = get(&block.world, k) - get(&shared.middle, k);
                    let direction = [places.direction[0][k], places.direction[1][k]];
                    let at_m = [places.at_m[0][k], places.at_m[1][k]];
                    let place = in_lane(at_m, direction, [away.x, away.y]);
                    let size = shared.footprint_m[k];
                    let kept = 1.0 - places.strength[k] * (1.0 - tracks(place, size, noise));
                    let mended = 1.0 + places.strength[k] * (mended(place, size, places.seed[k]) - 1.0);
                    let albedo = get(&block.albedo, k) * (kept * mended);
                    set(&mut block.albedo, k, albedo);
                }
            }
        }
    }
}

/// Share of light that wheel tracks and oil leave at a place of a lane.
#[inline(always)]
fn tracks([along_m, aside_m]: [f32; 2], size: f32, noise: &NoiseTexture) -> f32 {
    // Long blotches: wear is uneven along a lane.
    let uneven = noise.clumps(along_m * 1.3, aside_m * 5.0 + 90.0, size * 5.0);
    let away_m = aside_m.abs();
    let track = 1.0 - smoothstep(0.06, 0.40 + size, (away_m - TRACK_M).abs());
    let oil = 1.0 - smoothstep(0.05, 0.42 + size, away_m);
    1.0 - 0.17 * track * (0.55 + 0.9 * uneven) - 0.24 * oil * share(1.8 * uneven - 0.35)
}

/// Factor of asphalt in mended trenches and patches of a lane.
#[inline(always)]
fn mended([along_m, aside_m]: [f32; 2], size: f32, seed: u32) -> f32 {
    let part = along_m * (1.0 / MENDED_M);
    let own = hash(seed, floor_int(part) as u32);
    let within_m = (part - floor_int(part) as f32) * MENDED_M;
    let (is_trench, is_left) = (draw(own, 2) < 0.45, draw(own, 3) < 0.5);
    let begin_m = 1.0 + 5.0 * draw(own, 4);
    let long = draw(own, 5);
    let end_m = begin_m + if is_trench { 0.5 + 0.5 * long } else { 1.2 + 3.2 * long };
    let left_m = if is_trench { -1.7 } else { lerp(0.15, -1.6, one_if(is_left)) };
    let right_m = if is_trench { 1.7 } else { lerp(1.55, -0.1, one_if(is_left)) };
    let patch = band(within_m, begin_m, end_m, size) * band(aside_m, left_m, right_m, size);
    let with_seam =
        band(within_m, begin_m - SEAM_M, end_m + SEAM_M, size) * band(aside_m, left_m - SEAM_M, right_m + SEAM_M, size);
    // Fresh asphalt is dark, old one light; tar runs along the seam.
    let tone = draw(own, 6);
    let new = if tone < 0.6 { 0.74 + 0.12 * tone } else { 1.0 + 0.16 * tone };
    1.0 + one_if(draw(own, 1) < MENDED_SHARE) * (patch * (new - 1.0) - 0.38 * (with_seam - patch))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::FOUR;
    use crate::pattern::noise_texture;
    use crate::vector::Vec3;
    use cosfly_frames::DVec3;
    use cosfly_frames::simd::Level;

    fn bend() -> TownLane {
        let points = (0..=40).map(|step| {
            let turn = f64::from(step) / 40.0;
            DVec3::new(30.0 * libm::sin(turn) - 500.0, 30.0 * (1.0 - libm::cos(turn)) + 80.0, 0.0)
        });
        TownLane::new(LaneKind::Driving, points, 3.5, 10.0).expect("a lane")
    }

    #[test]
    fn cells_know_the_place_in_their_lane() {
        let lane = bend();
        let wear = LaneWear::new(core::slice::from_ref(&lane), 3);
        let mut way_m = 0.0;
        for pair in lane.middle_in_world.windows(2) {
            let along = (pair[1] - pair[0]).truncate().normalize();
            for aside_m in [-1.5, -0.7, 0.0, 0.9, 1.7] {
                let place = pair[0].truncate() + aside_m * along.perp();
                let found = wear.at(place.x as f32, place.y as f32).at_m;
                assert!((f64::from(found[1]) - aside_m).abs() < 0.06, "{aside_m}: {found:?}");
                // On the inside of a bend the way is shorter.
                assert!((f64::from(found[0]) - way_m).abs() < 0.2, "{way_m}: {found:?}");
            }
            way_m += (pair[1] - pair[0]).length();
        }
        assert_eq!(wear.at(-500.0, 200.0).strength, 0.0);
        assert_eq!(wear.at(f32::NAN, 0.0).strength, 0.0);
        assert_eq!(LaneWear::new(&[], 3).at(0.0, 0.0).strength, 0.0);
    }

    /// Albedo of even asphalt of 1 at sixteen places whose pixels have a size.
    fn albedo(wear: &LaneWear, places: [[f32; 2]; WIDE], size: f32) -> [f32; WIDE] {
        let (mut shared, mut four) = (Shared::EMPTY, [const { Block::EMPTY }; FOUR]);
        for (k, [x, y]) in places.into_iter().enumerate() {
            set(&mut shared.middle, k, Vec3::new(x, y, 0.0));
            (shared.along_m[k], shared.up_m[k], shared.footprint_m[k]) = (size, size, size);
        }
        for block in &mut four {
            (block.world, block.albedo) = (shared.middle, [[1.0; WIDE]; 3]);
        }
        worn(Level::best(), &[shared], &mut four, wear, &noise_texture(3));
        four[0].albedo[0]
    }

    #[test]
    fn tracks_go_on_from_lane_to_lane_and_fade_at_junctions_alone() {
        let lane = |from_m: f64, successors: &[u32], in_junction| {
            let points = [DVec3::X * from_m, DVec3::X * (from_m + 50.0)];
            let lane = TownLane::new(LaneKind::Driving, points, 3.5, 10.0).expect("a lane");
            TownLane { successors: successors.to_vec(), in_junction, ..lane }
        };
        let lanes = [lane(50.0, &[2], false), lane(0.0, &[0], false), lane(100.0, &[3], true), lane(150.0, &[], false)];
        let wear = LaneWear::new(&lanes, 3);
        let strength = [2.0, 48.5, 51.5, 98.5, 125.0, 151.5, 198.0].map(|x| wear.at(x, 0.5).strength);
        assert_eq!([strength[0], strength[1], strength[2], strength[4], strength[6]], [1.0, 1.0, 1.0, 0.0, 1.0]);
        assert!(strength[3] < 0.3 && strength[5] < 0.3, "{strength:?}");
        let [before, after] = [48.5, 51.5].map(|x| wear.at(x, 0.5));
        assert!((after.at_m[0] - before.at_m[0] - 3.0).abs() < 1e-3 && after.seed == before.seed);
        let places = core::array::from_fn(|k| [101.0 + 3.0 * k as f32, 0.4]);
        let mean = albedo(&wear, places, 0.05).iter().sum::<f32>() / WIDE as f32;
        assert!((0.88..0.96).contains(&mean), "junctions are worn evenly: {mean}");
        // A street in a circle.
        let ring = [lane(0.0, &[1], false), lane(50.0, &[0], false)];
        assert_eq!(streets(&ring).iter().map(|street| street.begin_m).collect::<Vec<_>>(), [0.0, 50.0]);
    }

    #[test]
    fn wear_stays_calm_and_fades_with_the_distance() {
        let points = [DVec3::ZERO, DVec3::X * 900.0];
        let wear = LaneWear::new(&[TownLane::new(LaneKind::Driving, points, 3.5, 10.0).expect("a lane")], 3);
        let row = |aside_m: f32, size: f32| -> Vec<f32> {
            let sixteen = |at: u32| core::array::from_fn(|k| [20.0 + 0.5 * (16 * at + k as u32) as f32, aside_m]);
            (0..100).flat_map(|at| albedo(&wear, sixteen(at), size)).collect()
        };
        let mean = |row: &[f32]| row.iter().sum::<f32>() / row.len() as f32;
        let [track, between, edge] = [TRACK_M, 0.42, 2.3].map(|aside_m| row(aside_m, 0.05));
        assert!(mean(&track) < mean(&between) && mean(&between) < mean(&edge), "wheels darken their tracks");
        for row in [&track, &between, &edge] {
            assert!(row.iter().all(|it| (0.4..1.25).contains(it)));
        }
        assert!(row(0.0, 0.5).iter().all(|it| *it == 1.0), "what pixels cannot show is even");
    }
}
