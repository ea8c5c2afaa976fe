//! The target's flights as sequences for trackers of single targets: from the first picture that shows the target.

use crate::sequence::Sequence;
use crate::source::{ExportedFlight, Source};
use cosfly_diagnose::counted;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_domain::BodyKind;
use cosfly_read::FrameRow;

/// Text of cards about these sequences.
pub const CARD: &str = "\
A sequence begins with the first frame that shows the target, from which trackers start. Flights that never show one are left out.
";

/// Calls `write` with the sequence of each chosen flight that shows its target, named by `name` from the number of the sequence,
/// from 1, and the flight; returns remarks for the user.
///
/// # Errors
/// `export-no-target` where no flight shows a target, and those of `write`.
pub fn each_sequence(
    source: &Source<'_>,
    every: usize,
    name: &dyn Fn(usize, &ExportedFlight<'_>) -> String,
    write: &mut dyn FnMut(&Sequence<'_>) -> Result<()>,
) -> Result<Vec<String>> {
    let (mut number, mut without) = (0, 0);
    source.each_flight(&mut |episode| {
        let frames = episode.every_nth_frame(every);
        let Some(first) = frames.iter().position(|frame| is_seen(&episode.frames[*frame])) else {
            without += 1;
            return Ok(());
        };
        number += 1;
        write(&Sequence { name: name(number, episode), episode, frames: frames[first..].to_vec(), every })
    })?;
    if number == 0 {
        return Err(Diagnostic::new(
            "export-no-target",
            Fault::Recipe,
            "no picture of the chosen flights shows a target",
        )
        .hint("choose other flights, or export them in another format, such as `mot`"));
    }
    let remark = format!("{} without a picture of the target: left out", counted(without, "flight"));
    Ok(if without == 0 { vec![] } else { vec![remark] })
}

/// Whether the frame shows at least one pixel of the target.
pub fn is_seen(row: &FrameRow) -> bool {
    row.visible_box_px.is_some()
}

/// Kind of the target as a word; `object` for kinds that cosfly does not know.
pub fn target_word(episode: &ExportedFlight<'_>) -> &'static str {
    let kind = episode.flight.target_kind.as_deref();
    BodyKind::ON_THE_GROUND.iter().map(|known| known.name()).find(|name| Some(*name) == kind).unwrap_or("object")
}
