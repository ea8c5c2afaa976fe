//! [`FlightPictures`] of a flight, and clips of shots.

use crate::clip::Clip;
use crate::ground::SeenGround;
use crate::plan::Plan;
use crate::selection::{FrameList, spread};
use crate::sheet::Sheet;
use crate::shot::ClipShot;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_read::{FrameRow, PublishedDataset, PublishedFlight};
use std::collections::{BTreeMap, BTreeSet};

/// Rows of a sheet when no frames are asked for.
const SHEET_FRAMES: usize = 6;
/// Pictures of a clip when no frames are asked for.
const CLIP_FRAMES: usize = 100;
/// Number of frames whose pixels make the plan's ground.
const GROUND_FRAMES: usize = 60;
/// Most frames of one preview: each is a row of the sheet, and the clip is in memory.
const MOST_FRAMES: usize = 400;
/// Most rows of one sheet; more would make a picture that no viewer opens.
const MOST_ROWS: usize = 60;

/// The pictures of one flight, as files.
pub struct FlightPictures {
    /// Contact sheet, PNG.
    pub sheet: Vec<u8>,
    /// Animated clip, GIF.
    pub clip: Vec<u8>,
    /// Plan, PNG.
    pub plan: Vec<u8>,
    /// Rows of the sheet and pictures of the clip.
    pub shown: [usize; 2],
}

/// Draws `flight`. Without `frames`, the sheet has six of them and the clip a hundred. `progress` is called with the number of
/// frames that are read and of all.
///
/// # Errors
/// `preview-frame` or `preview-many` where the frames do not fit; errors of the dataset's files.
pub fn draw(
    dataset: &PublishedDataset,
    flight: &PublishedFlight,
    frames: Option<&FrameList>,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<FlightPictures> {
    let of_clip = match frames {
        Some(list) => list.of(&flight.trajectory_id, flight.frames)?,
        None => spread(flight.frames, CLIP_FRAMES),
    };
    if of_clip.len() > MOST_FRAMES {
        let message = format!("{} frames are too many for one preview; it takes {MOST_FRAMES}", of_clip.len());
        return Err(Diagnostic::new("preview-many", Fault::Recipe, message).hint(format!(
            "take some of them, such as `0..{}:{}`",
            flight.frames,
            flight.frames / MOST_FRAMES + 1
        )));
    }
    let rows = if frames.is_some() { MOST_ROWS } else { SHEET_FRAMES };
    let of_sheet: Vec<usize> = spread(of_clip.len(), rows).into_iter().map(|at| of_clip[at]).collect();
    let of_ground = spread(flight.frames, GROUND_FRAMES);
    let needed: BTreeSet<usize> = of_clip.iter().chain(&of_ground).copied().collect();
    let mut log = dataset.log(flight)?;
    let (mut sheet, mut clip, mut ground) = (Sheet::new(flight), Clip::default(), SeenGround::default());
    for (done, frame) in needed.iter().enumerate() {
        progress(done as u64, needed.len() as u64);
        let logged = log.frame(*frame)?;
        if of_ground.binary_search(frame).is_ok() {
            ground.add(flight, &logged);
        }
        if of_clip.binary_search(frame).is_ok() {
            let shot = ClipShot::new(logged)?;
            clip.add(&shot);
            if of_sheet.binary_search(frame).is_ok() {
                sheet.add(&shot);
            }
        }
    }
    progress(needed.len() as u64, needed.len() as u64);
    let members: Vec<&PublishedFlight> = dataset.family(flight);
    let ids: BTreeSet<&str> = members.iter().map(|it| it.trajectory_id.as_str()).collect();
    let mut frames_of: BTreeMap<String, Vec<FrameRow>> = BTreeMap::new();
    dataset.walk(&|it| ids.contains(it.trajectory_id.as_str()), &mut |it, frames| {
        frames_of.insert(it.trajectory_id.clone(), frames);
        Ok(())
    })?;
    let family = members.into_iter().filter_map(|it| Some((it, frames_of.remove(&it.trajectory_id)?))).collect();
    let plan = Plan { flight, family, boxes: log.scene()?, ground };
    let shown = [of_sheet.len(), of_clip.len()];
    Ok(FlightPictures { sheet: sheet.finish().png()?, clip: clip.finish()?, plan: plan.draw().png()?, shown })
}

/// The animated clip of some frames, GIF: ten of them a second.
///
/// # Errors
/// `preview-encode` where they cannot be encoded.
pub fn clip(shots: impl Iterator<Item = ClipShot>) -> Result<Vec<u8>> {
    let mut clip = Clip::default();
    shots.for_each(|shot| clip.add(&shot));
    clip.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_sample as sample;
    use cosfly_schema::{DatasetConfig, EncodingConfig, RgbEncoding};

    fn drawn(encoding: EncodingConfig, frames: Option<&str>) -> Result<FlightPictures> {
        let folder = tempfile::tempdir().expect("a scratch folder");
        sample::write_to_folder(folder.path(), &DatasetConfig::default(), encoding).expect("the sample is sound");
        let dataset = PublishedDataset::open(folder.path())?;
        let frames = frames.map(|text| text.parse().expect("frames"));
        draw(&dataset, dataset.flight("perturbed-p00000")?, frames.as_ref(), &mut |_, _| {})
    }

    #[test]
    fn a_flight_gives_the_same_three_pictures_twice() {
        let [first, second] = [0, 1].map(|_| drawn(EncodingConfig::default(), None).expect("pictures"));
        assert!(first.sheet == second.sheet && first.clip == second.clip && first.plan == second.plan);
        assert!(first.sheet.starts_with(b"\x89PNG") && first.plan.starts_with(b"\x89PNG"));
        assert!(first.clip.starts_with(b"GIF89a"));
        assert_eq!(first.shown, [5, 5]);
    }

    #[test]
    fn png_images_are_read_too_and_chosen_frames_are_shown() {
        let encoding = EncodingConfig { rgb: RgbEncoding::Png, ..EncodingConfig::default() };
        assert_eq!(drawn(encoding, Some("1,3")).expect("pictures").shown, [2, 2]);
    }

    #[test]
    fn channels_on_request_widen_the_sheet() {
        let sheet_width = |draw: bool| {
            let folder = tempfile::tempdir().expect("a scratch folder");
            let mut flights = sample::flights();
            if draw {
                flights.iter_mut().for_each(sample::SampleFlight::draw_on_request);
            }
            let (config, encoding) = (DatasetConfig::default(), EncodingConfig::default());
            sample::write_flights(folder.path(), &config, encoding, flights).expect("the sample is sound");
            let dataset = PublishedDataset::open(folder.path()).expect("published");
            let flight = dataset.flight("expert-p00000").expect("a flight");
            let pictures = super::draw(&dataset, flight, None, &mut |_, _| {}).expect("pictures");
            u32::from_be_bytes(pictures.sheet[16..20].try_into().expect("four bytes"))
        };
        assert!(sheet_width(true) > sheet_width(false) + 300);
    }

    #[test]
    fn frames_beyond_the_end_are_refused() {
        let error = drawn(EncodingConfig::default(), Some("0..6")).err().expect("refused");
        assert_eq!(error.code, "preview-frame");
    }
}
