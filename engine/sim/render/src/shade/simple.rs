//! The simple look, for those who want speed: plain colours and windows in the light of sun, sky and haze, without
//! shadows, textures or smooth edges. Colours are worked out once for four pixels; windows for each.

use super::geometry::View;
use cosfly_domain::SemanticLabel;
use cosfly_frames::simd_kernel;
use cosfly_materials::facade::{BoxFace, Facade};
use cosfly_materials::lanes::{Block, FOUR, PendingFours, Shared, StageRow, WIDE, get, groups, three_of, write_three};
use cosfly_materials::light::Light;
use cosfly_materials::tone::ToneCurve;
use cosfly_materials::vector::Vec3;

/// The albedo of ground.
pub fn ground_colour(label: SemanticLabel) -> Vec3 {
    match label {
        SemanticLabel::Roads | SemanticLabel::Bridge => Vec3::splat(0.125),
        SemanticLabel::SideWalks => Vec3::new(0.34, 0.33, 0.315),
        SemanticLabel::RoadLine => Vec3::splat(0.62),
        SemanticLabel::Ground | SemanticLabel::Static | SemanticLabel::Other => Vec3::new(0.23, 0.21, 0.185),
        SemanticLabel::Water => Vec3::new(0.05, 0.09, 0.11),
        _ => Vec3::new(0.085, 0.115, 0.042),
    }
}

/// Light that a dull surface sends to the camera through haze, exposed.
#[inline(always)]
fn seen(shared: &Shared, k: usize, albedo: Vec3) -> Vec3 {
    let arriving = get(&shared.sunny, k) + get(&shared.soft, k);
    albedo * arriving * shared.kept[k] + get(&shared.fog, k)
}

simd_kernel! {
    /// The whole sky sees everything, and no lamp shines.
    pub fn open_sky(shared: &mut [Shared]) {
        for shared in shared.iter_mut() {
            shared.sky = [0.8; WIDE];
            shared.lamps = [0.0; WIDE];
        }
    }
}

simd_kernel! {
    /// Flat surfaces of one colour.
    pub fn even(shared: &[Shared], blocks: &mut [Block], albedo: Vec3, tone: &ToneCurve) {
        for (shared, four) in groups(shared, blocks) {
            let mut bytes = [0; WIDE];
            for (k, bytes) in bytes.iter_mut().enumerate() {
                *bytes = tone.pixel(seen(shared, k, albedo));
            }
            for block in four {
                block.bytes = bytes;
            }
        }
    }
}

simd_kernel! {
    /// Puts a colour on the stage from a four on, sixteen fours at a time: what is too much, the next one writes over.
    pub fn put_colour(colours: &mut [StageRow; 3], first: usize, fours: usize, colour: Vec3) {
        for done in (0..fours).step_by(WIDE) {
            write_three(colours, first.wrapping_add(done), colour);
        }
    }
}

simd_kernel! {
    /// Flat surfaces of one colour for each four.
    pub fn even_fours(shared: &[Shared], blocks: &mut [Block], colours: &[StageRow; 3], tone: &ToneCurve) {
        for (group, (shared, four)) in groups(shared, blocks).enumerate() {
            let mut bytes = [0; WIDE];
            for (k, bytes) in bytes.iter_mut().enumerate() {
                *bytes = tone.pixel(seen(shared, k, three_of(colours, group, k)));
            }
            for block in four {
                block.bytes = bytes;
            }
        }
    }
}

simd_kernel! {
    /// Walls with windows, some of them lit at night.
    pub fn windows(
        shared: &[Shared],
        blocks: &mut [Block],
        facade: &Facade,
        place: &BoxFace,
        light: &Light,
        tone: &ToneCurve,
    ) {
        let (facade, place) = (*facade, *place);
        let glass = Vec3::new(0.08, 0.09, 0.10);
        let lamp = Vec3::new(1.0, 0.72, 0.40) * (0.16 * light.night);
        for (shared, four) in groups(shared, blocks) {
            let (mut walls, mut panes) = ([0; WIDE], [0; WIDE]);
            for k in 0..WIDE {
                walls[k] = tone.pixel(seen(shared, k, facade.wall_colour()));
                panes[k] = tone.pixel(seen(shared, k, glass));
            }
            for block in four.iter_mut() {
                for k in 0..WIDE {
                    block.bytes[k] = mixed(walls[k], panes[k], facade.pane(&place, &block.point(shared, k)).0);
                }
            }
            if light.night > 0.0 {
                let mut lit = [0; WIDE];
                for (k, lit) in lit.iter_mut().enumerate() {
                    *lit = tone.pixel(lamp * shared.kept[k] + get(&shared.fog, k));
                }
                for block in four {
                    for (k, lit) in lit.iter().enumerate() {
                        let (pane, shines) = facade.pane(&place, &block.point(shared, k));
                        block.bytes[k] = mixed(block.bytes[k], *lit, pane * shines);
                    }
                }
            }
        }
    }
}

/// From one pixel's bytes to another's as `t` goes from 0 to 1.
#[inline(always)]
fn mixed(from: u32, to: u32, t: f32) -> u32 {
    let weight = ((t * 255.0 + 12_582_912.0).to_bits() & 0xff).wrapping_add(1);
    let rest = 256u32.wrapping_sub(weight);
    let pair = |bytes: u32, weight: u32| (bytes & 0x00ff_00ff).wrapping_mul(weight);
    let green = |bytes: u32, weight: u32| (bytes & 0xff00).wrapping_mul(weight);
    let outer = pair(from, rest).wrapping_add(pair(to, weight)) >> 8;
    let inner = green(from, rest).wrapping_add(green(to, weight)) >> 8;
    (outer & 0x00ff_00ff) | (inner & 0xff00)
}

simd_kernel! {
    /// A clear sky.
    pub fn sky(blocks: &mut [Block], stage: &PendingFours, view: &View, light: &Light, tone: &ToneCurve) {
        let (view, light) = (*view, *light);
        for (group, four) in blocks.as_chunks_mut::<FOUR>().0.iter_mut().enumerate() {
            let [u, v] = [&stage.u, &stage.v].map(|row| PendingFours::lane(row, group));
            let mut bytes = [0; WIDE];
            for k in 0..WIDE {
                bytes[k] = tone.pixel(light.sky(view.ray(u[k] + 1.5, v[k]).unit()) * light.exposure);
            }
            for block in four {
                block.bytes = bytes;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mixed_pixels_lie_between_both() {
        let (from, to) = (0x00_10_80_ff, 0x00_f0_20_00);
        assert_eq!(mixed(from, to, 1.0), to);
        let half = mixed(from, to, 0.5).to_le_bytes();
        assert_eq!([half[0], half[1], half[2], half[3]], [126, 79, 128, 0]);
        let first = mixed(from, to, 0.0).to_le_bytes();
        assert!(first.iter().zip(from.to_le_bytes()).all(|(a, b)| a.abs_diff(b) <= 1));
    }
}
