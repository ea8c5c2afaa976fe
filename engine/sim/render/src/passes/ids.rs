//! Planar depth, semantic and instance ids in bands of rows, from the faces seen in them.

use crate::frame::FrameImages;
use crate::renderer::{DrawnFace, FaceSource};
use crate::visibility::NO_FACE;
use cosfly_frames::simd::Level;
use cosfly_frames::simd_kernel;
use cosfly_maps::SemanticLabel;
use rayon::prelude::*;

/// Rows of a band, the piece of an image that one thread works on.
pub(crate) const BAND_ROWS: usize = 24;

/// Neighbouring pixels of one face in a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Run {
    /// From the start of the band, pixels.
    pub start: u32,
    /// Pixels.
    pub length: u32,
    /// Number of the face, or [`NO_FACE`].
    pub face: u32,
}

/// What is seen: the faces' runs by band, and which surface each pixel belongs to.
#[derive(Default)]
pub(crate) struct SeenRuns {
    /// Runs of each band, row by row.
    bands: Vec<Vec<Run>>,
    /// Equal for pixels of one surface: a box face, ground of one label, the figure, the sky.
    pub surface: Vec<u32>,
}

/// All channels of a band.
pub(crate) struct Band<'a> {
    /// Rows above it.
    pub first_row: usize,
    pub width: usize,
    /// Runs of faces, row by row.
    pub runs: &'a mut Vec<Run>,
    /// Face numbers.
    ids: &'a [u32],
    pub depth_m: &'a mut [f32],
    semantic: &'a mut [u8],
    instance: &'a mut [u32],
    surface: &'a mut [u32],
    /// The picture before smoothing.
    pub picture: &'a mut [u32],
    pub rgb: &'a mut [u8],
}

/// Visits all bands of an image, on request with all threads of the pool that calls.
pub(crate) fn for_each_band(
    parallel: bool,
    faces_seen: &[u32],
    images: &mut FrameImages,
    seen: &mut SeenRuns,
    picture: &mut [u32],
    visit: impl Fn(Band<'_>) + Sync,
) {
    let width = images.width as usize;
    if width == 0 {
        return;
    }
    let pixels = BAND_ROWS * width;
    seen.bands.resize(faces_seen.len().div_ceil(pixels), Vec::new());
    seen.surface.resize(faces_seen.len(), 0);
    let FrameImages { rgb, depth_m, semantic, instance, .. } = images;
    macro_rules! visit_all {
        ($iterate:ident, $chunks:ident, $chunks_mut:ident) => {
            (seen.bands.$iterate().zip(faces_seen.$chunks(pixels)))
                .zip(depth_m.$chunks_mut(pixels).zip(semantic.$chunks_mut(pixels)))
                .zip(instance.$chunks_mut(pixels).zip(seen.surface.$chunks_mut(pixels)))
                .zip(picture.$chunks_mut(pixels).zip(rgb.$chunks_mut(3 * pixels)))
                .enumerate()
                .for_each(|(band, ((((runs, ids), (depth_m, semantic)), (instance, surface)), (picture, rgb)))| {
                    let first_row = band * BAND_ROWS;
                    visit(Band { first_row, width, runs, ids, depth_m, semantic, instance, surface, picture, rgb });
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
        self.runs.clear();
        for (row, ids) in self.ids.chunks_exact(self.width).enumerate() {
            let start = (row * self.width) as u32;
            for_each_run(ids, |from, length, face| {
                self.runs.push(Run { start: start + from as u32, length: length as u32, face });
            });
        }
        resolve_runs(
            level,
            self.runs,
            faces,
            self.width,
            self.first_row,
            self.depth_m,
            self.semantic,
            self.instance,
            self.surface,
        );
    }
}

/// The number of a pixel's surface.
fn surface_of(number: u32, face: &DrawnFace) -> u32 {
    match face.source {
        FaceSource::Ground { .. } => 0x8000_0000 | u32::from(face.label),
        FaceSource::Figure { .. } => 0x8100_0000,
        FaceSource::Box { .. } => number & 0x7fff_ffff,
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
        surface: &mut [u32],
    ) {
        for run in runs {
            let (start, length) = (run.start as usize, run.length as usize);
            let row = start / width;
            let column = start % width;
            let (mut base, mut across) = (0.0, 0.0);
            let (mut label, mut id, mut number) = (SemanticLabel::Sky.id(), 0, NO_FACE);
            if let Some(face) = faces.get(run.face as usize) {
                base = face.plane.constant + face.plane.down * (first_row.wrapping_add(row) as f64 + 0.5);
                across = face.plane.across;
                (label, id, number) = (face.label, face.instance, surface_of(run.face, face));
            }
            let step = across as f32;
            let row_end = start.wrapping_sub(column).wrapping_add(width);
            let mut done = 0;
            while done < length {
                let at = start.wrapping_add(done);
                let value = (base + across * (column.wrapping_add(done) as i32 as f64 + 0.5)) as f32;
                if let (true, Some(depth), Some(semantic), Some(instance), Some(surface)) = (
                    at.wrapping_add(WIDE) <= row_end,
                    depth.get_mut(at..).and_then(|rest| rest.first_chunk_mut::<WIDE>()),
                    semantic.get_mut(at..).and_then(|rest| rest.first_chunk_mut::<WIDE>()),
                    instance.get_mut(at..).and_then(|rest| rest.first_chunk_mut::<WIDE>()),
                    surface.get_mut(at..).and_then(|rest| rest.first_chunk_mut::<WIDE>()),
                ) {
                    for (k, depth) in depth.iter_mut().enumerate() {
                        *depth = 1.0 / (value + step * (k as i32 as f32));
                    }
                    *semantic = [label; WIDE];
                    *instance = [id; WIDE];
                    *surface = [number; WIDE];
                } else {
                    let end = at.wrapping_add(WIDE).min(start.wrapping_add(length));
                    for (k, depth) in depth[at..end].iter_mut().enumerate() {
                        *depth = 1.0 / (value + step * (k as i32 as f32));
                    }
                    semantic[at..end].fill(label);
                    instance[at..end].fill(id);
                    surface[at..end].fill(number);
                }
                done = done.wrapping_add(WIDE);
            }
        }
    }
}

/// Calls `visit` with start, length and number of every run of equal numbers in a row.
#[inline]
fn for_each_run(numbers: &[u32], mut visit: impl FnMut(usize, usize, u32)) {
    let mut start = 0;
    while start < numbers.len() {
        let number = numbers[start];
        let mut end = start + 1;
        while let Some(next) = numbers[end..].first_chunk::<8>() {
            if next.iter().fold(0, |other, value| other | (value ^ number)) != 0 {
                break;
            }
            end += 8;
        }
        while end < numbers.len() && numbers[end] == number {
            end += 1;
        }
        visit(start, end - start, number);
        start = end;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_cover_a_row_once() {
        let numbers: Vec<u32> = (0..1000u32).map(|i| i * i / 3000).collect();
        let mut expected = 0;
        for_each_run(&numbers, |start, length, number| {
            assert_eq!(start, expected);
            assert!(numbers[start..start + length].iter().all(|other| *other == number));
            assert!(numbers.get(start + length) != Some(&number));
            expected += length;
        });
        assert_eq!(expected, 1000);
    }
}
