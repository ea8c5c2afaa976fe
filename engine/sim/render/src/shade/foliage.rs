//! Ragged edges of crowns and bushes in colours: gaps between clumps and between outer leaves, through which one sees what lies behind.
//!
//! Labels, ids and depth keep the whole crown, as people annotate trees: the gaps between leaves belong to the tree. A gap
//! shows the picture beyond the edge, mirrored at it; where gaps are follows from places in the world, so that they stay on
//! the tree when the camera moves. Only edges before something farther away are broken. People and vehicles are not mirrored: a
//! second wheel or arm would be seen; the colour of their edge goes on.
//!
//! Crowns without leaves are open all over: between twigs and boughs, what lies beside the crown is seen.

use super::geometry::View;
use super::setting::{Seen, Setting};
use crate::faces::FaceSource;
use crate::passes::ids::{CrownSpan, Run, SeenRuns};
use crate::scene::Scene;
use cosfly_domain::{FrameImages, SemanticLabel};
use cosfly_frames::simd_kernel;
use cosfly_materials::boughs::boughs;
use cosfly_materials::clumps::CrownRays;
use cosfly_materials::leaves::{LeafCrown, Leaves};
use cosfly_materials::pattern::{NoiseTexture, Noises, hash, least, lerp, most, share, smoothstep, unit};
use cosfly_materials::vector::Vec3;

/// Gaps reach this far into a crown, metres.
const REACH_M: f32 = 0.8;
/// Share of a half width that gaps reach at most.
const REACH_SHARE: f32 = 0.33;
/// Pixels that gaps reach at most.
const MOST_PX: f32 = 20.0;
/// How thin leaves must be for a gap: at the edge, and that much more at the end of its reach.
const THIN: [f32; 2] = [0.96, 0.78];
/// How far from the middle of a twig a gap begins: at the rim of a bare crown, and that much more in its middle.
const BARE_THIN: [f32; 2] = [0.03, 0.02];
/// How much of a pixel is open where twigs are thinner than it, and how dark boughs are, as a share of twigs.
const BARE_OPEN: f32 = 0.8;
const BOUGH_SHADE: f32 = 0.45;
/// How fast leaves become a gap as noise grows: edges of leaves are soft, so that no pixel pops.
const STEEPNESS: f32 = 8.0;
/// How fast leaves get thin beyond clumps, and how much at most; within clumps they are as much denser.
const BEYOND: f32 = 3.0;
const MOST_BEYOND: f32 = 0.6;
/// How much denser twigs are within clumps at most.
const BARE_DENSER: f32 = 0.045;
/// Pixels whose leaves are looked at together.
const TOGETHER: usize = 256;

/// Notes the pixels of a run that shows a crown; neighbours of one crown become one span.
pub(super) fn note(seen: &Seen<'_>, run: &Run, width: usize, crowns: &mut Vec<CrownSpan>) {
    let (Some(leaves), Some(face)) = (crown_of(seen, run.face), seen.faces.get(run.face as usize)) else { return };
    let outline = leaves.outline();
    if let Some(last) = crowns.last_mut()
        && last.start + last.length == run.start
        && last.instance == face.instance
        && last.outline == outline
        && !(run.start as usize).is_multiple_of(width)
    {
        last.length += run.length;
        return;
    }
    let is_bare = leaves.is_bare();
    let reach_m = REACH_M.min(REACH_SHARE * leaves.half_width_m());
    crowns.push(CrownSpan { start: run.start, length: run.length, instance: face.instance, reach_m, is_bare, outline });
}

/// Buffers of the pass.
#[derive(Default)]
pub struct Foliage {
    waiting: Option<Box<Waiting>>,
    /// Changes by how many pixels the edge is away that they come from. Edges in a row and in a column both open a pixel: the
    /// nearer one comes last, so that what is behind it is seen where both are open.
    changes: Vec<Vec<Change>>,
}

/// A pixel, the colour behind it, and how much of that is seen and how much lighter boughs there make it, of 256 each.
struct Change {
    at: u32,
    behind: [u8; 3],
    part: i32,
    light: i32,
}

/// Pixels near an edge that may be gaps.
struct Waiting {
    count: usize,
    /// Number of the pixel, and of those that are seen through it, and how much of the second one.
    at: [u32; TOGETHER],
    behind: [[u32; 2]; TOGETHER],
    right: [f32; TOGETHER],
    /// How many pixels the edge is away.
    away: [u8; TOGETHER],
    place: Places,
    /// Share of the pixel without leaves.
    gap: [f32; TOGETHER],
    /// Share of the pixel that boughs of a bare crown cover.
    wood: [f32; TOGETHER],
}

/// Where they are, and how thin leaves must be.
struct Places {
    /// Centre from the left and the top, pixels.
    u: [f32; TOGETHER],
    v: [f32; TOGETHER],
    depth_m: [f32; TOGETHER],
    /// Size of a pixel at the edge, metres.
    pixel_m: [f32; TOGETHER],
    /// Where the pattern of the tree begins.
    shift: [f32; TOGETHER],
    /// Pixels with more of a gap than this have some of one.
    least: [f32; TOGETHER],
    /// One where there are twigs and no leaves.
    bare: [f32; TOGETHER],
    /// Middles of round crowns, metres, and one divided by half their size.
    middle: [[f32; TOGETHER]; 3],
    shrink: [[f32; TOGETHER]; 3],
    /// Cosine and sine of how clumps are turned.
    turn: [[f32; TOGETHER]; 2],
}

/// An edge of a crown: from the first pixel inside, by steps of `inward` pixels.
struct Edge {
    first: usize,
    /// Step between pixels, away from the edge.
    inward: isize,
    /// Pixels of the crown from the edge on, at most.
    most: usize,
    /// Pixels beyond the edge within the picture, at most.
    beyond: usize,
}

/// A picture whose crowns are broken.
struct Picture<'a> {
    view: &'a View,
    images: &'a FrameImages,
}

impl Foliage {
    /// Breaks the edges of all crowns in a picture.
    pub(crate) fn fray(&mut self, setting: &Setting, scene: &Scene, runs: &SeenRuns, images: &mut FrameImages) {
        self.changes.resize_with(MOST_PX as usize + 1, Vec::new);
        self.changes.iter_mut().for_each(Vec::clear);
        let (width, pixels) = (images.width as usize, images.depth_m.len());
        let waiting = self.waiting.get_or_insert_with(|| Box::new(Waiting::EMPTY));
        let picture = Picture { view: &setting.view, images };
        let mut look = |waiting: &mut Waiting| waiting.look(setting, &scene.noise, images, &mut self.changes);
        for (band, crowns) in runs.crowns(width, pixels) {
            for span in crowns {
                picture.span(span, band + span.start as usize, waiting, &mut look);
            }
        }
        look(waiting);
        for Change { at, behind, part, light } in self.changes.iter().rev().flatten() {
            if let Some(pixel) = images.rgb.get_mut(3 * *at as usize..).and_then(|rest| rest.first_chunk_mut::<3>()) {
                let own = pixel.map(|own| light.wrapping_mul(i32::from(own)) >> 8);
                let mixed = |k: usize| own[k] + (part.wrapping_mul(i32::from(behind[k]) - own[k]) >> 8);
                *pixel = [0, 1, 2].map(|k| mixed(k) as u8);
            }
        }
    }
}

impl Picture<'_> {
    /// The edges of a tree's pixels in a row, from the pixel `start` on.
    fn span(&self, span: &CrownSpan, start: usize, waiting: &mut Waiting, look: &mut impl FnMut(&mut Waiting)) {
        let (width, height) = (self.images.width as usize, self.images.height as usize);
        let (row, from, length) = (start / width, start % width, span.length as usize);
        if span.is_bare {
            self.bare(span, start, waiting, look);
            return;
        }
        let mut edge = |edge: Edge| self.edge(span, &edge, waiting, look);
        edge(Edge { first: start, inward: 1, most: length, beyond: from });
        edge(Edge { first: start + length - 1, inward: -1, most: length, beyond: width - from - length });
        let (down, instance) = (width as isize, &self.images.instance);
        if row > 0 {
            for (at, _) in
                instance[start - width..][..length].iter().enumerate().filter(|(_, id)| **id != span.instance)
            {
                edge(Edge { first: start + at, inward: down, most: height - row, beyond: row });
            }
        }
        if row + 1 < height {
            for (at, _) in
                instance[start + width..][..length].iter().enumerate().filter(|(_, id)| **id != span.instance)
            {
                edge(Edge { first: start + at, inward: -down, most: row + 1, beyond: height - row - 1 });
            }
        }
    }

    /// Lists the pixels of an edge that may be gaps.
    fn edge(&self, span: &CrownSpan, edge: &Edge, waiting: &mut Waiting, look: &mut impl FnMut(&mut Waiting)) {
        let Edge { first, inward, most, beyond } = *edge;
        let FrameImages { depth_m, semantic, instance, .. } = self.images;
        let depth = depth_m[first];
        if beyond == 0 {
            return;
        }
        let outside = first.wrapping_add_signed(-inward);
        // Nothing farther away, or another face of the same tree.
        if depth_m[outside] < depth + 0.3 || instance[outside] == span.instance {
            return;
        }
        let is_body = is_body(semantic[outside]);
        let pixel_m = self.view.pixel() * depth;
        let reach = (span.reach_m / pixel_m).min(MOST_PX);
        let count = (reach as usize).min(most).min(beyond);
        for k in 0..count {
            let pixel = first.wrapping_add_signed(inward * k as isize);
            if instance[pixel] != span.instance {
                break;
            }
            let depth = depth_m[pixel];
            let behind = first.wrapping_add_signed(-inward * (k as isize / 2 + 1));
            if depth_m[behind] < depth + 0.3 {
                continue;
            }
            // One surface only: what stands beyond the edge, and lines on the ground, have no image within the crown.
            let is_same = instance[behind] == instance[outside] && semantic[behind] == semantic[outside];
            let behind = if is_same && !is_body { behind } else { outside };
            // Fewer gaps farther inside: dents between branches, ragged by leaves.
            let inside = (k as f32 + 0.5) / reach;
            waiting.add(Gap { pixel, behind: [behind; 2], right: 0.0, away: k as u8 });
            self.place(span, pixel_m, THIN[0] + THIN[1] * inside, waiting, look);
        }
    }

    /// Lists a row's pixels of a crown without leaves: all may be gaps between twigs. What is behind lies on both sides, and goes
    /// over from one to the other.
    fn bare(&self, span: &CrownSpan, start: usize, waiting: &mut Waiting, look: &mut impl FnMut(&mut Waiting)) {
        let FrameImages { depth_m, semantic, instance, width, .. } = self.images;
        let (width, length) = (*width as usize, span.length as usize);
        let ends = [start, start + length - 1];
        let room = [start % width, width - 1 - ends[1] % width];
        let outside = [start.wrapping_sub(1), start + length];
        let is_open = [0, 1].map(|side| {
            room[side] > 0
                && depth_m[outside[side]] >= depth_m[ends[side]] + 0.3
                && instance[outside[side]] != span.instance
        });
        for k in 0..length {
            let (pixel, steps) = (start + k, [k, length - 1 - k]);
            let behind = [0, 1].map(|side| {
                if !is_open[side] {
                    return pixel;
                }
                let away = (steps[side] / 2 + 1).min(room[side]);
                let there = if side == 0 { start - away } else { ends[1] + away };
                let is_same = instance[there] == instance[outside[side]] && semantic[there] == semantic[outside[side]];
                let is_behind = is_same && depth_m[there] >= depth_m[pixel] + 0.3 && !is_body(semantic[there]);
                if is_behind { there } else { outside[side] }
            });
            let along = (k as f32 + 0.5) / length as f32;
            let right = match is_open {
                [true, true] => smoothstep(0.2, 0.8, along),
                [false, true] => 1.0,
                _ => 0.0,
            };
            let inside = 1.0 - (2.0 * along - 1.0).abs();
            waiting.add(Gap { pixel, behind, right, away: 0 });
            let pixel_m = self.view.pixel() * depth_m[pixel];
            self.place(span, pixel_m, BARE_THIN[0] + BARE_THIN[1] * inside, waiting, look);
        }
    }

    /// Tells where the pixel is that was added last, and looks when many wait.
    fn place(
        &self,
        span: &CrownSpan,
        pixel_m: f32,
        least: f32,
        waiting: &mut Waiting,
        look: &mut impl FnMut(&mut Waiting),
    ) {
        let FrameImages { depth_m, width, .. } = self.images;
        let (at, outline) = (waiting.count, span.outline);
        let pixel = waiting.at[at];
        let place = &mut waiting.place;
        place.u[at] = (pixel % *width) as f32 + 0.5;
        place.v[at] = (pixel / *width) as f32 + 0.5;
        place.depth_m[at] = depth_m[pixel as usize];
        place.pixel_m[at] = pixel_m;
        place.shift[at] = 97.0 * unit(hash(span.instance, 12));
        for (rows, v) in [(&mut place.middle, outline.middle), (&mut place.shrink, outline.shrink)] {
            (rows[0][at], rows[1][at], rows[2][at]) = (v.x, v.y, v.z);
        }
        (place.turn[0][at], place.turn[1][at]) = (outline.turn[0], outline.turn[1]);
        place.bare[at] = f32::from(u8::from(span.is_bare));
        place.least[at] = least;
        waiting.count += 1;
        if waiting.count == TOGETHER {
            look(waiting);
        }
    }
}

/// A pixel that may be a gap.
struct Gap {
    pixel: usize,
    /// What is seen through it, on two sides, and how much of the second.
    behind: [usize; 2],
    right: f32,
    /// How many pixels the edge is away.
    away: u8,
}

impl Waiting {
    const EMPTY: Self = Self {
        count: 0,
        at: [0; TOGETHER],
        behind: [[0; 2]; TOGETHER],
        right: [0.0; TOGETHER],
        away: [0; TOGETHER],
        place: Places {
            u: [0.0; TOGETHER],
            v: [0.0; TOGETHER],
            depth_m: [1.0; TOGETHER],
            pixel_m: [1.0; TOGETHER],
            shift: [0.0; TOGETHER],
            least: [0.0; TOGETHER],
            bare: [0.0; TOGETHER],
            middle: [[0.0; TOGETHER]; 3],
            shrink: [[1.0; TOGETHER]; 3],
            turn: [[0.0; TOGETHER]; 2],
        },
        gap: [0.0; TOGETHER],
        wood: [0.0; TOGETHER],
    };

    /// Puts a pixel behind those that wait.
    fn add(&mut self, gap: Gap) {
        let at = self.count;
        (self.at[at], self.behind[at]) = (gap.pixel as u32, gap.behind.map(|behind| behind as u32));
        (self.right[at], self.away[at]) = (gap.right, gap.away);
    }

    /// Tells how much of the pixels that wait is gap, and notes their colours.
    fn look(&mut self, setting: &Setting, noise: &NoiseTexture, images: &FrameImages, changes: &mut [Vec<Change>]) {
        gaps(setting.level, &self.place, &setting.view, noise, &mut self.gap);
        let is_bare = self.place.bare[..self.count].contains(&1.0);
        if is_bare {
            wood(setting.level, &self.place, &setting.view, &mut self.gap, &mut self.wood);
        } else {
            self.wood.fill(0.0);
        }
        for at in 0..core::mem::take(&mut self.count) {
            let colour = |pixel: u32| images.rgb.get(3 * pixel as usize..).and_then(|rest| rest.first_chunk::<3>());
            if self.gap[at] + self.wood[at] > 0.0
                && let [Some(left), Some(right)] = self.behind[at].map(colour)
            {
                let share = (256.0 * self.right[at]) as i32;
                let behind = [0, 1, 2].map(|k| {
                    let (left, right) = (i32::from(left[k]), i32::from(right[k]));
                    (left + (share.wrapping_mul(right - left) >> 8)) as u8
                });
                let (part, light) =
                    ((self.gap[at] * 256.0) as i32, (256.0 - (1.0 - BOUGH_SHADE) * 256.0 * self.wood[at]) as i32);
                changes[usize::from(self.away[at])].push(Change { at: self.at[at], behind, part, light });
            }
        }
    }
}

simd_kernel! {
    /// Share of pixels without leaves. Noise of leaves and of branches stays where it is in the world while the camera moves little.
    fn gaps(places: &Places, view: &View, noise: &NoiseTexture, gap: &mut [f32; TOGETHER]) {
        let view = *view;
        let (mut rays, mut met) = (CrownRays::EMPTY, [0.0; TOGETHER]);
        for k in 0..TOGETHER {
            let [middle, shrink] = [&places.middle, &places.shrink].map(|rows| Vec3::new(rows[0][k], rows[1][k], rows[2][k]));
            let outline = LeafCrown { middle, shrink, turn: [places.turn[0][k], places.turn[1][k]] };
            rays.put(k, outline.ray(view.position, view.ray(places.u[k], places.v[k])));
        }
        rays.most_met(&mut met);
        for (k, gap) in gap.iter_mut().enumerate() {
            let ray = view.ray(places.u[k], places.v[k]);
            let place = view.position + ray * places.depth_m[k];
            let beyond = least(most(-BEYOND * met[k], lerp(-MOST_BEYOND, -BARE_DENSER, places.bare[k])), MOST_BEYOND);
            // No face of a box is seen edge-on in these two directions.
            let x = 0.8 * place.x + 0.45 * place.y + 0.3 * place.z;
            let y = 0.35 * place.x - 0.7 * place.y + 0.85 * place.z;
            let (pixel_m, shift) = (places.pixel_m[k], places.shift[k]);
            let leaves = noise.rough(x * 26.0 + shift, y * 26.0, pixel_m * 26.0);
            let branches = noise.clumps(x * 15.0, y * 15.0 + shift, pixel_m * 15.0);
            let twigs = 0.35 * (branches - 0.5).abs() + (leaves - 0.5).abs();
            // Twigs that are thinner than a pixel cover a part of it.
            let fine = share(0.8 * (pixel_m * 20.0 - 0.5));
            let twigs = lerp(twigs, places.least[k] + BARE_OPEN / STEEPNESS, fine);
            let thin = lerp(1.7 * branches + 0.75 * leaves, twigs, places.bare[k]);
            *gap = share((thin + beyond - places.least[k]) * STEEPNESS);
        }
    }
}

simd_kernel! {
    /// Share of pixels of bare crowns that boughs cover; there are no gaps there.
    fn wood(places: &Places, view: &View, gap: &mut [f32; TOGETHER], wood: &mut [f32; TOGETHER]) {
        let view = *view;
        for k in 0..TOGETHER {
            let [middle, shrink] = [&places.middle, &places.shrink].map(|rows| Vec3::new(rows[0][k], rows[1][k], rows[2][k]));
            let outline = LeafCrown { middle, shrink, turn: [places.turn[0][k], places.turn[1][k]] };
            let ray = outline.ray(view.position, view.ray(places.u[k], places.v[k]));
            let pixel = most(places.pixel_m[k] * least(shrink.x, shrink.z), 1e-4);
            wood[k] = boughs(ray, pixel) * places.bare[k];
            gap[k] *= 1.0 - wood[k];
        }
    }
}

/// Whether a label is one of people, vehicles and what they take along.
fn is_body(label: u8) -> bool {
    (SemanticLabel::Pedestrian.id()..=SemanticLabel::Bicycle.id()).contains(&label)
        || label == SemanticLabel::Dynamic.id()
}

/// The crown that a face belongs to.
pub(super) fn crown_of<'a>(seen: &Seen<'a>, face: u32) -> Option<&'a Leaves> {
    let FaceSource::Crown { index, .. } = seen.faces.get(face as usize)?.source else { return None };
    seen.scene.crowns.get(index as usize)?.as_ref()
}
