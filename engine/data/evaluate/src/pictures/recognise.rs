//! The kind of predictions, told by the files that are there.

use super::settings::PictureKind;
use super::{files, raster, trackers};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_read::predictions::detections as detection_rows;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Kind of the predictions at `path`, by the files there; `None` for waypoints.
///
/// # Errors
/// A folder whose kind cannot be told, with the option that tells it.
pub fn recognise(path: &Path) -> Result<Option<PictureKind>> {
    if !path.is_dir() {
        let mut start = vec![];
        let read = File::open(path).and_then(|file| file.take(1 << 16).read_to_end(&mut start));
        let detections = if read.is_ok() { detection_rows::recognise(&start) } else { None };
        return Ok(detections.map(|masks| if masks { PictureKind::Masks } else { PictureKind::Boxes }));
    }
    let unclear = |what: String| {
        let message = format!("`{}` {what}", path.display());
        Diagnostic::new("evaluation-kind", Fault::Recipe, message)
            .hint("say what it predicts with `--kind`: `depth`, `semantic`, or for a tracker's text files `tracks` or `target`")
    };
    let (pictures, _) = files::pictures(path)?;
    if pictures.is_empty() {
        let kind = trackers::recognise(path)?;
        return kind.map(Some).ok_or_else(|| unclear("has no PNG file, no NumPy array and no text file".into()));
    }
    let mut folders: Vec<&str> = pictures.iter().filter_map(|path| files::kind_folder(path)).collect();
    folders.sort_unstable();
    folders.dedup();
    folders.retain(|folder| ["depth", "semantic"].contains(folder));
    let found = match folders[..] {
        ["depth"] => Some(raster::Content::Depth),
        ["semantic"] => Some(raster::Content::Labels),
        [] => pictures.iter().take(8).find_map(|inner| raster::content(&path.join(inner))),
        _ => return Err(unclear(format!("has predictions of several kinds: {}", folders.join(", ")))),
    };
    match found {
        Some(raster::Content::Depth) => Ok(Some(PictureKind::Depth)),
        Some(raster::Content::Labels) => Ok(Some(PictureKind::Semantic)),
        None => Err(unclear("has pictures of which none of the first eight can be read".into())),
    }
}
