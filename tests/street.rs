//! A tiny recipe in a tiny town: the whole pipeline in a second.

use std::path::{Path, PathBuf};

/// The whole pipeline on one street, with thumbnails.
pub const RECIPE: &str = r#"name = "street"
seed = 3

[stages.town]
use = "map"
source = "street.xodr"

[stages.walkers]
use = "pedestrians"
inputs.town = "town"
count = 3
frames = 12

[stages.expert]
use = "plan"
inputs = { town = "town", walks = "walkers" }

[stages.perturbed]
use = "perturb"
inputs = { town = "town", trajectories = "expert" }

[stages.frames]
use = "render"
inputs = { town = "town", trajectories = ["expert", "perturbed"] }
width = 96
height = 54

[stages.captions]
use = "caption"
inputs.trajectories = ["expert", "perturbed"]

[stages.dataset]
use = "dataset"
inputs = { town = "town", frames = "frames", captions = "captions" }
"#;

/// Map file of the street.
pub fn map() -> String {
    let path = crate::support::repository_root().join("tests/towns/street.xodr");
    std::fs::read_to_string(path).expect("the street is there")
}

/// A folder with `recipe.toml` and `street.xodr` in it.
pub struct Street {
    folder: tempfile::TempDir,
}

impl Street {
    /// Creates the recipe and the map without changes.
    pub fn new() -> Self {
        Self::with(RECIPE, &map())
    }

    /// Creates the folder with another recipe or map text.
    pub fn with(recipe: &str, map: &str) -> Self {
        let folder = tempfile::tempdir().expect("a scratch folder");
        std::fs::write(folder.path().join("recipe.toml"), recipe).expect("writable");
        std::fs::write(folder.path().join("street.xodr"), map).expect("writable");
        Self { folder }
    }

    /// Path of the folder.
    pub fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Path of the dataset of a run with default options.
    pub fn dataset(&self) -> PathBuf {
        self.folder.path().join("out/street")
    }
}
