//! Where a dataset comes from: the flights of one group at a time, and what belongs to all of them.

use cosfly_blobs::BlobRef;
use cosfly_captions::sight::Landmarks;
use cosfly_diagnose::Result;
use cosfly_domain::ChannelSet;
use cosfly_report::PlannerRow;
use cosfly_schema::extras::Extra;
use cosfly_schema::tables::ObjectRecord;
use cosfly_schema::{CaptionRecord, LogRecord, PreviewStrip, RenderedTrajectory};
use std::sync::Arc;

/// A finished log and the blob that holds it.
#[derive(Clone, Debug)]
pub struct PublishedLog {
    /// Row of the log: path, bytes, hash, messages.
    pub record: LogRecord,
    /// The bytes, for [`cosfly_blobs::OutputSink::link`].
    pub blob: BlobRef,
    /// Channels of the log.
    pub channels: ChannelSet,
}

/// Loads the flights of a group, by their place among its logs: once for all tables, and the expert of a twin once more.
pub trait GroupSource {
    /// The record of flight `index`.
    fn trajectory(&self, index: usize) -> Result<RenderedTrajectory>;
    /// Captions of flight `index`; empty without a caption stage.
    fn captions(&self, index: usize) -> Result<Vec<CaptionRecord>>;
    /// Previews of flight `index`.
    fn previews(&self, index: usize) -> Result<PreviewStrip>;
    /// Trees, lamps and buildings of the town of flight `index`.
    fn landmarks(&self, index: usize) -> Result<Arc<Landmarks>>;
    /// Tables and files of plugins for flight `index`.
    fn extras(&self, _: usize) -> Result<Vec<Extra>> {
        Ok(vec![])
    }
}

/// Source of the parts that belong to the dataset as a whole.
pub trait DatasetSource {
    /// Boxes behind the instance ids of all images, town by town.
    fn objects(&self) -> Result<Vec<ObjectRecord>>;
    /// Figures of planners behind the walks of some flights, for the report.
    fn planners(&self) -> Result<Vec<PlannerRow>> {
        Ok(vec![])
    }
    /// Small colour image of a frame of a flight, JPEG, for the report.
    fn picture(&self, trajectory_id: &str, frame: usize) -> Result<Option<Vec<u8>>>;
}
