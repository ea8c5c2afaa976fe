//! A dataset as the viewer shows it.
//!
//! * [`opened`]: the dataset, and places of rows.
//! * [`summary`]: one pass over table `frames`: what is in the index; [`causes`]: words for what hides a target.
//! * [`flight`], [`around`]: frames and texts of a flight, bodies and town around it; [`pictures`]: its images.

mod around;
mod causes;
mod flight;
mod opened;
mod pictures;
mod subject;
mod summary;

pub use pictures::stored_picture;
pub use subject::DatasetSubject;
