//! Instructions of windows: what the last picture of the input shows of the target.

use super::phrases::unique;
use cosfly_captions::sight::{self, Landmarks, SeenPerson, WindowView};
use cosfly_captions::{Language, Wear};
use cosfly_domain::{BodyKind, Colour, PixelBox};
use cosfly_frames::{Seed, TargetState};
use cosfly_schema::log::messages::edges_px;
use cosfly_schema::{OtherBody, RenderedTrajectory, Sighting};

/// The instruction of frame `frame`, of a window that begins at frame `start`. Of a target that is not on foot it is the phrase
/// that singles the target out there; empty where none does, and for a target without a body.
pub fn instruction(
    record: &RenderedTrajectory,
    landmarks: &Landmarks,
    frame: usize,
    start: usize,
    language: Language,
) -> String {
    let seed = Seed::of_item(record.seed, "windows", &record.trajectory_id).child("window", start as u64);
    let Some(view) = view(record, frame, start) else {
        let phrase = record.target_kind().filter(|kind| !kind.is_on_foot()).and_then(|_| unique(record, frame));
        return phrase.map_or_else(String::new, |it| sight::phrase_instruction(&it, language, seed));
    };
    sight::instruction(&sight::sight(&view, landmarks), language, seed)
}

/// The picture of frame `frame`; `None` for a target that is not on foot.
fn view(record: &RenderedTrajectory, frame: usize, start: usize) -> Option<WindowView> {
    let kind = record.target_kind().filter(|kind| kind.is_on_foot())?;
    let outfit = record.outfit.as_ref()?;
    let states = &record.trajectory.track.states;
    let seen = &record.views[frame];
    let other = |(body, sighting): (&OtherBody, &Sighting)| {
        let view = &sighting.view;
        // A rider is somebody, but nobody whom a text counts.
        let pixels = if body.plan.kind.is_person() { view.pixels } else { 0 };
        self::person(&sighting.state, Some(&view.visible_box), pixels, body.outfit.top.name)
    };
    Some(WindowView {
        camera: record.camera_pose(frame),
        optics: record.camera,
        wide_lens: Some(record.lens).filter(|lens| lens.is_wide(&record.camera)),
        kind,
        target: person(&states[frame], seen.visible_box.as_ref(), seen.pixels, outfit.top.name),
        wear: Some(Wear::from(outfit)),
        moved_in_world: states[frame].feet_in_world - states[start].feet_in_world,
        others: record.seen_in(frame).filter(|it| is_somebody(it.0.plan.kind)).map(other).collect(),
    })
}

/// Whether people are seen on such a body.
fn is_somebody(kind: BodyKind) -> bool {
    kind.row().is_dressed
}

fn person(state: &TargetState, visible_box: Option<&PixelBox>, pixels: u32, top: Colour) -> SeenPerson {
    SeenPerson {
        feet_in_world: state.feet_in_world,
        heading_rad: state.heading_rad,
        speed_mps: state.speed_mps,
        box_px: visible_box.map(|it| edges_px(it).map(f64::from)),
        pixels,
        top,
    }
}
