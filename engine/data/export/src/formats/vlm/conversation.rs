//! A window as a conversation: system text, question, and the answer to learn.

use super::options::{BoxScale, Options};
use crate::pixels::smaller_size;
use crate::sample_text::pose_numbers;
use crate::shared_options::IncrementAxes;
use crate::source::ExportedFlight;
use cosfly_frames::{DVec3, Pose, action};
use cosfly_metrics::DeltaFrame;
use cosfly_read::FrameRow;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// A text of the dataset as words: trainers take `<image>` for a picture wherever it stands, and count them.
pub fn as_words(text: &str) -> String {
    text.replace('<', "\u{2039}").replace('>', "\u{203a}")
}

/// Name of a language in English, by its code.
pub fn language_name(code: &str) -> &str {
    match code {
        "zh" => "Chinese",
        "en" => "English",
        code => code,
    }
}

/// Inputs that a question shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shown {
    /// Pictures.
    pub pictures: bool,
    /// Poses of the drone.
    pub poses: bool,
    /// Boxes of the target.
    pub boxes: bool,
}

impl Shown {
    /// All inputs.
    pub const ALL: Self = Self { pictures: true, poses: true, boxes: true };
}

/// The line of the window of `episode` that begins at frame `start`; `expert` has the expert's pose of every frame,
/// `pictures` the paths of its pictures by frame, `instruction` is that of the window.
pub fn conversation(
    episode: &ExportedFlight<'_>,
    options: &Options,
    expert: &[Pose],
    pictures: &BTreeMap<usize, String>,
    start: usize,
    instruction: &str,
    shown: Shown,
) -> Value {
    let window = options.window();
    let first_unseen = start + window.history;
    let seen = &episode.frames[start..first_unseen];
    let current = seen[seen.len() - 1].pose;
    let ahead = &expert[first_unseen..first_unseen + window.horizon];
    let deltas = increments(current, ahead, options.increments.delta_frame());
    let images = (start..first_unseen).filter(|_| shown.pictures).filter_map(|frame| pictures.get(&frame));
    let images: Vec<&String> = images.collect();
    json!({
        "id": format!("{}_{start:06}", episode.flight.trajectory_id),
        "trajectory_id": episode.flight.trajectory_id,
        "frame": start,
        "messages": [
            {"role": "system", "content": system(episode, options)},
            {"role": "user", "content": question(episode, options, seen, instruction, shown)},
            {"role": "assistant", "content": json!({"waypoint_deltas": deltas}).to_string()},
        ],
        "images": images,
    })
}

/// Rounded increments to the expert's poses, each from the pose that the rounded increments before lead to.
fn increments(current: Pose, expert: &[Pose], delta_frame: DeltaFrame) -> Vec<[f64; 6]> {
    let mut from = current;
    let increment = |to: &Pose| {
        let exact = match delta_frame {
            DeltaFrame::World => action::in_world(&from, to),
            DeltaFrame::Body => action::in_body(&from, to),
        };
        let [dx, dy, dz, pitch, yaw, roll] = exact;
        let rounded =
            [thousandths(dx), thousandths(dy), thousandths(dz), hundredths(pitch), hundredths(yaw), hundredths(roll)];
        from = match delta_frame {
            DeltaFrame::World => action::moved_in_world(&from, &rounded),
            DeltaFrame::Body => action::moved_in_body(&from, &rounded),
        };
        rounded
    };
    expert.iter().map(increment).collect()
}

/// Rounded to thousandths; never minus zero.
fn thousandths(value: f64) -> f64 {
    (1000.0 * value).round_ties_even() / 1000.0 + 0.0
}

/// Rounded to hundredths; never minus zero.
fn hundredths(value: f64) -> f64 {
    (100.0 * value).round_ties_even() / 100.0 + 0.0
}

/// Words for what the drone does: it follows somebody, or nobody.
pub(super) fn task(episode: &ExportedFlight<'_>) -> &'static str {
    match episode.flight.target_kind {
        Some(_) => "follows a target",
        None => "flies a planned way",
    }
}

fn system(episode: &ExportedFlight<'_>, options: &Options) -> String {
    let axes = match options.increments.frame {
        IncrementAxes::World => "the world's axes (x east, y south, z up)",
        IncrementAxes::Body => "the body's axes at the waypoint before (x ahead, y right, z up)",
    };
    format!(
        "You steer a drone that {}{}. Answer with one JSON object: \
         {{\"waypoint_deltas\": [[dx, dy, dz, dpitch, dyaw, droll], ...]}} with {} increments, each from the waypoint \
         before, the first from the current pose. dx, dy, dz are metres along {axes}; angles are degrees, positive: \
         nose up, to the right, right side down.",
        task(episode),
        if episode.flight.target_kind.is_some() { " without losing sight of it" } else { "" },
        options.horizon
    )
}

fn question(
    episode: &ExportedFlight<'_>,
    options: &Options,
    seen: &[FrameRow],
    instruction: &str,
    shown: Shown,
) -> String {
    let flight = episode.flight;
    let dt_s = flight.dt_s;
    let history = "<image>".repeat(seen.len() - 1);
    let full = [flight.camera.width, flight.camera.height];
    let size = smaller_size(full, options.width_px);
    let unit = match options.box_scale {
        BoxScale::Pixels => format!("pixels of {} x {}", size[0], size[1]),
        BoxScale::Thousandths => "thousandths of width and height".into(),
    };
    let mut text = match (shown.pictures, seen.len()) {
        (false, _) => format!("Instruction: {instruction}\n"),
        (true, 1) => format!("Current: <image>\nInstruction: {instruction}\n"),
        (true, _) => format!("History, every {dt_s} s: {history}\nCurrent: <image>\nInstruction: {instruction}\n"),
    };
    if shown.poses {
        let _ = writeln!(
            text,
            "Poses, oldest first, [x, y, z, pitch, yaw, roll], metres along the world's axes from the current place, degrees:"
        );
        let current = seen[seen.len() - 1].pose.position_in_world;
        for row in seen {
            let _ = writeln!(text, "{}", pose_text(&row.pose, current));
        }
    }
    if shown.boxes && flight.target_kind.is_some() {
        let _ =
            writeln!(text, "Boxes of the target, [left, top, right, bottom] in {unit}, null where it cannot be seen:");
        for row in seen {
            let _ = writeln!(text, "{}", box_text(row, options.box_scale, full, size));
        }
    }
    let _ = write!(text, "Where are the next {} waypoints, {dt_s} s apart?", options.horizon);
    text
}

/// A pose, its position from `origin`.
pub(super) fn pose_text(pose: &Pose, origin: DVec3) -> Value {
    let [x, y, z, pitch, yaw, roll] =
        pose_numbers(&Pose { position_in_world: pose.position_in_world - origin, ..*pose });
    json!([x, y, z, pitch, yaw, roll].map(hundredths))
}

/// The visible box of the target in pictures that are `full` large in the log and `size` large here.
fn box_text(row: &FrameRow, scale: BoxScale, full: [u32; 2], size: [u32; 2]) -> Value {
    let Some(edges) = row.visible_box_px else { return Value::Null };
    let numbers = edges.iter().enumerate().map(|(place, edge)| {
        let scaled = match scale {
            BoxScale::Pixels => f64::from(size[place % 2]),
            BoxScale::Thousandths => 1000.0,
        };
        (scaled * f64::from(*edge) / f64::from(full[place % 2])).round_ties_even() as i64
    });
    json!(numbers.collect::<Vec<i64>>())
}

#[cfg(test)]
mod tests {
    use super::as_words;

    #[test]
    fn placeholders_in_texts_are_words() {
        assert_eq!(as_words("follow the <image> of <think>"), "follow the ‹image› of ‹think›");
        assert_eq!(as_words("跟着红衣人。"), "跟着红衣人。");
    }
}
