//! Named versions of datasets: manifests of content hashes with the recipe and the tool that made them.
//!
//! * [`version`]: the manifest.
//! * [`record`]: a finished dataset of a store as a version.
//! * [`shelf`]: the versions of a store: named, listed, found.
//! * [`difference`]: which flights two versions have not in common, and why.
//! * [`regenerate`]: flights made anew from the recipe alone, held against what was published.

pub mod difference;
pub mod record;
pub mod regenerate;
pub mod shelf;
pub mod version;

pub use difference::{Bump, Difference, difference};
pub use record::record;
pub use regenerate::{Regenerated, regenerate};
pub use version::Version;
