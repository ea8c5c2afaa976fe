//! Writes the sample dataset into a folder.

use super::{SampleFlight, flights, rejections, town};
use cosfly_blobs::{BlobRef, OutputSink, SeekWrite};
use cosfly_captions::sight::Landmarks;
use cosfly_diagnose::{Diagnostic, Result};
use cosfly_domain::ChannelSet;
use cosfly_fingerprint::Digest;
use cosfly_schema::tables::ObjectRecord;
use cosfly_schema::{
    CaptionRecord, DatasetConfig, EncodingConfig, LogRecord, PreviewStrip, RenderedTrajectory, TownLayout,
};
use cosfly_write::publish::{
    DatasetSource, FlightNote, GroupFlights, GroupName, GroupSource, PublishedLog, Shards, Summary, plan_groups,
    write_dataset, write_shard,
};
use cosfly_write::{FramePackReader, write_log};
use std::collections::BTreeMap;
use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// An output sink that writes files below a folder and stores the blobs that it may link.
struct FolderSink<'a> {
    folder: PathBuf,
    blobs: BTreeMap<Digest, &'a [u8]>,
}

impl OutputSink for FolderSink<'_> {
    fn put(&mut self, name: &str, bytes: &[u8]) -> Result<()> {
        put(&self.folder.join(name), bytes)
    }

    fn stream(&mut self, name: &str, write: &mut dyn FnMut(&mut dyn SeekWrite) -> Result<()>) -> Result<BlobRef> {
        let mut bytes = Cursor::new(vec![]);
        write(&mut bytes)?;
        self.put(name, bytes.get_ref())?;
        Ok(blob_of(bytes.get_ref()))
    }

    fn link(&mut self, name: &str, blob: BlobRef) -> Result<()> {
        let bytes = self.blobs[&blob.digest];
        self.put(name, bytes)
    }
}

/// Writes a file and the folders above it.
pub(crate) fn put(path: &Path, bytes: &[u8]) -> Result<()> {
    std::fs::create_dir_all(path.parent().unwrap_or(path))
        .and_then(|()| std::fs::write(path, bytes))
        .map_err(|error| Diagnostic::io(format!("write `{}`", path.display()), &error))
}

pub(crate) fn blob_of(bytes: &[u8]) -> BlobRef {
    BlobRef { digest: Digest::of(bytes), bytes: bytes.len() as u64 }
}

struct Flights(Vec<SampleFlight>, EncodingConfig);

impl GroupSource for Flights {
    fn trajectory(&self, index: usize) -> Result<RenderedTrajectory> {
        RenderedTrajectory::from_bytes(&self.0[index].record.to_bytes())
    }

    fn captions(&self, index: usize) -> Result<Vec<CaptionRecord>> {
        Ok(self.0[index].captions.clone())
    }

    fn landmarks(&self, _: usize) -> Result<Arc<Landmarks>> {
        Ok(Arc::new(Landmarks::of(&town())))
    }

    fn previews(&self, index: usize) -> Result<PreviewStrip> {
        FramePackReader::new(Cursor::new(self.0[index].pack(self.1)))?.preview_strip()
    }
}

impl DatasetSource for Flights {
    fn objects(&self) -> Result<Vec<ObjectRecord>> {
        Ok(ObjectRecord::of(&town()))
    }

    fn picture(&self, trajectory_id: &str, frame: usize) -> Result<Option<Vec<u8>>> {
        let index = self.0.iter().position(|flight| flight.record.trajectory_id == trajectory_id);
        let previews = index.map(|index| self.previews(index)).transpose()?;
        Ok(previews.and_then(|previews| previews.jpegs.into_iter().nth(frame)))
    }
}

/// Writes the sample dataset into `folder`.
pub fn write_to_folder(folder: &Path, config: &DatasetConfig, encoding: EncodingConfig) -> Result<Summary> {
    write_flights(folder, config, encoding, flights())
}

/// Writes a dataset of `flights` into `folder`.
pub fn write_flights(
    folder: &Path,
    config: &DatasetConfig,
    encoding: EncodingConfig,
    flights: Vec<SampleFlight>,
) -> Result<Summary> {
    let town = town();
    let mut files = vec![];
    for flight in &flights {
        let mut bytes = vec![];
        let mut pack = FramePackReader::new(Cursor::new(flight.pack(encoding)))?;
        let record = write_log(&mut bytes, &flight.record, &mut pack, &flight.captions, &[], &town, &|| Ok(()))?.record;
        files.push((record, bytes, flight.channels()));
    }
    let published = |(record, bytes, channels): &(LogRecord, Vec<u8>, ChannelSet)| PublishedLog {
        record: record.clone(),
        blob: blob_of(bytes),
        channels: channels.clone(),
    };
    let logs: Vec<PublishedLog> = files.iter().map(published).collect();
    let blobs = files.iter().map(|(_, bytes, _)| (Digest::of(bytes), &bytes[..])).collect();
    let mut sink = FolderSink { folder: folder.to_owned(), blobs };
    let layout = Arc::new(TownLayout::of(&town));
    let note = |flight: &SampleFlight| FlightNote::of(&flight.record, config.windows.shape().size(), String::new());
    let notes = flights.iter().map(note).collect();
    let plan = plan_groups(config, vec![(GroupName::default(), notes)], &|_| Ok(Arc::clone(&layout)))?;
    let group = &plan.groups[0];
    let is_kept = |id: &str| group.flights.iter().any(|flight| flight.trajectory_id == id);
    let logs: Vec<PublishedLog> = logs.into_iter().filter(|log| is_kept(&log.record.trajectory_id)).collect();
    let flights = flights.into_iter().filter(|flight| is_kept(&flight.record.trajectory_id)).collect();
    let source = Flights(flights, encoding);
    let rejections = [rejections(), group.left_out.clone()].concat();
    let flights = GroupFlights::new(config, group, &logs, &source, &|| Ok(()))?;
    let mut shards = Shards::default();
    shards.add(write_shard(&mut sink, config, &flights, rejections)?)?;
    let config = DatasetConfig { splits: plan.splits, ..config.clone() };
    let summary = write_dataset(&mut sink, &config, shards, &source)?;
    Ok(Summary { warnings: plan.warnings, ..summary })
}
