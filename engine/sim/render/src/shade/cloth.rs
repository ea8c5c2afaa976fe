//! Clothes, skin and hair: round around the middle line of their part, with folds, weave and patterns that move with the body.

use crate::people::{PartLook, Person};
use cosfly_figures::{Pattern, Region};
use cosfly_frames::simd_kernel;
use cosfly_materials::lanes::{
    Block, EMPTY_ROW, PendingFours, Shared, StageRow, WIDE, groups, three_of, write_row, write_three,
};
use cosfly_materials::pattern::{NoiseTexture, Noises, share, stripes};
use cosfly_materials::surface::Look;
use cosfly_materials::vector::Vec3;

/// Rings and lines of a patterned top in a metre.
const PER_METRE: f32 = 14.0;
/// Share of each ring or line that has the other colour.
const OTHER_SHARE: f32 = 0.34;

/// A part of a figure.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cloth {
    colour: Vec3,
    /// Added to the colour where a pattern has its other one.
    other: Vec3,
    /// 1 where the pattern has rings.
    rings: f32,
    /// 1 where the pattern has lines.
    lines: f32,
    /// Middle line.
    from: Vec3,
    along: Vec3,
    /// To the right of the body, unit length.
    side: Vec3,
}

impl Cloth {
    /// The look of a part of a person.
    pub(super) fn new(person: &Person, part: &PartLook) -> Self {
        let to_vec = |[r, g, b]: [f32; 3]| Vec3::new(r, g, b);
        let colour = to_vec(person.colours[part.region as usize]);
        let (rings, lines, other) = match person.clothes.pattern {
            _ if part.region != Region::Top => (0.0, 0.0, colour),
            Pattern::Plain => (0.0, 0.0, colour),
            Pattern::Rings(other) => (1.0, 0.0, to_vec(other)),
            Pattern::Lines(other) => (0.0, 1.0, to_vec(other)),
            Pattern::Checks(other) => (0.6, 0.6, to_vec(other)),
        };
        let [from, to] = part.middle_in_world.map(Vec3::from);
        Self { colour, other: other - colour, rings, lines, from, along: to - from, side: person.side_in_world }
    }
}

/// Parts of figures on the stage, a part for each four: parts are small on the screen, and all of a picture are shaded together.
pub(super) struct Cloths {
    colour: [StageRow; 3],
    other: [StageRow; 3],
    rings: StageRow,
    lines: StageRow,
    from: [StageRow; 3],
    along: [StageRow; 3],
    side: [StageRow; 3],
}

impl Cloths {
    /// Nothing in particular.
    pub(super) const EMPTY: Self = Self {
        colour: [EMPTY_ROW; 3],
        other: [EMPTY_ROW; 3],
        rings: EMPTY_ROW,
        lines: EMPTY_ROW,
        from: [EMPTY_ROW; 3],
        along: [EMPTY_ROW; 3],
        side: [EMPTY_ROW; 3],
    };
}

simd_kernel! {
    /// Puts a part on the stage from a four on, sixteen fours at a time: what is too much, the next part writes over.
    pub(super) fn put_cloth(cloths: &mut Cloths, first: usize, fours: usize, look: &Cloth) {
        for done in (0..fours).step_by(WIDE) {
            let at = first.wrapping_add(done);
            write_three(&mut cloths.colour, at, look.colour);
            write_three(&mut cloths.other, at, look.other);
            write_row(&mut cloths.rings, at, look.rings);
            write_row(&mut cloths.lines, at, look.lines);
            write_three(&mut cloths.from, at, look.from);
            write_three(&mut cloths.along, at, look.along);
            write_three(&mut cloths.side, at, look.side);
        }
    }
}

simd_kernel! {
    /// Shades the pixels of a part. Coordinates along and across the part carry noise and pattern: neither crawls over a body
    /// that moves.
    pub(super) fn cloth(shared: &[Shared], blocks: &mut [Block], cloths: &Cloths, noise: &NoiseTexture) {
        for (group, (shared, four)) in groups(shared, blocks).enumerate() {
            let [rings, lines] = [&cloths.rings, &cloths.lines].map(|row| PendingFours::lane(row, group));
            let (mut per_length2, mut length) = ([0.0; WIDE], [0.0; WIDE]);
            for k in 0..WIDE {
                let along = three_of(&cloths.along, group, k);
                per_length2[k] = 1.0 / (along.dot(along) + 1e-9);
                length[k] = along.dot(along).sqrt();
            }
            for block in four {
                for k in 0..WIDE {
                    let (colour, other) = (three_of(&cloths.colour, group, k), three_of(&cloths.other, group, k));
                    let (from, along) = (three_of(&cloths.from, group, k), three_of(&cloths.along, group, k));
                    let side = three_of(&cloths.side, group, k);
                    let point = block.point(shared, k);
                    let away = point.world - from;
                    let height = away.dot(along) * per_length2[k];
                    let (u, v) = (away.dot(side), height * length[k]);
                    let weave = noise.grain(u * 40.0, v * 40.0, point.footprint_m * 40.0);
                    // Creases run around the part and turn the cloth up and down.
                    let fold = noise.clumps(u * 22.0 + v * 14.0, v * 58.0, point.footprint_m * 45.0) - 0.5;
                    let round = (away - along * share(height)).unit();
                    let crease = along * (per_length2[k] * length[k] * 1.6 * fold);
                    let normal = (round + point.normal * 0.4 + crease).unit();
                    let width = point.footprint_m * PER_METRE;
                    let across = stripes(v * PER_METRE, 0.0, OTHER_SHARE, width) * rings[k];
                    let down = stripes(u * PER_METRE, 0.0, OTHER_SHARE, width) * lines[k];
                    let dyed = colour + other * (across + down - across * down);
                    block.put_bent(k, &Look::matt(dyed * (0.87 + 0.25 * weave + 0.3 * fold), normal));
                }
            }
        }
    }
}
