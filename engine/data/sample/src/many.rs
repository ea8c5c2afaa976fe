//! A dataset of many tiny flights for measurements: the sample's flights under new names, each walk at a place of its own.

use super::folder::{blob_of, put};
use super::{SampleFlight, flights, town};
use cosfly_blobs::{BlobRef, OutputSink, SeekWrite};
use cosfly_captions::sight::Landmarks;
use cosfly_diagnose::{Diagnostic, Result};
use cosfly_frames::DVec3;
use cosfly_schema::tables::ObjectRecord;
use cosfly_schema::{CaptionRecord, DatasetConfig, EncodingConfig, PreviewStrip, RenderedTrajectory, TownLayout};
use cosfly_write::publish::{
    DatasetSource, FlightNote, GroupFlights, GroupName, GroupSource, PublishedLog, Shards, Summary, plan_groups,
    write_dataset, write_shard,
};
use cosfly_write::{FramePackReader, write_log};
use std::io::{Cursor, Seek};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Distance of neighbouring walks, metres: none repeats another.
const APART_M: f64 = 24.0;
/// Walks side by side.
const COLUMNS: usize = 400;
/// Flights whose tables are written together.
const IN_GROUP: usize = 400;

/// Flights of a sample, made one at a time: an expert and a perturbed one for each walk.
pub struct ManyFlights {
    samples: Vec<SampleFlight>,
    packs: Vec<Vec<u8>>,
    previews: Vec<PreviewStrip>,
    layout: Arc<TownLayout>,
    landmarks: Arc<Landmarks>,
    count: usize,
}

impl ManyFlights {
    /// `count` flights.
    ///
    /// # Errors
    /// None, as the sample is sound.
    pub fn new(count: usize) -> Result<Self> {
        let samples = flights();
        let packs: Vec<Vec<u8>> = samples.iter().map(|flight| flight.pack(EncodingConfig::default())).collect();
        let preview = |pack: &Vec<u8>| FramePackReader::new(Cursor::new(pack))?.preview_strip();
        let previews = packs.iter().map(preview).collect::<Result<_>>()?;
        let layout = Arc::new(TownLayout::of(&town()));
        Ok(Self { samples, packs, previews, layout, landmarks: Arc::new(Landmarks::of(&town())), count })
    }

    /// Number of flights.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// The record of a flight.
    pub fn record(&self, index: usize) -> RenderedTrajectory {
        let walk = index / 2;
        let mut record = self.samples[index % self.samples.len()].record.clone();
        let shift = DVec3::new(APART_M * (walk % COLUMNS) as f64, APART_M * (walk / COLUMNS) as f64, 0.0);
        record.trajectory_id = format!("{}-p{walk:06}", record.role.name());
        record.flight_id.clone_from(&record.trajectory_id);
        record.pedestrian_id = format!("p{walk:06}");
        if let Some(pair) = &mut record.pair {
            pair.expert_id = format!("expert-p{walk:06}");
        }
        if let Some(perturbation) = &mut record.trajectory.perturbation {
            perturbation.expert_item = format!("p{walk:06}");
        }
        record.trajectory.poses_in_world.iter_mut().for_each(|pose| pose.position_in_world += shift);
        record.trajectory.track.states.iter_mut().for_each(|state| state.feet_in_world += shift);
        record.sightings.iter_mut().for_each(|sighting| sighting.state.feet_in_world += shift);
        record
    }

    /// The packed pictures of a flight.
    pub fn pack(&self, index: usize) -> &[u8] {
        &self.packs[index % self.packs.len()]
    }

    /// The log of a flight, and its row.
    ///
    /// # Errors
    /// None, as the sample is sound.
    pub fn log(&self, index: usize) -> Result<(PublishedLog, Vec<u8>)> {
        let sample = &self.samples[index % self.samples.len()];
        let mut pack = FramePackReader::new(Cursor::new(&self.packs[index % self.samples.len()]))?;
        let mut bytes = vec![];
        let log = write_log(&mut bytes, &self.record(index), &mut pack, &sample.captions, &[], &town(), &|| Ok(()))?;
        Ok((PublishedLog { record: log.record, blob: blob_of(&bytes), channels: sample.channels() }, bytes))
    }
}

impl DatasetSource for ManyFlights {
    fn objects(&self) -> Result<Vec<ObjectRecord>> {
        Ok(ObjectRecord::of(&town()))
    }

    fn picture(&self, _: &str, frame: usize) -> Result<Option<Vec<u8>>> {
        Ok(self.previews[0].jpegs.get(frame).cloned())
    }
}

/// Flights of a group, from number `first` on.
struct Group<'a> {
    all: &'a ManyFlights,
    first: usize,
}

impl GroupSource for Group<'_> {
    fn trajectory(&self, index: usize) -> Result<RenderedTrajectory> {
        Ok(self.all.record(self.first + index))
    }

    fn captions(&self, index: usize) -> Result<Vec<CaptionRecord>> {
        let samples = &self.all.samples;
        Ok(samples[(self.first + index) % samples.len()].captions.clone())
    }

    fn landmarks(&self, _: usize) -> Result<Arc<Landmarks>> {
        Ok(Arc::clone(&self.all.landmarks))
    }

    fn previews(&self, index: usize) -> Result<PreviewStrip> {
        let previews = &self.all.previews;
        Ok(previews[(self.first + index) % previews.len()].clone())
    }
}

/// A sink that writes files below a folder and moves the logs, which lie beside it by number, to their places.
struct MovingSink<'a> {
    folder: &'a Path,
    logs: &'a Path,
    moved: usize,
}

impl OutputSink for MovingSink<'_> {
    fn put(&mut self, name: &str, bytes: &[u8]) -> Result<()> {
        put(&self.folder.join(name), bytes)
    }

    fn stream(&mut self, name: &str, write: &mut dyn FnMut(&mut dyn SeekWrite) -> Result<()>) -> Result<BlobRef> {
        let path = self.folder.join(name);
        put(&path, &[])?;
        let failed = |error: std::io::Error| Diagnostic::io(format!("write `{}`", path.display()), &error);
        let mut file = std::fs::File::options().read(true).write(true).open(&path).map_err(failed)?;
        write(&mut file)?;
        let bytes = file.stream_position().map_err(failed)?;
        Ok(BlobRef { bytes, ..blob_of(&[]) })
    }

    /// Logs are linked in the order of the flights.
    fn link(&mut self, name: &str, _: BlobRef) -> Result<()> {
        let path = self.folder.join(name);
        let failed = |error: std::io::Error| Diagnostic::io(format!("write `{}`", path.display()), &error);
        std::fs::create_dir_all(path.parent().unwrap_or(self.folder)).map_err(failed)?;
        std::fs::rename(self.logs.join(self.moved.to_string()), &path).map_err(failed)?;
        self.moved += 1;
        Ok(())
    }
}

/// Writes a dataset of `count` flights into `folder`.
///
/// # Errors
/// The folder cannot be written.
pub fn write_many(folder: &Path, config: &DatasetConfig, count: usize) -> Result<Summary> {
    let source = ManyFlights::new(count)?;
    let scratch: PathBuf = folder.with_extension("logs");
    let logs: Vec<PublishedLog> = (0..count)
        .map(|index| {
            let (log, bytes) = source.log(index)?;
            put(&scratch.join(index.to_string()), &bytes)?;
            Ok(log)
        })
        .collect::<Result<_>>()?;
    let window = config.windows.shape().size();
    let note = |index: usize| FlightNote::of(&source.record(index), window, String::new());
    let firsts: Vec<usize> = (0..count).step_by(IN_GROUP).collect();
    let group = |first: &usize| {
        let name = GroupName { stage: None, number: (first / IN_GROUP) as u64 };
        (name, (*first..count.min(first + IN_GROUP)).map(note).collect())
    };
    let plan = plan_groups(config, firsts.iter().map(group).collect(), &|_| Ok(Arc::clone(&source.layout)))?;
    let mut sink = MovingSink { folder, logs: &scratch, moved: 0 };
    let mut shards = Shards::default();
    for (first, group) in firsts.iter().zip(&plan.groups) {
        let logs = &logs[*first..first + group.flights.len()];
        let flights = Group { all: &source, first: *first };
        let flights = GroupFlights::new(config, group, logs, &flights, &|| Ok(()))?;
        shards.add(write_shard(&mut sink, config, &flights, vec![])?)?;
    }
    let summary = write_dataset(&mut sink, config, shards, &source)?;
    std::fs::remove_dir(&scratch).map_err(|error| Diagnostic::io("remove the folder of logs", &error))?;
    Ok(summary)
}
