//! The viewer: a server on this machine and a page for flights, their pictures and their town.
//!
//! * [`ViewSubject`]: what is shown: an index of flights, and the parts of each on request. [`DatasetSubject`] is one,
//!   [`NothingSubject`] another, for folders without flights.
//! * [`Server`]: answers requests from this machine that carry the cookie of its session.
//! * [`export()`]: the page with its data in one file.
//!
//! The page is in `assets/`: HTML, style and scripts, without a build step.

mod dataset;
mod export;
mod inside;
mod nothing;
mod page;
mod routes;
mod server;
mod subject;

pub use dataset::{DatasetSubject, stored_picture};
pub use export::export;
pub use inside::inside;
pub use nothing::NothingSubject;
pub use server::Server;
pub use subject::{FewPoints, Index, ViewSubject, ViewedPicture, short, unknown};
