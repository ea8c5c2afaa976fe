//! Planar depth, semantic and instance ids in bands of rows, from the faces seen in them.

use crate::faces::{DrawnFace, FaceSource};
use cosfly_domain::{FrameImages, SemanticLabel};
use cosfly_frames::simd::Level;
use cosfly_frames::simd_kernel;
use cosfly_materials::leaves::LeafCrown;
use cosfly_raster::visibility::NO_FACE;
use rayon::prelude::*;

/// Rows of a band, the piece of an image that one thread works on.
const BAND_ROWS: usize = 24;
/// An image of so few pixels is one band: its faces are small, and kernels take pixels of one face together.
const ONE_BAND_PIXELS: usize = 1 << 16;

/// Rows of the bands of an image: they follow from its size alone, as kernels work out shadows of pixels together.
fn band_rows(width: usize, pixels: usize) -> usize {
    if pixels <= ONE_BAND_PIXELS { (pixels / width.max(1)).max(1) } else { BAND_ROWS }
}

/// Neighbouring pixels of one face in a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Run {
    /// From the start of the band, pixels.
    pub start: u32,
    /// Pixels.
    pub length: u32,
    /// Number of the face, or [`NO_FACE`].
    pub face: u32,
    /// Equal for runs of one surface: a box face, ground of one label, a person, the sky.
    pub surface: u32,
}

/// Neighbouring pixels of one tree's or bush's crown in a row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CrownSpan {
    /// From the start of the band, pixels.
    pub start: u32,
    /// Pixels.
    pub length: u32,
    pub instance: u32,
    /// Broken edges reach this far into the crown, metres.
    pub reach_m: f32,
    /// Twigs without leaves.
    pub is_bare: bool,
    pub outline: LeafCrown,
}

/// The runs of faces seen, by band.
#[derive(Default)]
pub(crate) struct SeenRuns(Vec<BandRuns>);

/// The runs of a band.
#[derive(Clone, Default)]
pub(crate) struct BandRuns {
    /// Row by row.
    pub all: Vec<Run>,
    /// Pixels of crowns, row by row.
    pub crowns: Vec<CrownSpan>,
    /// End of each row's runs.
    row_ends: Vec<usize>,
    /// Bits of the places where a row's faces change.
    changes: Vec<u64>,
}

impl SeenRuns {
    /// Makes all surfaces one but those of the faces that `is_apart` tells.
    pub fn join_surfaces(&mut self, is_apart: impl Fn(u32) -> bool) {
        let runs = self.0.iter_mut().flat_map(|band| &mut band.all);
        runs.filter(|run| !is_apart(run.face)).for_each(|run| run.surface = NO_FACE);
    }

    /// The runs of each row, from the top.
    pub fn rows(&self) -> impl Iterator<Item = &[Run]> {
        self.0.iter().flat_map(|band| {
            let starts = core::iter::once(0).chain(band.row_ends.iter().copied());
            starts.zip(&band.row_ends).map(|(start, end)| &band.all[start..*end])
        })
    }

    /// Pixels of crowns in each band of an image with so many pixels and so many in a row, and the band's first pixel.
    pub fn crowns(&self, width: usize, pixels: usize) -> impl Iterator<Item = (usize, &[CrownSpan])> {
        let band_pixels = width * band_rows(width, pixels);
        self.0.iter().enumerate().map(move |(band, runs)| (band * band_pixels, runs.crowns.as_slice()))
    }
}

/// All channels of a band.
pub(crate) struct Band<'a> {
    /// Rows above it.
    pub first_row: usize,
    pub width: usize,
    /// Runs of faces.
    pub runs: &'a mut BandRuns,
    /// Face numbers.
    ids: &'a [u32],
    pub depth_m: &'a mut [f32],
    semantic: &'a mut [u8],
    instance: &'a mut [u32],
    pub rgb: &'a mut [u8],
}

/// Visits all bands of an image, on request with all threads of the pool that calls.
pub(crate) fn for_each_band(
    parallel: bool,
    faces_seen: &[u32],
    images: &mut FrameImages,
    seen: &mut SeenRuns,
    visit: impl Fn(Band<'_>) + Sync,
) {
    let width = images.width as usize;
    if width == 0 {
        return;
    }
    let rows = band_rows(width, faces_seen.len());
    let pixels = rows * width;
    seen.0.resize(faces_seen.len().div_ceil(pixels), BandRuns::default());
    let FrameImages { rgb, depth_m, semantic, instance, .. } = images;
    macro_rules! visit_all {
        ($iterate:ident, $chunks:ident, $chunks_mut:ident) => {
            (seen.0.$iterate().zip(faces_seen.$chunks(pixels)))
                .zip(depth_m.$chunks_mut(pixels).zip(semantic.$chunks_mut(pixels)))
                .zip(instance.$chunks_mut(pixels).zip(rgb.$chunks_mut(3 * pixels)))
                .enumerate()
                .for_each(|(band, (((runs, ids), (depth_m, semantic)), (instance, rgb)))| {
                    let first_row = band * rows;
                    visit(Band { first_row, width, runs, ids, depth_m, semantic, instance, rgb });
                })
        };
    }
    if parallel {
        visit_all!(par_iter_mut, par_chunks, par_chunks_mut);
    } else {
        visit_all!(iter_mut, chunks, chunks_mut);
    }
}

impl Band<'_> {
    /// Fills the exact channels and lists the runs.
    pub fn resolve(&mut self, level: Level, faces: &[DrawnFace]) {
        let runs = &mut *self.runs;
        runs.all.clear();
        runs.crowns.clear();
        runs.row_ends.clear();
        runs.changes.resize(self.width.div_ceil(64), 0);
        for (row, ids) in self.ids.chunks_exact(self.width).enumerate() {
            differences(level, &ids[1..], &ids[..self.width - 1], &mut runs.changes);
            let start = (row * self.width) as u32;
            let mut from = 0;
            let mut push = |end: usize| {
                let face = ids[from];
                let surface = faces.get(face as usize).map_or(NO_FACE, |drawn| surface_of(face, drawn));
                runs.all.push(Run { start: start + from as u32, length: (end - from) as u32, face, surface });
                from = end;
            };
            for_each_bit(&runs.changes, |column| push(column + 1));
            push(self.width);
            runs.row_ends.push(runs.all.len());
        }
        let (width, first_row) = (self.width, self.first_row);
        resolve_runs(level, &runs.all, faces, width, first_row, self.depth_m, self.semantic, self.instance);
    }
}

/// Which of six ways a normal points at most: along which axis, and to which side.
fn way(normal: [f32; 3]) -> u32 {
    let length = |axis: &usize| normal[*axis].abs();
    let axis = (0..3).max_by(|a, b| length(a).total_cmp(&length(b))).unwrap_or(0);
    2 * axis as u32 + u32::from(normal[axis] > 0.0)
}

/// The number of a pixel's surface.
fn surface_of(number: u32, face: &DrawnFace) -> u32 {
    match face.source {
        FaceSource::Ground { .. } => 0x8000_0000 | u32::from(face.label),
        FaceSource::Figure { .. } if face.label == SemanticLabel::Pedestrian.id() => {
            0x8100_0000 | (face.instance & 0xff_ffff)
        }
        // Windows, wheels and lamps of a vehicle have edges of their own.
        FaceSource::Figure { first_face, .. } => 0x8200_0000 | (first_face & 0xff_ffff),
        // Textures, not triangles, make what is seen of a model: no edge is smoothed within it.
        FaceSource::Prop { .. } => 0x8300_0000 | (face.instance & 0xff_ffff),
        // Of a scan, sides that look elsewhere have edges: roofs, walls, ground.
        FaceSource::Mesh { .. } => 0x9000_0000 | way(face.normal) << 24 | (face.instance & 0xff_ffff),
        // Round crowns have no edges between the faces of their boxes.
        FaceSource::Crown { .. } => 0x8400_0000 | (face.instance & 0xff_ffff),
        FaceSource::Box { .. } | FaceSource::Splats => number & 0x7fff_ffff,
    }
}

/// Pixels that are written at a time.
const WIDE: usize = 16;

simd_kernel! {
    /// Writes sixteen pixels at a time, beyond a run's end too where the row goes on: the next run is written later.
    /// Depth is `1 / (plane at the pixel centre)`; the plane is exact at every sixteenth pixel.
    #[expect(clippy::too_many_arguments, reason = "one slice per channel")]
    fn resolve_runs(
        runs: &[Run],
        faces: &[DrawnFace],
        width: usize,
        first_row: usize,
        depth: &mut [f32],
        semantic: &mut [u8],
        instance: &mut [u32],
    ) {
        for run in runs {
            let (start, length) = (run.start as usize, run.length as usize);
            let row = start / width;
            let column = start % width;
            let (mut base, mut across) = (0.0, 0.0);
            let (mut label, mut id) = (SemanticLabel::Sky.id(), 0);
            if let Some(face) = faces.get(run.face as usize) {
                base = face.plane.constant + face.plane.down * (first_row.wrapping_add(row) as f64 + 0.5);
                across = face.plane.across;
                (label, id) = (face.label, face.instance);
            }
            let step = across as f32;
            let row_end = start.wrapping_sub(column).wrapping_add(width);
            let mut done = 0;
            while done < length {
                let at = start.wrapping_add(done);
                let value = (base + across * (column.wrapping_add(done) as i32 as f64 + 0.5)) as f32;
                if let (true, Some(depth), Some(semantic), Some(instance)) = (
                    at.wrapping_add(WIDE) <= row_end,
                    depth.get_mut(at..).and_then(|rest| rest.first_chunk_mut::<WIDE>()),
                    semantic.get_mut(at..).and_then(|rest| rest.first_chunk_mut::<WIDE>()),
                    instance.get_mut(at..).and_then(|rest| rest.first_chunk_mut::<WIDE>()),
                ) {
                    for (k, depth) in depth.iter_mut().enumerate() {
                        *depth = 1.0 / (value + step * (k as i32 as f32));
                    }
                    *semantic = [label; WIDE];
                    *instance = [id; WIDE];
                } else {
                    let end = at.wrapping_add(WIDE).min(start.wrapping_add(length));
                    for (k, depth) in depth[at..end].iter_mut().enumerate() {
                        *depth = 1.0 / (value + step * (k as i32 as f32));
                    }
                    semantic[at..end].fill(label);
                    instance[at..end].fill(id);
                }
                done = done.wrapping_add(WIDE);
            }
        }
    }
}

simd_kernel! {
    /// Sets the bits of the places where two rows differ.
    pub fn differences(a: &[u32], b: &[u32], bits: &mut [u64]) {
        bits.fill(0);
        for ((a, b), word) in a.chunks(64).zip(b.chunks(64)).zip(bits.iter_mut()) {
            let mut flags = [0u8; 64];
            if let (Some(a), Some(b)) = (a.first_chunk::<64>(), b.first_chunk::<64>()) {
                for k in 0..64 {
                    flags[k] = u8::from(a[k] != b[k]);
                }
            } else {
                for ((a, b), flag) in a.iter().zip(b).zip(&mut flags) {
                    *flag = u8::from(a != b);
                }
            }
            for (k, eight) in flags.chunks_exact(8).enumerate() {
                let mut bytes = [0; 8];
                bytes.copy_from_slice(eight);
                // Gathers the lowest bits of eight bytes in the highest byte.
                let gathered = u64::from_le_bytes(bytes).wrapping_mul(0x0102_0408_1020_4080) >> 56;
                *word |= gathered << (8 * k);
            }
        }
    }
}

/// Visits the places of set bits, ascending.
#[inline]
pub fn for_each_bit(words: &[u64], mut visit: impl FnMut(usize)) {
    for (number, word) in words.iter().enumerate() {
        let mut left = *word;
        while left != 0 {
            visit(64 * number + left.trailing_zeros() as usize);
            left &= left - 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_cover_every_row_once() {
        let (width, rows) = (2800, BAND_ROWS + 3);
        let ids: Vec<u32> = (0..(width * rows) as u32).map(|i| i % 5400).map(|i| NO_FACE - i * i / 3000).collect();
        let mut images = FrameImages {
            width: width as u32,
            height: rows as u32,
            rgb: vec![0; 3 * ids.len()],
            depth_m: vec![0.0; ids.len()],
            semantic: vec![0; ids.len()],
            instance: vec![0; ids.len()],
            on_request: vec![],
        };
        let mut seen = SeenRuns::default();
        for_each_band(false, &ids, &mut images, &mut seen, |mut band| band.resolve(Level::best(), &[]));
        assert_eq!(seen.rows().count(), rows);
        for (row, runs) in seen.rows().enumerate() {
            let ids = &ids[row * width..(row + 1) * width];
            let mut expected = (row % BAND_ROWS * width) as u32;
            for run in runs {
                assert_eq!(run.start, expected);
                let column = run.start as usize % width;
                let end = column + run.length as usize;
                assert!(ids[column..end].iter().all(|other| *other == run.face));
                assert!(ids.get(end) != Some(&run.face));
                expected += run.length;
            }
            assert_eq!(expected as usize, (row % BAND_ROWS + 1) * width);
        }
        assert!(images.depth_m.iter().all(|depth| depth.is_infinite()));
    }

    #[test]
    fn differences_are_bits() {
        let a: Vec<u32> = (0..130).collect();
        let mut b = a.clone();
        (b[0], b[64], b[129]) = (9, 9, 9);
        let mut bits = [0; 3];
        differences(Level::best(), &a, &b, &mut bits);
        assert_eq!(bits, [1, 1, 2]);
        let mut places = vec![];
        for_each_bit(&bits, |place| places.push(place));
        assert_eq!(places, [0, 64, 129]);
    }
}
