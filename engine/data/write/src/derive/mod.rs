//! Rows that are worked out once for a flight: losses, crossings, bodies, and texts (goals, phrases, instructions of windows).

mod goals;
mod phrases;
mod sight;

use cosfly_captions::Language;
use cosfly_captions::sight::Landmarks;
use cosfly_frames::DVec3;
use cosfly_schema::RenderedTrajectory;
use cosfly_schema::losses::Loss;
use cosfly_schema::tables::{BodyRow, CrossingRow, Derived};
use cosfly_windows::WindowShape;
use phrases::Given;

/// A crossing whose box is this near to the target's way is around it, metres.
const AROUND_M: f64 = 20.0;

/// The derived rows of a flight in a town with these landmarks, for windows of a shape.
pub fn derive(record: &RenderedTrajectory, landmarks: &Landmarks, windows: &WindowShape) -> Derived {
    let losses = Loss::all(record);
    let goals = goals::of(record, &losses, landmarks).iter().map(goals::row).collect();
    let feet: Vec<DVec3> = record.trajectory.track.states.iter().map(|state| state.feet_in_world).collect();
    let crossing = |it: &cosfly_captions::sight::Crossing| CrossingRow {
        number: it.number,
        outline_in_world: it.outline_in_world.clone(),
    };
    let crossings = landmarks.crossings_near(&feet, AROUND_M).into_iter().map(crossing).collect();
    let instruction = |start: usize| {
        let current = start + windows.history - 1;
        [Language::En, Language::Zh].map(|language| sight::instruction(record, landmarks, current, start, language))
    };
    Derived {
        losses,
        goals,
        crossings,
        phrases: Given::all(record).iter().map(Given::row).collect(),
        bodies: BodyRow::all(record),
        instructions: windows.starts(record.len()).map(instruction).collect(),
    }
}
