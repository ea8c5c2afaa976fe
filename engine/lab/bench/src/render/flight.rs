//! Flight records for measured frames, and files that are hashed while they are written, as in a store.

use super::views::{Ground, View};
use cosfly_blobs::PassingFile;
use cosfly_diagnose::{Diagnostic, Result};
use cosfly_domain::{TargetView, Weather};
use cosfly_schema::{RenderedTrajectory, Role, TownInfo};
use std::fs::File;
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::Path;

/// Time between frames, seconds.
pub const DT_S: f64 = 0.5;

/// Record of the frames `shown`; `views` are the target's views in them.
pub fn flight(ground: &Ground, weather: &Weather, shown: &[View], views: Vec<TargetView>) -> RenderedTrajectory {
    let mut record = cosfly_sample::flight(0, Role::Expert).record;
    record.town = TownInfo::of(&ground.town, "0".repeat(64));
    record.camera = ground.camera;
    record.weather = weather.clone();
    record.season = ground.scene.season();
    record.views = views;
    record.visible_by_dense_rays = vec![None; shown.len()];
    (record.others, record.sightings) = (vec![], vec![]);
    let trajectory = &mut record.trajectory;
    trajectory.track.dt_s = DT_S;
    trajectory.track.states = shown.iter().map(|view| view.target.state).collect();
    trajectory.poses_in_world = shown.iter().map(|view| view.pose).collect();
    trajectory.visibility = vec![1.0; shown.len()];
    trajectory.clearance_m = vec![10.0; shown.len()];
    trajectory.terms.iter_mut().for_each(|term| term.per_frame = vec![0.0; shown.len()]);
    record
}

impl Ground {
    /// Largest instance id in the pictures.
    pub fn largest_instance(&self) -> u32 {
        self.town.obstacles.iter().map(|obstacle| obstacle.object_id).max().unwrap_or(0).saturating_add(2)
    }
}

/// A file with the BLAKE3 of its written bytes; synced when finished.
pub struct StoredFile {
    file: PassingFile,
    hasher: blake3::Hasher,
}

impl StoredFile {
    /// Creates an empty file at `path`.
    pub fn create(path: &Path) -> Result<Self> {
        let file = File::create(path);
        let file = file.map_err(|error| Diagnostic::io(format!("write `{}`", path.display()), &error))?;
        Ok(Self { file: PassingFile::new(file), hasher: blake3::Hasher::new() })
    }

    /// Opens the file at `path` for reading.
    pub fn open(path: &Path) -> Result<Self> {
        let file = File::open(path).map_err(|error| Diagnostic::io(format!("read `{}`", path.display()), &error))?;
        Ok(Self { file: PassingFile::new(file), hasher: blake3::Hasher::new() })
    }

    /// Syncs the file and returns the hash of the written bytes.
    pub fn finish(self) -> blake3::Hash {
        self.hasher.finalize()
    }
}

impl Write for StoredFile {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        let written = self.file.write(bytes)?;
        self.hasher.update(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.file.flush()
    }
}

impl Read for StoredFile {
    fn read(&mut self, bytes: &mut [u8]) -> std::io::Result<usize> {
        self.file.read(bytes)
    }
}

impl Seek for StoredFile {
    fn seek(&mut self, to: SeekFrom) -> std::io::Result<u64> {
        self.file.seek(to)
    }
}
