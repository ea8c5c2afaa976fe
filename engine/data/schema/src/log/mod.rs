//! The log of a trajectory: topics and messages.
//!
//! Here the world frame (left-handed, y right) is converted to the right-handed `map` frame of robotics tools, by
//! [`right_handed`] and nowhere else. Frame `i` is at `i * dt_s` after time 0.

pub mod cloud;
pub mod flown_step;
pub mod messages;
mod own_message;
pub mod raw_format;
pub mod reading;
pub mod right_handed;
pub mod target_state;
pub mod topic;

pub use raw_format::{RawFormat, formats};
pub use target_state::TargetStateMessage;
pub use topic::{Frequency, Topic, flown_topics, topics};

/// Key of the record `cosfly.trajectory` of flights with rows in table `bodies_3d`: their number.
pub const BODIES_3D_ROWS: &str = "bodies_3d_rows";

/// Time of frame `frame`, nanoseconds after the file's time 0.
pub fn frame_time_ns(dt_s: f64, frame: usize) -> u64 {
    (frame as f64 * dt_s * 1e9).round_ties_even() as u64
}
