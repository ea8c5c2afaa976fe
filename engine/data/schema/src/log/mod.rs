//! The log of a trajectory: topics and messages.
//!
//! Here the world frame (left-handed, y right) is converted to the right-handed `map` frame of robotics tools, by
//! [`right_handed`] and nowhere else. Frame `i` is at `i * dt_s` after the offset of its camera, which is 0 where the recipe has none.

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

/// Times of the frames of a film, after the beginning of its flight.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrameTimes {
    /// Time of the first frame, nanoseconds: the offset of the camera.
    pub begins_ns: u64,
    /// Time between frames, seconds.
    pub dt_s: f64,
}

impl FrameTimes {
    /// Time of a frame, seconds.
    pub fn s(self, frame: usize) -> f64 {
        self.begins_ns as f64 / 1e9 + frame as f64 * self.dt_s
    }

    /// Time of a frame in logs, nanoseconds.
    pub fn ns(self, frame: usize) -> u64 {
        self.begins_ns.saturating_add((frame as f64 * self.dt_s * 1e9).round_ties_even() as u64)
    }
}
