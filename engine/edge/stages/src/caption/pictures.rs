//! Pictures of a flight for a teacher: small JPEG files of the frame pack.

use crate::ports::PACK;
use cosfly_blobs::PassingFile;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_schema::RenderedTrajectory;
use cosfly_stage::Inputs;
use cosfly_teacher::TeacherFrames;
use cosfly_write::FramePackReader;
use std::io::BufReader;

/// The pictures at port `frames`.
///
/// # Errors
/// `teacher-pictures` for a stage without small pictures; damage.
pub fn of(inputs: &Inputs<'_>, frames: TeacherFrames) -> Result<Vec<Vec<u8>>> {
    if frames == TeacherFrames::None {
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
    let chosen = frames.chosen(strip.len(), record.dt_s());
    Ok(chosen.into_iter().map(|frame| std::mem::take(&mut strip[frame])).collect())
}
