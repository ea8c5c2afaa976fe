//! Where a dataset comes from: its records, one trajectory at a time, and its finished logs.

use cosfly_blobs::BlobRef;
use cosfly_diagnose::Result;
use cosfly_render::ChannelSet;
use cosfly_report::PlannerRow;
use cosfly_schema::extras::Extra;
use cosfly_schema::tables::ObjectRecord;
use cosfly_schema::{CaptionRecord, LogRecord, PreviewStrip, RenderedTrajectory, TownLayout};
use std::sync::Arc;

/// A finished log and the blob that holds it.
#[derive(Clone, Debug)]
pub struct PublishedLog {
    /// Row of the log: path, bytes, hash, messages.
    pub record: LogRecord,
    /// The bytes, for [`OutputSink::link`].
    pub blob: BlobRef,
    /// Channels of the log.
    pub channels: ChannelSet,
}

/// Loads the trajectories of a dataset one at a time, by their place in the list of logs. Each is loaded once per
/// table.
pub trait DatasetSource {
    /// The record of trajectory `index`.
    fn trajectory(&self, index: usize) -> Result<RenderedTrajectory>;
    /// Captions of trajectory `index`; empty without a caption stage.
    fn captions(&self, index: usize) -> Result<Vec<CaptionRecord>>;
    /// Boxes behind the instance ids of all images, town by town.
    fn objects(&self) -> Result<Vec<ObjectRecord>>;
    /// The town of trajectory `index` without its name.
    fn layout(&self, index: usize) -> Result<Arc<TownLayout>>;
    /// Figures of planners behind the walks of some flights, for the report.
    fn planners(&self) -> Result<Vec<PlannerRow>> {
        Ok(vec![])
    }
    /// Previews of trajectory `index`; asked for by one table only.
    fn previews(&self, index: usize) -> Result<PreviewStrip>;
    /// Tables and files of plugins for a trajectory.
    fn extras(&self, _: usize) -> Result<Vec<Extra>> {
        Ok(vec![])
    }
}
