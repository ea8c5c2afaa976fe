//! Clothes, skin and hair: round around the middle line of their part, with folds, weave and patterns that move with the body.

use super::lanes::{Block, Shared, WIDE, groups};
use super::pattern::{NoiseTexture, Noises, share, stripes};
use super::surface::Look;
use super::vector::Vec3;
use crate::people::Person;
use cosfly_figures::Pattern;
use cosfly_figures::clothes::Region;
use cosfly_figures::figure::FigureTriangle;
use cosfly_frames::simd_kernel;

/// Rings and lines of a patterned top in a metre.
const PER_METRE: f32 = 14.0;
/// Share of each ring or line that has the other colour.
const OTHER_SHARE: f32 = 0.34;

/// A part of a figure.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cloth {
    pub(super) colour: Vec3,
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
    pub(super) fn new(person: &Person, part: &FigureTriangle) -> Self {
        let to_vec = |[r, g, b]: [f32; 3]| Vec3::new(r, g, b);
        let colour = to_vec(person.colours[part.region as usize]);
        let (rings, lines, other) = match person.pattern {
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

simd_kernel! {
    /// Shades the pixels of a part. Coordinates along and across the part carry noise and pattern: neither crawls over a body
    /// that moves.
    pub(super) fn cloth(shared: &[Shared], blocks: &mut [Block], look: &Cloth, noise: &NoiseTexture) {
        let Cloth { colour, other, rings, lines, from, along, side } = *look;
        let per_length2 = 1.0 / (along.dot(along) + 1e-9);
        let length = along.dot(along).sqrt();
        for (shared, four) in groups(shared, blocks) {
            for block in four {
                for k in 0..WIDE {
                    let point = block.point(shared, k);
                    let away = point.world - from;
                    let height = away.dot(along) * per_length2;
                    let (u, v) = (away.dot(side), height * length);
                    let weave = noise.grain(u * 40.0, v * 40.0, point.footprint_m * 40.0);
                    let fold = noise.clumps(u * 55.0, v * 35.0, point.footprint_m * 45.0);
                    let round = (away - along * share(height)).unit();
                    let normal = (round + point.normal * 0.4).unit();
                    let width = point.footprint_m * PER_METRE;
                    let across = stripes(v * PER_METRE, 0.0, OTHER_SHARE, width) * rings;
                    let down = stripes(u * PER_METRE, 0.0, OTHER_SHARE, width) * lines;
                    let dyed = colour + other * (across + down - across * down);
                    block.put_bent(k, &Look::matt(dyed * (0.62 + 0.25 * weave + 0.5 * fold), normal));
                }
            }
        }
    }
}
