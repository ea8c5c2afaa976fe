//! Pictures of a flight for a teacher: small JPEG files of the frame pack.

use crate::ports::PACK;
use cosfly_blobs::PassingFile;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_schema::RenderedTrajectory;
use cosfly_stage::Inputs;
use cosfly_teacher::Frames;
use cosfly_write::FramePackReader;
use std::io::BufReader;

/// Number of pictures over a whole flight, and of a clip.
const KEYFRAMES: usize = 4;
const CLIP: usize = 8;
/// Time between the pictures of a clip, seconds.
const CLIP_STEP_S: f64 = 1.0;

/// Number of pictures of a question.
pub fn count(frames: Frames) -> u64 {
    match frames {
        Frames::None => 0,
        Frames::Keyframes => KEYFRAMES as u64,
        Frames::Clip => CLIP as u64,
    }
}

/// The pictures at port `frames`.
///
/// # Errors
/// `teacher-pictures` for a stage without small pictures; damage.
pub fn of(inputs: &Inputs<'_>, frames: Frames) -> Result<Vec<Vec<u8>>> {
    if frames == Frames::None {
        return Ok(vec![]);
    }
    let rendered = inputs.one("frames")?;
    let record = RenderedTrajectory::from_bytes(&inputs.read(rendered, "index")?)?;
    let mut pack = FramePackReader::new(BufReader::new(PassingFile::new(inputs.open(rendered, PACK)?)))?;
    let mut strip = pack.preview_strip()?.jpegs;
    if strip.is_empty() {
        let message = "the pictures at port `frames` have no small pictures for a teacher";
        return Err(Diagnostic::new("teacher-pictures", Fault::Recipe, message)
            .hint("set `encoding.previews = true` in the `render` stage, or `teacher.frames = \"none\"` here"));
    }
    let chosen = chosen(frames, strip.len(), record.dt_s());
    Ok(chosen.into_iter().map(|frame| std::mem::take(&mut strip[frame])).collect())
}

/// Numbers of the frames to show, each once.
fn chosen(frames: Frames, all: usize, dt_s: f64) -> Vec<usize> {
    let mut chosen: Vec<usize> = match frames {
        Frames::None => vec![],
        Frames::Keyframes => (0..KEYFRAMES).map(|at| at * (all - 1) / (KEYFRAMES - 1)).collect(),
        Frames::Clip => {
            let step = ((CLIP_STEP_S / dt_s).round() as usize).max(1);
            let start = (all / 2).saturating_sub(step * CLIP / 2);
            (0..CLIP).map(|at| start + at * step).filter(|frame| *frame < all).collect()
        }
    };
    chosen.dedup();
    chosen
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_inside_the_flight_and_shown_once() {
        for all in [1, 2, 5, 240] {
            for frames in [Frames::None, Frames::Keyframes, Frames::Clip] {
                let chosen = chosen(frames, all, 0.5);
                assert!(chosen.windows(2).all(|pair| pair[0] < pair[1]), "{chosen:?}");
                assert!(chosen.iter().all(|frame| *frame < all) && chosen.is_empty() == (frames == Frames::None));
            }
        }
        assert_eq!(chosen(Frames::Clip, 240, 0.5), [112, 114, 116, 118, 120, 122, 124, 126]);
    }
}
