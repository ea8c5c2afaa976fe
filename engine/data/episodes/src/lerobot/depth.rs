//! Pictures of depth, in metres, inside of tables or as files that tables name.

use super::actions::RecordedActions;
use super::frames::Frames;
use crate::episode::stretch;
use crate::episode::{OFFSETS, depth_in_box};
use crate::{ExaminedLook, Flag};
use cosfly_images::float_tiff;
use cosfly_read::{PictureColumn, PictureFile, inner_path};
use std::fs;
use std::path::Path;

/// Measures the depth at the target in a stretch of frames of each recording; faults of the files go to `flags`, one an episode.
///
/// `feature` is the name of the pictures. Without `has_places` of drone and target the files are read, and nothing is measured.
pub fn look(
    (folder, feature): (&Path, &str),
    frames: &Frames,
    has_places: bool,
    recordings: &mut [RecordedActions],
    flags: &mut Vec<Flag>,
) {
    let tables: Vec<(usize, Option<PictureColumn>)> =
        frames.tables.iter().map(|(first, path)| (*first, PictureColumn::open(path, feature).ok())).collect();
    for ((_, rows), recording) in frames.of_episodes().into_iter().zip(recordings) {
        let episode = &mut recording.episode;
        if episode.looks.is_empty() {
            let frames = stretch(episode.moments.len());
            episode.looks = frames.map(|frame| ExaminedLook { frame, ..ExaminedLook::default() }).collect();
        }
        for look in &mut episode.looks {
            let (depth_m, width) = match depth(folder, &tables, rows[look.frame]) {
                Ok(read) => read,
                Err(problem) => {
                    let message = format!("frame {}, `{feature}`: {problem}", look.frame);
                    flags.push(Flag::damage("depth-damaged", &episode.id, message));
                    break;
                }
            };
            let at = |offset: &i64| {
                let moment = episode.moments.get(look.frame.checked_add_signed(*offset as isize)?)?;
                depth_in_box(&depth_m, width, moment.visible_box?)
            };
            if has_places {
                look.depth_m = OFFSETS.iter().map(at).collect();
            }
        }
    }
}

/// Depth in a row of all tables, metres, and the width of its picture.
fn depth(folder: &Path, tables: &[(usize, Option<PictureColumn>)], row: usize) -> Result<(Vec<f32>, usize), String> {
    let at = tables.partition_point(|(first, _)| *first <= row);
    let (first, column) = at.checked_sub(1).and_then(|at| tables.get(at)).ok_or("no table has its row")?;
    let column = column.as_ref().ok_or("its table has no such column")?;
    let file = match column.file(row - first).map_err(|refusal| refusal.message)? {
        PictureFile::Stored(bytes) => bytes.to_vec(),
        PictureFile::Named(name) => {
            let path = inner_path(folder, &name).ok_or_else(|| format!("its file `{name}` is outside the dataset"))?;
            fs::read(path).map_err(|error| format!("its file `{name}` cannot be read: {error}"))?
        }
    };
    let (depth_m, [width, _]) = float_tiff::read(&file)?;
    match depth_m.iter().find(|depth| depth.is_nan() || **depth < 0.0) {
        Some(depth) => Err(format!("a pixel has a depth of {depth} m")),
        None => Ok((depth_m, width)),
    }
}
