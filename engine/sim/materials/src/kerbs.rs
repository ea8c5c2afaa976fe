//! Kerb stones along the edges of pavements.
//!
//! Pavements are shaded together, whatever polygon they are of: each four carries the line of the kerb beside it.

use super::lanes::{Block, EMPTY_ROW, PendingFours, Shared, StageRow, WIDE, get, groups, set, write_row};
use super::pattern::{NoiseTexture, Noises, band, draw, floor_int, hash, most, one_if, stripes, unit};
use super::square::Square;
use super::vector::Vec3;
use cosfly_frames::simd_kernel;

/// Width of kerb stones from above, and of the joint behind them, metres.
const STONE_M: f32 = 0.20;
const JOINT_M: f32 = 0.03;
/// Length of a stone, metres.
const LENGTH_M: f32 = 1.0;
/// Stones by town, linear RGB: granite light and dark, concrete.
const TONES: [[f32; 3]; 3] = [[0.47, 0.46, 0.44], [0.27, 0.265, 0.26], [0.40, 0.385, 0.36]];

/// The line of a kerb from above: places of the pavement have a distance from it of 0 or more.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KerbLine {
    /// Unit vector from the kerb into the pavement.
    pub inward: [f32; 2],
    /// Distance of the line from the world's origin along that vector, metres.
    pub offset_m: f32,
    /// How the ground behind it is laid.
    pub square: Square,
}

impl KerbLine {
    /// No kerb: everything is far from it.
    pub const NONE: Self = Self { inward: [0.0; 2], offset_m: -99.0, square: Square::NONE };
}

/// Lines on the stage, one for each four.
pub struct Kerbs {
    inward: [StageRow; 2],
    offset_m: StageRow,
    /// Rows of squares.
    pub along: [StageRow; 2],
    /// Their pavings.
    pub square: StageRow,
}

impl Kerbs {
    /// Nothing in particular.
    pub const EMPTY: Self =
        Self { inward: [EMPTY_ROW; 2], offset_m: EMPTY_ROW, along: [EMPTY_ROW; 2], square: EMPTY_ROW };
}

simd_kernel! {
    /// Puts a line on the stage from a four on, sixteen fours at a time: what is too much, the next one writes over.
    pub fn put_kerb(kerbs: &mut Kerbs, first: usize, fours: usize, line: &KerbLine) {
        for done in (0..fours).step_by(WIDE) {
            let at = first.wrapping_add(done);
            write_row(&mut kerbs.inward[0], at, line.inward[0]);
            write_row(&mut kerbs.inward[1], at, line.inward[1]);
            write_row(&mut kerbs.offset_m, at, line.offset_m);
            write_row(&mut kerbs.along[0], at, line.square.along[0]);
            write_row(&mut kerbs.along[1], at, line.square.along[1]);
            write_row(&mut kerbs.square, at, line.square.kind);
        }
    }
}

/// The stone of a town.
pub fn tone_of_town(town: u32) -> Vec3 {
    let [r, g, b] = TONES[(draw(town, 41) * TONES.len() as f32) as usize % TONES.len()];
    Vec3::new(r, g, b)
}

simd_kernel! {
    /// Paints stones over pavement beside kerbs, and over the kerbs' upright faces.
    pub fn stones(shared: &[Shared], blocks: &mut [Block], kerbs: &Kerbs, tone: Vec3, noise: &NoiseTexture) {
        let [xs, ys] = &kerbs.inward;
        for (group, (shared, four)) in groups(shared, blocks).enumerate() {
            let [x, y, offset] = [xs, ys, &kerbs.offset_m].map(|row| PendingFours::lane(row, group));
            let mut wanted = 0u32;
            for k in 0..WIDE {
                let middle = get(&shared.middle, k);
                let away_m = middle.x * x[k] + middle.y * y[k] - offset[k];
                wanted |= u32::from(away_m < 0.3 + 4.0 * most(shared.along_m[k], shared.up_m[k]));
            }
            if wanted == 0 {
                continue;
            }
            for block in four {
                for k in 0..WIDE {
                    let point = block.point(shared, k);
                    let (place, size) = (point.world, point.footprint_m);
                    let away_m = place.x * x[k] + place.y * y[k] - offset[k];
                    let is_face = one_if((point.normal.z < 0.6) & (away_m < 9.0));
                    let stone = most(band(away_m, -9.0, STONE_M, size), is_face);
                    let behind = band(away_m, STONE_M, STONE_M + JOINT_M, size);
                    let along = (place.y * x[k] - place.x * y[k]) * (1.0 / LENGTH_M);
                    let joint = stripes(along, 0.0, 0.025, size * (1.0 / LENGTH_M));
                    // Stones differ; from far away they do not.
                    let near = most(1.0 - size * 2.0, 0.0);
                    let own = (unit(hash(floor_int(along) as u32, 0x6e5b)) - 0.5) * 0.22 * near;
                    let grain = noise.rough(place.x * 21.0, place.y * 21.0 + place.z * 21.0, size * 21.0) - 0.5;
                    let stones = tone * ((1.0 + own + 0.35 * grain) * (1.0 - 0.5 * joint));
                    let albedo = get(&block.albedo, k) * (1.0 - 0.5 * behind);
                    set(&mut block.albedo, k, albedo.lerp(stones, stone));
                }
            }
        }
    }
}
