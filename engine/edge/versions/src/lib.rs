//! Named versions of datasets: manifests of content hashes with the recipe and the tool that made them.
//!
//! * [`version`]: the manifest.
//! * [`record`]: a finished dataset of a store as a version.
//! * [`shelf`]: the versions of a store: named, listed, found.
//! * [`difference`]: flights that differ between two versions, and why.
//! * [`regenerate`]: flights made again from the recipe alone, compared with the published ones.

pub mod difference;
pub mod record;
pub mod regenerate;
pub mod shelf;
mod task_name;
pub mod version;

pub use difference::{Bump, Difference, difference};
pub use record::record;
pub use regenerate::{Regenerated, regenerate};
pub use task_name::TaskName;
pub use version::Version;
