//! Referring phrases of a flight: given where they single the target out, followed to its end.

use cosfly_captions::Language;
use cosfly_captions::refer::{Candidate, Phrase, text};
use cosfly_domain::{Bag, BodyKind, Outfit, PixelBox};
use cosfly_frames::TargetState;
use cosfly_schema::RenderedTrajectory;
use cosfly_schema::log::messages::edges_px;
use cosfly_schema::tables::PhraseRow;

/// A phrase is given once in this time, seconds.
const EVERY_S: f64 = 10.0;
/// A target with fewer visible pixels, or less high, is not clear enough for a phrase.
const CLEAR_PIXELS: u32 = 30;
const CLEAR_HEIGHT_PX: f32 = 10.0;

/// A phrase, and the bodies that it fits in all frames.
#[derive(Clone, Debug, PartialEq)]
pub struct Given {
    /// Frame in which the phrase is given: it fits the target and nobody else there.
    pub frame: usize,
    /// The phrase.
    pub phrase: Phrase,
    /// Number of visible bodies, with the target, that the phrase may fit, by frame.
    pub candidates: Vec<u32>,
    /// Whether the target is visible and the phrase may fit it, by frame.
    pub fits_target: Vec<bool>,
}

impl Given {
    /// All phrases of a flight, one for each stretch of [`EVERY_S`] in which one can be given.
    pub fn all(record: &RenderedTrajectory) -> Vec<Self> {
        let Some((kind, outfit)) = record.target_kind().zip(record.outfit.as_ref()) else { return vec![] };
        let stretch = (EVERY_S / record.dt_s()).round().max(1.0) as usize;
        let firsts = (0..record.len()).step_by(stretch);
        let given = |first: usize| {
            let mut frames = first..record.len().min(first + stretch);
            frames.find_map(|frame| unique(record, frame).map(|phrase| (frame, phrase)))
        };
        firsts.filter_map(given).map(|(frame, phrase)| Self::followed(record, kind, outfit, frame, phrase)).collect()
    }

    /// The row of a phrase.
    pub fn row(&self) -> PhraseRow {
        let property = |it: &cosfly_captions::refer::Property| it.name().to_owned();
        PhraseRow {
            frame: self.frame,
            text_en: text(&self.phrase, Language::En),
            text_zh: text(&self.phrase, Language::Zh),
            properties: self.phrase.properties.iter().map(property).collect(),
            candidates: self.candidates.clone(),
            fits_target: self.fits_target.clone(),
        }
    }

    fn followed(record: &RenderedTrajectory, kind: BodyKind, outfit: &Outfit, frame: usize, phrase: Phrase) -> Self {
        let fits = |frame: usize| {
            let target = target(record, kind, outfit, frame);
            target.at.is_some() && phrase.may_fit(&target)
        };
        let fits_target: Vec<bool> = (0..record.len()).map(fits).collect();
        let count = |frame: usize| {
            let others = others(record, frame).iter().filter(|other| phrase.may_fit(other)).count();
            others as u32 + u32::from(fits_target[frame])
        };
        let candidates = (0..record.len()).map(count).collect();
        Self { frame, candidates, phrase, fits_target }
    }
}

/// The phrase that singles the target out in a frame; `None` where the target is not clear, or no phrase does.
pub(super) fn unique(record: &RenderedTrajectory, frame: usize) -> Option<Phrase> {
    let (kind, outfit) = record.target_kind().zip(record.outfit.as_ref())?;
    let phrase = || Phrase::unique(&target(record, kind, outfit, frame), &others(record, frame));
    if is_clear(record, frame) { phrase() } else { None }
}

/// Whether a frame shows enough of the target for a text about it.
pub(crate) fn is_clear(record: &RenderedTrajectory, frame: usize) -> bool {
    let view = &record.views[frame];
    let height_px = view.visible_box.as_ref().map(edges_px).map_or(0.0, |edges| edges[3] as f32 - edges[1] as f32);
    view.pixels >= CLEAR_PIXELS && height_px >= CLEAR_HEIGHT_PX
}

fn target(record: &RenderedTrajectory, kind: BodyKind, outfit: &Outfit, frame: usize) -> Candidate {
    let state = &record.trajectory.track.states[frame];
    candidate(record, kind, outfit, state, record.views[frame].visible_box.as_ref())
}

fn others(record: &RenderedTrajectory, frame: usize) -> Vec<Candidate> {
    let seen = record.seen_in(frame);
    seen.map(|(other, sighting)| {
        candidate(record, other.plan.kind, &other.outfit, &sighting.state, Some(&sighting.view.visible_box))
    })
    .collect()
}

fn candidate(
    record: &RenderedTrajectory,
    kind: BodyKind,
    outfit: &Outfit,
    state: &TargetState,
    visible_box: Option<&PixelBox>,
) -> Candidate {
    let middle = |edges: [u32; 4]| 0.5 * f64::from(edges[0] + edges[2]) / f64::from(record.camera.width);
    Candidate {
        kind,
        top: outfit.top.name,
        trousers: outfit.trousers.name,
        backpack: outfit.backpack,
        shoulder_bag: outfit.traits.is_some_and(|traits| traits.bag == Bag::Shoulder),
        speed_mps: state.speed_mps,
        at: visible_box.map(|edges| middle(edges_px(edges))),
    }
}
