//! Named versions of datasets: manifests of content hashes with the recipe and the version of cosfly.
//!
//! * [`version`]: the manifest.
//! * [`record`]: creates a version of a finished dataset in a store.
//! * [`shelf`]: adds, lists and finds the versions of a store.
//! * [`difference`]: flights that differ between two versions, with the causes.
//! * [`regenerate`]: makes flights again from the recipe alone and compares them with the published ones.

pub mod difference;
pub mod record;
pub mod regenerate;
pub mod shelf;
pub mod version;

pub use difference::{Bump, Difference, difference};
pub use record::record;
pub use regenerate::{Regenerated, regenerate};
pub use version::Version;
