//! Ragged edges of crowns and bushes in colours: gaps between the outer leaves, through which one sees what lies behind.
//!
//! Labels, ids and depth keep the whole crown, as people annotate trees: the gaps between leaves belong to the tree. A gap
//! shows the picture beyond the edge, mirrored at it; where gaps are follows from places in the world, so that they stay on
//! the tree when the camera moves. Only edges before something farther away are broken.

use super::geometry::View;
use super::pattern::{Noises, hash, unit};
use super::vector::Vec3;
use crate::faces::{DrawnFace, FaceSource};
use crate::frame::FrameImages;
use crate::passes::ids::Run;
use crate::scene::Scene;

/// Gaps reach this far into a crown, metres.
const REACH_M: f32 = 0.6;
/// And no farther than this share of its half width.
const REACH_SHARE: f32 = 0.28;
/// And no farther than this, pixels.
const MOST_PX: f32 = 20.0;

/// Buffers of the pass.
#[derive(Default)]
pub struct Foliage {
    /// First byte of a pixel, and its new colour.
    changes: Vec<(u32, [u8; 3])>,
}

/// The finished channels and the scene that they show.
pub(crate) struct Crowns<'a> {
    pub scene: &'a Scene,
    pub faces: &'a [DrawnFace],
    pub view: &'a View,
}

/// An edge of a crown: from the first pixel inside, by steps of `inward` bytes' pixels.
struct Edge {
    first: usize,
    /// Step between pixels, away from the edge.
    inward: isize,
    /// Pixels of the crown from the edge on, at most.
    most: usize,
    /// Pixels beyond the edge within the picture, at most.
    beyond: usize,
    tree: Tree,
}

/// A tree or bush.
#[derive(Clone, Copy)]
struct Tree {
    instance: u32,
    /// Gaps reach this far into it, metres.
    reach_m: f32,
}

impl Foliage {
    /// Breaks the edges of all crowns in a picture.
    pub(crate) fn fray<'a>(
        &mut self,
        crowns: &Crowns<'_>,
        rows: impl Iterator<Item = &'a [Run]>,
        images: &mut FrameImages,
    ) {
        self.changes.clear();
        for (row, runs) in rows.enumerate() {
            let mut column = 0;
            let mut span: Option<(usize, usize, Tree)> = None;
            for run in runs {
                let (from, to) = (column, column + run.length as usize);
                column = to;
                let tree = crowns.tree(run.face);
                match (&mut span, tree) {
                    (Some((_, end, of)), Some(tree)) if of.instance == tree.instance && *end == from => *end = to,
                    _ => {
                        if let Some(done) = span.take() {
                            self.span(crowns, images, row, done);
                        }
                        span = tree.map(|tree| (from, to, tree));
                    }
                }
            }
            if let Some(done) = span.take() {
                self.span(crowns, images, row, done);
            }
        }
        for (at, colour) in &self.changes {
            if let Some(pixel) = images.rgb.get_mut(*at as usize..).and_then(|rest| rest.first_chunk_mut::<3>()) {
                *pixel = *colour;
            }
        }
    }

    /// The edges of a tree's pixels from `from` to before `to` in a row.
    fn span(&mut self, crowns: &Crowns<'_>, images: &FrameImages, row: usize, (from, to, tree): (usize, usize, Tree)) {
        let (width, height) = (images.width as usize, images.height as usize);
        let (start, length) = (row * width, to - from);
        let left = Edge { first: start + from, inward: 1, most: length, beyond: from, tree };
        let right = Edge { first: start + to - 1, inward: -1, most: length, beyond: width - to, tree };
        self.edge(crowns, images, &left);
        self.edge(crowns, images, &right);
        let down = width as isize;
        let others = |first: usize| {
            images.instance[first..first + length].iter().enumerate().filter(|(_, id)| **id != tree.instance)
        };
        if row > 0 {
            for (at, _) in others(start + from - width) {
                let first = start + from + at;
                self.edge(crowns, images, &Edge { first, inward: down, most: height - row, beyond: row, tree });
            }
        }
        if row + 1 < height {
            for (at, _) in others(start + from + width) {
                let (first, beyond) = (start + from + at, height - row - 1);
                self.edge(crowns, images, &Edge { first, inward: -down, most: row + 1, beyond, tree });
            }
        }
    }

    fn edge(&mut self, crowns: &Crowns<'_>, images: &FrameImages, edge: &Edge) {
        let Edge { first, inward, most, beyond, tree: Tree { instance, reach_m } } = *edge;
        let depth = images.depth_m[first];
        if beyond == 0 {
            return;
        }
        let outside = first.wrapping_add_signed(-inward);
        // Nothing farther away, or another face of the same tree.
        if images.depth_m[outside] < depth + 0.3 || images.instance[outside] == instance {
            return;
        }
        let pixels_per_m = 1.0 / (crowns.view.pixel() * depth);
        let reach = (reach_m * pixels_per_m).min(MOST_PX);
        let count = (reach as usize).min(most).min(beyond);
        for k in 0..count {
            let pixel = first.wrapping_add_signed(inward * k as isize);
            if images.instance[pixel] != instance {
                break;
            }
            let depth = images.depth_m[pixel];
            let [leaves, branches] = crowns.gaps(pixel, images.width as usize, depth, instance, 1.0 / pixels_per_m);
            // Fewer gaps farther inside: dents between branches, ragged by leaves.
            let inside = (k as f32 + 0.5) / reach;
            if 1.7 * branches + 0.75 * leaves < 1.02 + 0.78 * inside {
                continue;
            }
            let behind = first.wrapping_add_signed(-inward * (k as isize / 2 + 1));
            if images.depth_m[behind] < depth + 0.3 {
                continue;
            }
            // One thing only: what stands beyond the edge has no image within the crown.
            let is_same = images.instance[behind] == images.instance[outside];
            let behind = if is_same { behind } else { outside };
            if let Some(colour) = images.rgb.get(3 * behind..).and_then(|rest| rest.first_chunk::<3>()) {
                self.changes.push((3 * pixel as u32, *colour));
            }
        }
    }
}

impl Crowns<'_> {
    /// The tree or bush that a face belongs to.
    fn tree(&self, face: u32) -> Option<Tree> {
        let face = self.faces.get(face as usize)?;
        let FaceSource::Box { index, .. } = face.source else { return None };
        let leaves = self.scene.crowns[index as usize].as_ref()?;
        Some(Tree { instance: face.instance, reach_m: REACH_M.min(REACH_SHARE * leaves.half_width_m()) })
    }

    /// Noise of the leaves and of the branches at a pixel, 0 to 1: both stay where they are in the world while the camera
    /// moves little.
    fn gaps(&self, pixel: usize, width: usize, depth: f32, tree: u32, pixel_m: f32) -> [f32; 2] {
        let (u, v) = ((pixel % width) as u16, (pixel / width) as u16);
        let ray = self.view.ray(f32::from(u) + 0.5, f32::from(v) + 0.5);
        let place: Vec3 = self.view.position + ray * depth;
        let shift = 97.0 * unit(hash(tree, 12));
        // No face of a box is seen edge-on in these two directions.
        let (x, y) = (0.8 * place.x + 0.45 * place.y + 0.3 * place.z, 0.35 * place.x - 0.7 * place.y + 0.85 * place.z);
        let noise = &self.scene.noise;
        [
            noise.rough(x * 26.0 + shift, y * 26.0, pixel_m * 26.0),
            noise.clumps(x * 15.0, y * 15.0 + shift, pixel_m * 15.0),
        ]
    }
}
