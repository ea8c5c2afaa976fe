//! Flights of any layout as plain values, and the readers of layouts of others.
//!
//! * [`episode`]: a flight as checks and training see it, whatever files it came from.
//! * [`flag`]: findings about flights and files.
//! * [`v7`]: the published CosFly-Track release.
//! * [`lerobot`]: datasets of LeRobot.
//! * [`whole_files`]: whether files can be read to their ends.

pub mod episode;
mod files;
pub mod flag;
pub mod lerobot;
pub mod v7;
pub mod whole_files;

pub use episode::{ExaminedEpisode, ExaminedLook, ExaminedMoment};
pub use files::{files_below, is_of_cosfly};
pub use flag::{Flag, Severity};
