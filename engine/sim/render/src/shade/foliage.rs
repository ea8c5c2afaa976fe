//! Ragged edges of crowns and bushes in colours: gaps between clumps and between outer leaves, through which one sees what lies behind.
//!
//! Labels, ids and depth keep the whole crown, as people annotate trees: the gaps between leaves belong to the tree. A gap
//! shows the picture beyond the edge, mirrored at it; where gaps are follows from places in the world, so that they stay on
//! the tree when the camera moves. Only edges before something farther away are broken. People and vehicles are not mirrored: a
//! second wheel or arm would be seen; the colour of their edge goes on.
//!
//! Crowns without leaves are open all over: between twigs and boughs, what lies around the crown is seen, smooth ([`Backdrop`]).

use super::geometry::View;
use super::setting::{Seen, Setting};
use crate::faces::FaceSource;
use crate::passes::ids::{CrownSpan, Run, SeenRuns};
use crate::scene::Scene;
use core::cell::OnceCell;
use cosfly_domain::FrameImages;
use cosfly_materials::backdrop::{Backdrop, is_background};
use cosfly_materials::crown_gaps::{GapPlace, GapPlaces, TOGETHER, crown_gaps, is_body, mixed};
use cosfly_materials::leaves::Leaves;
use cosfly_materials::pattern::{NoiseTexture, hash, unit};

/// Gaps reach this far into a crown, metres.
const REACH_M: f32 = 0.8;
/// Share of a half width that gaps reach at most.
const REACH_SHARE: f32 = 0.33;
/// Pixels that gaps reach at most.
const MOST_PX: f32 = 20.0;
/// What lies beyond the edge of a bare crown is seen sharp in it for less than this, pixels.
const SHARP_PX: usize = 8;
/// How dark boughs are, as a share of twigs.
const BOUGH_SHADE: f32 = 0.45;
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
    /// Number of the pixel, and the colour that is seen through it.
    at: [u32; TOGETHER],
    behind: [[u8; 3]; TOGETHER],
    /// How many pixels the edge is away.
    away: [u8; TOGETHER],
    places: GapPlaces,
    has_bare: bool,
    /// Share of the pixel without leaves.
    gap: [f32; TOGETHER],
    /// Share of the pixel that boughs of a bare crown cover.
    wood: [f32; TOGETHER],
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
    /// What lies behind bare crowns, worked out for the first one.
    backdrop: OnceCell<Backdrop>,
}

impl Foliage {
    /// Breaks the edges of all crowns in a picture.
    pub(crate) fn fray(&mut self, setting: &Setting, scene: &Scene, runs: &SeenRuns, images: &mut FrameImages) {
        self.changes.resize_with(MOST_PX as usize + 1, Vec::new);
        self.changes.iter_mut().for_each(Vec::clear);
        let (width, pixels) = (images.width as usize, images.depth_m.len());
        let waiting = self.waiting.get_or_insert_with(|| Box::new(Waiting::EMPTY));
        let picture = Picture { view: &setting.view, images, backdrop: OnceCell::new() };
        let mut look = |waiting: &mut Waiting| waiting.look(setting, &scene.noise, &mut self.changes);
        for (band, crowns) in runs.crowns(width, pixels) {
            for span in crowns {
                picture.span(span, band + span.start as usize, waiting, &mut look);
            }
        }
        look(waiting);
        for Change { at, behind, part, light } in self.changes.iter().rev().flatten() {
            if let Some(pixel) = images.rgb.get_mut(3 * *at as usize..).and_then(|rest| rest.first_chunk_mut::<3>()) {
                *pixel = mixed(mixed([0; 3], *pixel, *light), *behind, *part);
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
            let gap = Gap { pixel, behind: self.colour(behind), away: k as u8, pixel_m, inside };
            self.add(span, &gap, waiting, look);
        }
    }

    /// Lists a row's pixels of a crown without leaves: all may be gaps between twigs.
    fn bare(&self, span: &CrownSpan, start: usize, waiting: &mut Waiting, look: &mut impl FnMut(&mut Waiting)) {
        let FrameImages { depth_m, rgb, semantic, width, .. } = self.images;
        let (width, length) = (*width as usize, span.length as usize);
        let backdrop = self.backdrop.get_or_init(|| Backdrop::of(rgb, semantic, width));
        let (row, from) = (start / width, start % width);
        let mut smooth = [0; 3];
        for k in 0..length {
            let pixel = start + k;
            let inside = 1.0 - (2.0 * (k as f32 + 0.5) / length as f32 - 1.0).abs();
            let pixel_m = self.view.pixel() * depth_m[pixel];
            // The backdrop is smooth: one place serves two pixels.
            if k % 2 == 0 {
                smooth = backdrop.at(from + k, row);
            }
            let mut behind = smooth;
            // Near the edge, what lies beyond it is seen as it is, mirrored.
            let steps = k.min(length - 1 - k);
            let there = if steps == k { start.wrapping_sub(k + 1) } else { pixel + 2 * steps + 1 };
            if steps < SHARP_PX
                && there / width == row
                && is_background(semantic[there])
                && depth_m[there] >= depth_m[pixel] + 0.3
            {
                behind = mixed(self.colour(there), behind, (256 * steps / SHARP_PX) as i32);
            }
            self.add(span, &Gap { pixel, behind, away: 0, pixel_m, inside }, waiting, look);
        }
    }

    /// The colour of a pixel.
    fn colour(&self, pixel: usize) -> [u8; 3] {
        self.images.rgb.get(3 * pixel..).and_then(|rest| rest.first_chunk()).copied().unwrap_or_default()
    }

    /// Puts a pixel behind those that wait, and looks when there are many.
    fn add(&self, span: &CrownSpan, gap: &Gap, waiting: &mut Waiting, look: &mut impl FnMut(&mut Waiting)) {
        let FrameImages { depth_m, width, .. } = self.images;
        let (at, pixel) = (waiting.count, gap.pixel as u32);
        (waiting.at[at], waiting.behind[at], waiting.away[at]) = (pixel, gap.behind, gap.away);
        let place = GapPlace {
            crown: &span.outline,
            is_bare: span.is_bare,
            shift: 97.0 * unit(hash(span.instance, 12)),
            ray: self.view.ray((pixel % *width) as f32 + 0.5, (pixel / *width) as f32 + 0.5),
            depth_m: depth_m[gap.pixel],
            pixel_m: gap.pixel_m,
            inside: gap.inside,
        };
        waiting.places.put(at, &place);
        waiting.has_bare |= span.is_bare;
        waiting.count += 1;
        if waiting.count == TOGETHER {
            look(waiting);
        }
    }
}

/// A pixel that may be a gap.
struct Gap {
    pixel: usize,
    /// The colour that is seen through it.
    behind: [u8; 3],
    /// How many pixels the edge is away.
    away: u8,
    /// Size of a pixel there, metres, and how far inside the crown it is, as a share of how far gaps reach.
    pixel_m: f32,
    inside: f32,
}

impl Waiting {
    const EMPTY: Self = Self {
        count: 0,
        at: [0; TOGETHER],
        behind: [[0; 3]; TOGETHER],
        away: [0; TOGETHER],
        places: GapPlaces::EMPTY,
        has_bare: false,
        gap: [0.0; TOGETHER],
        wood: [0.0; TOGETHER],
    };

    /// Tells how much of the pixels that wait is gap, and notes their colours.
    fn look(&mut self, setting: &Setting, noise: &NoiseTexture, changes: &mut [Vec<Change>]) {
        let has_bare = core::mem::take(&mut self.has_bare);
        crown_gaps(setting.level, &self.places, setting.view.position, noise, has_bare, &mut self.gap, &mut self.wood);
        for at in 0..core::mem::take(&mut self.count) {
            if self.gap[at] + self.wood[at] > 0.0 {
                let part = (self.gap[at] * 256.0) as i32;
                let light = (256.0 - (1.0 - BOUGH_SHADE) * 256.0 * self.wood[at]) as i32;
                let change = Change { at: self.at[at], behind: self.behind[at], part, light };
                changes[usize::from(self.away[at])].push(change);
            }
        }
    }
}

/// The crown that a face belongs to.
pub(super) fn crown_of<'a>(seen: &Seen<'a>, face: u32) -> Option<&'a Leaves> {
    let FaceSource::Crown { index, .. } = seen.faces.get(face as usize)?.source else { return None };
    seen.scene.crowns.get(index as usize)?.as_ref()
}
