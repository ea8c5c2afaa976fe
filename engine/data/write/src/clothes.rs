//! Texts of a flight against its pictures: the clothes of the target.

use cosfly_captions::{Language, Wear, check_clothes as clothes_in};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_schema::{CaptionRecord, RenderedTrajectory};

/// Refuses texts that name other clothes than the target wears in the pictures.
pub fn check_clothes(record: &RenderedTrajectory, captions: &[CaptionRecord]) -> Result<()> {
    let Some(wear) = record.outfit.as_ref().map(Wear::from) else { return Ok(()) };
    for caption in captions {
        let language = Language::of_code(&caption.language);
        let checked = language.map_or(Ok(()), |language| clothes_in(&caption.text, language, wear));
        checked.map_err(|mismatch| {
            let message = format!("a text of `{}` names other clothes than the pictures show", record.trajectory_id);
            Diagnostic::new("caption-clothes", Fault::Recipe, message)
                .because(mismatch)
                .hint("set `clothes = false` in the `caption` stage, or `target_stands_out = 0` in the `render` stage")
        })?;
    }
    Ok(())
}
