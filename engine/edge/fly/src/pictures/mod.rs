//! Pictures for people: logs that play in Foxglove, clips, the page.

mod clip;
mod mcap;
mod page;
mod window;

pub use clip::clip;
pub use mcap::mcap;
pub use page::{Case, page};
