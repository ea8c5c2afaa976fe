//! The tables of one group of walks: all of them in one pass over its flights.

use super::files::Files;
use super::group_flights::GroupFlights;
use super::plan::{GroupPlan, Part, path_of_group, path_of_part};
use super::report;
use super::summary::Summary;
use crate::gathered_extras::{gather, path_of_file};
use crate::table_file::{TableWriter, write_error, writer_properties};
use cosfly_blobs::OutputSink;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_domain::{Channel, ChannelSet};
use cosfly_report::Figures;
use cosfly_schema::config::DatasetConfig;
use cosfly_schema::extras::{self, Extra, ExtraShape, ExtraSource, ExtraSummary};
use cosfly_schema::flight_table::Values;
use cosfly_schema::tables::{self, DatasetItem, FileRecord, Need, Table};
use cosfly_schema::{Rejection, Split};
use parquet::arrow::ArrowWriter;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

/// Rows kept together in tables of plugins.
const EXTRA_ROWS_PER_GROUP: usize = 50_000;
/// Bytes at which a row group of a plugin's or sensor's table ends: clouds of lidars are large.
const EXTRA_BYTES_PER_GROUP: usize = 256 << 20;

/// Facts that a dataset has to know of one group of walks.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Shard {
    /// Figures of its flights.
    pub summary: Summary,
    /// Its files: tables and logs.
    pub files: Vec<FileRecord>,
    /// Figures for the report.
    pub figures: Figures,
    /// Items without a flight.
    pub rejections: Vec<Rejection>,
}

/// Writes the files of a group: logs by link, tables anew.
pub fn write_shard(
    sink: &mut dyn OutputSink,
    config: &DatasetConfig,
    flights: &GroupFlights<'_>,
    rejections: Vec<Rejection>,
) -> Result<Shard> {
    let mut writing = Writing {
        files: Files::new(sink),
        shard: Shard { rejections, ..Shard::default() },
        flights,
        plan: flights.plan,
    };
    let is_logged = |channel: &Channel| flights.logs.iter().any(|log| log.channels.iter().any(|it| it == channel));
    writing.shard.summary.channels = ChannelSet::of(is_logged);
    writing.shard.summary.count_rejections(&writing.shard.rejections);
    for (log, flight) in flights.logs.iter().zip(&flights.plan.flights) {
        writing.files.link_log(&flight.mcap_path, log)?;
    }
    let frames: Vec<u64> = flights.logs.iter().map(|log| log.record.frames).collect();
    for split in Split::ALL {
        writing.tables(split, &flights.plan.parts(split, &frames, config.frames_per_file))?;
    }
    writing.extras()?;
    let Writing { files, mut shard, .. } = writing;
    shard.files = files.records;
    Ok(shard)
}

/// The files of a group while they are written.
struct Writing<'a> {
    files: Files<'a>,
    shard: Shard,
    flights: &'a GroupFlights<'a>,
    plan: &'a GroupPlan,
}

/// A table that grows in memory.
type Growing<'t> = TableWriter<'t, DatasetItem, Vec<u8>>;

fn growing<'t>(tables: &[&'t Table<DatasetItem>]) -> Result<Vec<Growing<'t>>> {
    tables.iter().map(|table| TableWriter::new(table, vec![])).collect()
}

impl Writing<'_> {
    /// All tables over the flights of a split, in one pass. The table with previews goes to the sink as it is written; the
    /// others are small and wait in memory.
    fn tables(&mut self, split: Split, parts: &[Part]) -> Result<()> {
        let all = tables::of_trajectories();
        let (streamed, small): (Vec<_>, Vec<_>) = all.iter().partition(|table| table.needs(Need::Previews));
        let [streamed] = streamed[..] else {
            return Err(Diagnostic::new("dataset-tables", Fault::Bug, "one table has the previews"));
        };
        let (per_frame, per_flight): (Vec<_>, Vec<_>) = small.into_iter().partition(|table| table.per_frame);
        let mut of_split = growing(if parts.is_empty() { &[] } else { &per_flight })?;
        let name = &self.plan.name;
        for part in parts {
            let mut of_part = growing(&per_frame)?;
            let Self { files, shard, flights, .. } = self;
            let mut rows = 0;
            files.hashed(&path_of_part(streamed.name, split, name, part.number), &mut |output| {
                let mut writer = TableWriter::new(streamed, output)?;
                for index in &part.members {
                    let item = flights.load(*index)?;
                    shard.summary.count(&item, split.name());
                    let place = name.place(*index);
                    shard.figures.add(report::sketch(place, &item, split.name()));
                    writer.append(&item)?;
                    of_part.iter_mut().chain(&mut of_split).try_for_each(|table| table.append(&item))?;
                }
                rows = writer.finish()?;
                Ok(())
            })?;
            shard.summary.count_rows(streamed.name, split.name(), rows);
            for table in of_part {
                let path = path_of_part(table.name(), split, name, part.number);
                self.put(table, split, &path)?;
            }
        }
        for table in of_split {
            let path = path_of_group(table.name(), split, name);
            self.put(table, split, &path)?;
        }
        Ok(())
    }

    fn put(&mut self, table: Growing<'_>, split: Split, path: &str) -> Result<()> {
        let name = table.name();
        let (rows, bytes) = table.into_inner()?;
        self.files.put(path, &bytes)?;
        self.shard.summary.count_rows(name, split.name(), rows);
        Ok(())
    }

    /// Tables and files of plugins.
    fn extras(&mut self) -> Result<()> {
        let flights = self.flights;
        for source in gather(flights.logs.len(), &|flight| flights.source.extras(flight))? {
            let kept = self.extra(source)?;
            self.shard.summary.extras.push(kept);
        }
        Ok(())
    }

    fn extra(&mut self, source: ExtraSource) -> Result<ExtraSummary> {
        let mut kept = ExtraSummary { source, rows: BTreeMap::new(), files: 0, depths: BTreeSet::new() };
        let name = kept.source.name.clone();
        let flights = self.flights;
        let of_flight = |index: usize| -> Result<Option<Extra>> {
            (flights.keep_going)()?;
            Ok(flights.source.extras(index)?.into_iter().find(|extra| extra.source.name == name))
        };
        if kept.source.shape == ExtraShape::Files {
            for (index, flight) in self.plan.flights.iter().enumerate() {
                let Some(extra) = of_flight(index)? else { continue };
                let [Values::Texts(paths), Values::Bytes(contents)] = &extra.values[..] else { continue };
                for (path, content) in paths.iter().zip(contents) {
                    self.files.put(&path_of_file(&name, &flight.mcap_path, path), content)?;
                    kept.depths.insert(path.split('/').count());
                    kept.files += 1;
                }
            }
            return Ok(kept);
        }
        for split in Split::ALL {
            let is_member = |index: &usize| self.plan.flights[*index].membership.split == split;
            let members: Vec<usize> = (0..flights.logs.len()).filter(is_member).collect();
            if members.is_empty() {
                continue;
            }
            let mut rows = 0;
            self.files.hashed(&path_of_group(&name, split, &self.plan.name), &mut |output| {
                let failed = |error| write_error(&name, error);
                let properties = writer_properties(EXTRA_ROWS_PER_GROUP, None);
                let mut writer =
                    ArrowWriter::try_new(output, extras::schema_of(&kept.source), Some(properties)).map_err(failed)?;
                for index in &members {
                    let Some(extra) = of_flight(*index)? else { continue };
                    let trajectory_id = &flights.logs[*index].record.trajectory_id;
                    let batch = extras::write_batch(trajectory_id, &extra).map_err(|error| failed(error.into()))?;
                    rows += batch.num_rows() as u64;
                    writer.write(&batch).map_err(failed)?;
                    if writer.in_progress_size() > EXTRA_BYTES_PER_GROUP {
                        writer.flush().map_err(failed)?;
                    }
                }
                writer.close().map(drop).map_err(failed)
            })?;
            kept.rows.insert(split.name().to_owned(), rows);
        }
        Ok(kept)
    }
}
