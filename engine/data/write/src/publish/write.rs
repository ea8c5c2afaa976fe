//! Writes a dataset table by table; one trajectory and one row group are in memory at a time.

use super::kept::Kept;
use super::plan::DatasetPlan;
use super::source::{DatasetSource, PublishedLog};
use super::summary::Summary;
use super::{card, report, viewers};
use crate::croissant;
use crate::gathered_extras::{gather, path_of_file};
use crate::table_file::{TableWriter, write_error, writer_properties};
use cosfly_blobs::OutputSink;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_fingerprint::sha256::{HashingWriter, sha256_of};
use cosfly_metrics::WindowShape;
use cosfly_render::{Channel, ChannelSet};
use cosfly_report::Figures;
use cosfly_schema::card_text::filled;
use cosfly_schema::config::DatasetConfig;
use cosfly_schema::extras::{self, Extra, ExtraShape, ExtraSource, ExtraSummary};
use cosfly_schema::flight_table::Values;
use cosfly_schema::log::target_state;
use cosfly_schema::tables::{self, DatasetItem, FileRecord, Membership, Need, Table};
use cosfly_schema::{LogRecord, PreviewStrip, Rejection, RenderedTrajectory, Split, TownLayout};
use cosfly_splits::{Assignment, Balance, FlightFacts, LintRules};
use parquet::arrow::ArrowWriter;
use std::collections::{BTreeMap, BTreeSet};
use std::io::Write;
use std::sync::Arc;

/// Rows kept together in tables of plugins.
const EXTRA_ROWS_PER_GROUP: usize = 50_000;

/// Writes the whole dataset to `sink`: logs by link, everything else anew. `keep_going` is asked before every
/// trajectory of every table and its error ends the work.
pub fn write_dataset(
    sink: &mut dyn OutputSink,
    config: &DatasetConfig,
    logs: &[PublishedLog],
    source: &dyn DatasetSource,
    rejections: &[Rejection],
    keep_going: &dyn Fn() -> Result<()>,
) -> Result<Summary> {
    match Kept::of(config, logs, source, rejections)? {
        Some(kept) => write_kept(sink, &kept.config, &kept.logs, &kept, &kept.rejections, kept.left_out, keep_going),
        None => write_kept(sink, config, logs, source, rejections, 0, keep_going),
    }
}

/// Writes a dataset of all the given flights; `left_out` others are among the rejections.
fn write_kept(
    sink: &mut dyn OutputSink,
    config: &DatasetConfig,
    logs: &[PublishedLog],
    source: &dyn DatasetSource,
    rejections: &[Rejection],
    left_out: usize,
    keep_going: &dyn Fn() -> Result<()>,
) -> Result<Summary> {
    if logs.is_empty() {
        return Err(nothing_to_publish(rejections));
    }
    let records: Vec<&LogRecord> = logs.iter().map(|log| &log.record).collect();
    let layouts: Vec<Arc<TownLayout>> = (0..logs.len()).map(|index| source.layout(index)).collect::<Result<_>>()?;
    let (assignment, balance) = split(config, logs, source, &layouts, left_out, keep_going)?;
    let plan = DatasetPlan::new(config, &records, &assignment)?;
    let mut dataset = Publishing { sink, files: vec![] };
    for (log, path) in logs.iter().zip(&plan.mcap_paths) {
        dataset.link_log(path, log)?;
    }
    let items = Items {
        is_seen: seen(&plan.splits, &layouts),
        places: logs.iter().enumerate().map(|(place, log)| (log.record.trajectory_id.as_str(), place)).collect(),
        windows: config.windows.shape(),
        plan: &plan,
        assignment,
        layouts,
        logs,
        source,
        keep_going,
    };
    let (mut summary, figures) = summarise(&items, rejections)?;
    summary.warnings = balance.warnings();
    let config = &with_facts(config, &summary);
    for table in tables::of_trajectories() {
        let rows = dataset.trajectory_table(&table, &items)?;
        summary.rows.insert(table.name, rows);
    }
    let objects = tables::of_objects();
    let path = format!("data/{0}/{0}-00000-of-00001.parquet", objects.name);
    let boxes = source.objects()?;
    let rows = dataset.table(&objects, &path, &boxes)?;
    summary.rows.insert(objects.name, BTreeMap::from([(objects.name.to_owned(), rows)]));
    let rejected = tables::of_rejections();
    dataset.table(&rejected, &format!("data/{0}/{0}-00000-of-00001.parquet", rejected.name), rejections)?;
    summary.rows.insert(rejected.name, BTreeMap::from([(rejected.name.to_owned(), summary.rejected)]));
    summary.extras = dataset.extras(&items)?;
    dataset.put("splits.json", cosfly_splits::split_policy(config).as_bytes())?;
    for (path, text) in viewers::FILES {
        dataset.put(path, text.as_bytes())?;
    }
    keep_going()?;
    let page = report::page(config, &summary, figures, &boxes, rejections, source)?;
    dataset.put(report::PATH, page.as_bytes())?;
    dataset.put("schemas/cosfly.proto", target_state::proto_text().as_bytes())?;
    dataset.put("LICENSE", card::license_text(config).as_bytes())?;
    dataset.put("README.md", card::readme(config, &summary).as_bytes())?;
    dataset.finish(config, &summary)?;
    Ok(summary)
}

/// The configuration with facts instead of their names in title and description.
fn with_facts(config: &DatasetConfig, summary: &Summary) -> DatasetConfig {
    let facts = summary.facts();
    let [title, description] = [&config.title, &config.description].map(|text| filled(text, &facts));
    DatasetConfig { title, description, ..config.clone() }
}

/// One pass over all trajectories for their splits, which must not leak.
fn split(
    config: &DatasetConfig,
    logs: &[PublishedLog],
    source: &dyn DatasetSource,
    layouts: &[Arc<TownLayout>],
    left_out: usize,
    keep_going: &dyn Fn() -> Result<()>,
) -> Result<(Assignment, Balance)> {
    let size = config.windows.shape().size();
    let of_flight = |index| {
        keep_going()?;
        let record = source.trajectory(index)?;
        Ok((FlightFacts::of_record(&record, &layouts[index], size), record.dt_s()))
    };
    let flights: Vec<(FlightFacts, f64)> = (0..logs.len()).map(of_flight).collect::<Result<_>>()?;
    check_rates(&flights)?;
    let mut facts: Vec<FlightFacts> = flights.into_iter().map(|(facts, _)| facts).collect();
    check_towns(&facts, config)?;
    let assignment = cosfly_splits::assign(&facts, &config.splits);
    for ((it, split), group) in facts.iter_mut().zip(&assignment.splits).zip(&assignment.groups) {
        (it.split, it.group) = (split.name().to_owned(), group.clone());
    }
    check_promises(&facts, config)?;
    let balance = Balance::of(&facts, &config.splits, left_out);
    if let Some(refusal) = balance.refusal(&config.splits) {
        return Err(refusal);
    }
    match cosfly_splits::refusal(&cosfly_splits::lint(&facts, &LintRules::of(config))) {
        None => Ok((assignment, balance)),
        Some(refusal) => Err(refusal),
    }
}

/// Increments from frame to frame are one quantity in tables only if all frames are equally far apart.
fn check_rates(flights: &[(FlightFacts, f64)]) -> Result<()> {
    let Some(((first, dt_s), rest)) = flights.split_first() else { return Ok(()) };
    let Some((other, other_s)) = rest.iter().find(|(_, other_s)| other_s != dt_s) else { return Ok(()) };
    let message = format!(
        "frames are {dt_s} s apart in `{}` and {other_s} s in `{}`: they cannot be in one dataset",
        first.trajectory_id, other.trajectory_id
    );
    Err(Diagnostic::new("dataset-rates", Fault::Recipe, message)
        .hint("give all stages that walks come from the same `dt_s`, or make two datasets"))
}

/// Towns that a recipe gives a split are there.
fn check_towns(facts: &[FlightFacts], config: &DatasetConfig) -> Result<()> {
    let known: BTreeSet<&str> = facts.iter().map(|it| it.town.as_str()).collect();
    let Some(name) = config.splits.towns.keys().find(|name| !known.contains(name.as_str())) else { return Ok(()) };
    let message = format!("`splits.towns` names `{name}`, but no flight is in a town of that name");
    let refusal = Diagnostic::new("dataset-unknown-town", Fault::Recipe, message);
    let list = || known.iter().map(|it| format!("`{it}`")).collect::<Vec<_>>().join(", ");
    Err(match cosfly_diagnose::nearest_name(name, known.iter().copied()) {
        Some(near) => refusal.hint(format!("did you mean `{near}`?")),
        None => refusal.hint(format!("flights are in {}", list())),
    })
}

/// Every town is in the split that the recipe gives it; a place under two names cannot be in two.
fn check_promises(facts: &[FlightFacts], config: &DatasetConfig) -> Result<()> {
    let promised = |it: &FlightFacts| config.splits.towns.get(&it.town).copied();
    let broken = |it: &&FlightFacts| promised(it).is_some_and(|split| split.name() != it.split);
    let Some(it) = facts.iter().find(broken) else { return Ok(()) };
    let other =
        facts.iter().find(|other| other.town != it.town && promised(other).is_some() && other.split == it.split);
    let message = format!(
        "`splits.towns` puts `{}` and `{}` into two splits, but they have the same ground plan",
        it.town,
        other.map_or("a copy of it", |other| other.town.as_str())
    );
    Err(Diagnostic::new("dataset-leak", Fault::Recipe, message).hint("give both the same split, or leave one out"))
}

/// Whether split `train` has flights in the town of each flight.
fn seen(splits: &[Split], layouts: &[Arc<TownLayout>]) -> Vec<bool> {
    let train: BTreeMap<&str, &TownLayout> = (splits.iter().zip(layouts))
        .filter(|(split, _)| **split == Split::Train)
        .map(|(_, layout)| (layout.digest.as_str(), &**layout))
        .collect();
    let is_seen = |layout: &Arc<TownLayout>| train.values().any(|seen| seen.is_same_place(layout));
    layouts.iter().map(is_seen).collect()
}

/// An empty dataset is no success: says what was rejected and why.
fn nothing_to_publish(rejections: &[Rejection]) -> Box<Diagnostic> {
    let message = format!("there is no flight to publish: {} of {0} items were rejected", rejections.len());
    let reasons = rejections.iter().take(3).map(|it| format!("`{}/{}`: {}", it.stage, it.trajectory_id, it.reason));
    reasons.fold(Diagnostic::new("dataset-empty", Fault::Input, message), Diagnostic::because)
}

/// One pass over all trajectories for the figures of the card and the sketches of the report.
fn summarise(items: &Items<'_>, rejections: &[Rejection]) -> Result<(Summary, Figures)> {
    let splits = Split::ALL.iter().map(|split| (split.name(), (0, 0))).collect();
    let mut summary = Summary { splits, ..Summary::default() };
    summary.count_rejections(rejections);
    let is_logged = |channel: &Channel| items.logs.iter().any(|log| log.channels.iter().any(|it| it == channel));
    summary.channels = ChannelSet::of(is_logged);
    let mut figures = Figures::default();
    for index in 0..items.logs.len() {
        let (item, split) = (items.load(index, Reading::default())?, items.plan.splits[index].name());
        summary.count(&item, split);
        figures.add(report::sketch(index, &item.record, split));
    }
    Ok((summary, figures))
}

/// The trajectories in the order of their logs.
struct Items<'a> {
    plan: &'a DatasetPlan,
    assignment: Assignment,
    layouts: Vec<Arc<TownLayout>>,
    is_seen: Vec<bool>,
    windows: WindowShape,
    /// Places of trajectories by their ids.
    places: BTreeMap<&'a str, usize>,
    logs: &'a [PublishedLog],
    source: &'a dyn DatasetSource,
    keep_going: &'a dyn Fn() -> Result<()>,
}

impl Items<'_> {
    /// The expert of a perturbed flight, where the dataset has it.
    fn expert_of(&self, record: &RenderedTrajectory) -> Result<Option<Box<RenderedTrajectory>>> {
        let place = record.pair.as_ref().and_then(|pair| self.places.get(pair.expert_id.as_str()));
        place.map(|place| self.source.trajectory(*place).map(Box::new)).transpose()
    }

    fn load(&self, index: usize, reading: Reading) -> Result<DatasetItem> {
        (self.keep_going)()?;
        let log = &self.logs[index].record;
        let record = self.source.trajectory(index)?;
        record.check()?;
        if record.trajectory_id != log.trajectory_id || record.len() as u64 != log.frames {
            let message = format!(
                "log {index} is of `{}` with {} frames; the record is of `{}` with {}",
                log.trajectory_id,
                log.frames,
                record.trajectory_id,
                record.len()
            );
            return Err(Diagnostic::new("dataset-order", Fault::Bug, message));
        }
        let previews = if reading.previews { self.source.previews(index)? } else { PreviewStrip::default() };
        Ok(DatasetItem {
            captions: self.source.captions(index)?,
            previews,
            log: log.clone(),
            mcap_path: self.plan.mcap_paths[index].clone(),
            expert: if reading.expert { self.expert_of(&record)? } else { None },
            membership: Membership {
                split: self.plan.splits[index],
                split_group: self.assignment.groups[index].clone(),
                is_seen: self.is_seen[index],
                subset_rank: self.assignment.subset_ranks[index],
            },
            layout: Arc::clone(&self.layouts[index]),
            windows: self.windows,
            record,
        })
    }
}

/// Inputs of a table beside the records.
#[derive(Clone, Copy, Default)]
struct Reading {
    previews: bool,
    expert: bool,
}

/// Appends all rows of one file.
type Fill<'a, S> = &'a mut dyn FnMut(&mut TableWriter<'_, S, &mut (dyn Write + Send)>) -> Result<()>;

/// The sink, and the hashes of what went into it.
struct Publishing<'a> {
    sink: &'a mut dyn OutputSink,
    files: Vec<FileRecord>,
}

impl Publishing<'_> {
    fn link_log(&mut self, path: &str, log: &PublishedLog) -> Result<()> {
        self.sink.link(path, log.blob)?;
        self.files.push(FileRecord {
            path: path.to_owned(),
            bytes: log.record.bytes,
            sha256: log.record.sha256.clone(),
        });
        Ok(())
    }

    fn put(&mut self, path: &str, bytes: &[u8]) -> Result<FileRecord> {
        self.sink.put(path, bytes)?;
        let file = FileRecord { path: path.to_owned(), bytes: bytes.len() as u64, sha256: sha256_of(bytes) };
        self.files.push(file.clone());
        Ok(file)
    }

    /// Tables and files of plugins.
    fn extras(&mut self, items: &Items<'_>) -> Result<Vec<ExtraSummary>> {
        let sources = gather(items.logs.len(), &|flight| items.source.extras(flight))?;
        sources.into_iter().map(|source| self.extra(source, items)).collect()
    }

    fn extra(&mut self, source: ExtraSource, items: &Items<'_>) -> Result<ExtraSummary> {
        let mut kept = ExtraSummary { source, rows: BTreeMap::new(), files: 0, depths: BTreeSet::new() };
        let name = kept.source.name.clone();
        let of_flight = |index: usize| -> Result<Option<Extra>> {
            (items.keep_going)()?;
            Ok(items.source.extras(index)?.into_iter().find(|extra| extra.source.name == name))
        };
        if kept.source.shape == ExtraShape::Files {
            for (index, log) in items.plan.mcap_paths.iter().enumerate() {
                let Some(extra) = of_flight(index)? else { continue };
                let [Values::Texts(paths), Values::Bytes(contents)] = &extra.values[..] else { continue };
                for (path, content) in paths.iter().zip(contents) {
                    self.put(&path_of_file(&name, log, path), content)?;
                    kept.depths.insert(path.split('/').count());
                    kept.files += 1;
                }
            }
            return Ok(kept);
        }
        for (split, path, members) in items.plan.files(&name, false) {
            let mut rows = 0;
            self.hashed(&path, &mut |output| {
                let failed = |error| write_error(&name, error);
                let properties = writer_properties(EXTRA_ROWS_PER_GROUP, None);
                let mut writer =
                    ArrowWriter::try_new(output, extras::schema_of(&kept.source), Some(properties)).map_err(failed)?;
                for index in &members {
                    let Some(extra) = of_flight(*index)? else { continue };
                    let trajectory_id = &items.logs[*index].record.trajectory_id;
                    let batch = extras::write_batch(trajectory_id, &extra).map_err(|error| failed(error.into()))?;
                    rows += batch.num_rows() as u64;
                    writer.write(&batch).map_err(failed)?;
                }
                writer.close().map(drop).map_err(failed)
            })?;
            *kept.rows.entry(split.name().to_owned()).or_insert(0) += rows;
        }
        Ok(kept)
    }

    /// All files of a table over the trajectories; gives the number of rows by split.
    fn trajectory_table(&mut self, table: &Table<DatasetItem>, items: &Items<'_>) -> Result<BTreeMap<String, u64>> {
        let mut rows = BTreeMap::new();
        let reading = Reading { previews: table.needs(Need::Previews), expert: table.needs(Need::Expert) };
        for (split, path, members) in items.plan.files(table.name, table.per_frame) {
            *rows.entry(split.name().to_owned()).or_insert(0) += self.parquet(&path, table, &mut |writer| {
                members.iter().try_for_each(|index| writer.append(&items.load(*index, reading)?))
            })?;
        }
        Ok(rows)
    }

    /// A table of a list in memory, in one file.
    fn table<S>(&mut self, table: &Table<S>, path: &str, records: &[S]) -> Result<u64> {
        self.parquet(path, table, &mut |writer| records.iter().try_for_each(|record| writer.append(record)))
    }

    fn parquet<S>(&mut self, path: &str, table: &Table<S>, fill: Fill<'_, S>) -> Result<u64> {
        let mut rows = 0;
        self.hashed(path, &mut |output| {
            let mut writer = TableWriter::new(table, output)?;
            fill(&mut writer)?;
            rows = writer.finish()?;
            Ok(())
        })?;
        Ok(rows)
    }

    /// A file that is written piece by piece, and its hash.
    fn hashed(&mut self, path: &str, write: &mut dyn FnMut(&mut (dyn Write + Send)) -> Result<()>) -> Result<()> {
        let mut outcome = None;
        self.sink.stream(path, &mut |output| {
            let mut hashing = HashingWriter::new(output);
            write(&mut hashing)?;
            outcome = Some(hashing.finish());
            Ok(())
        })?;
        let (bytes, sha256) = outcome.ok_or_else(|| {
            Diagnostic::new("dataset-sink", Fault::Bug, format!("the output sink did not ask for `{path}`"))
        })?;
        self.files.push(FileRecord { path: path.to_owned(), bytes, sha256 });
        Ok(())
    }

    /// `files.parquet`, then `croissant.json`, which names its hash, then `SHA256SUMS` over both.
    fn finish(mut self, config: &DatasetConfig, summary: &Summary) -> Result<()> {
        self.files.sort();
        let listed = std::mem::take(&mut self.files);
        self.table(&tables::of_files(), "files.parquet", &listed)?;
        let single = |path: &str| listed.iter().find(|file| file.path == path).cloned();
        let mut named: Vec<FileRecord> = self.files.clone();
        named.extend(viewers::FILES.iter().filter_map(|(path, _)| single(path)));
        named.extend(["schemas/cosfly.proto", "LICENSE", "splits.json"].iter().filter_map(|it| single(it)));
        let text = croissant::document(config, summary, &named);
        self.put("croissant.json", text.as_bytes())?;
        let sums: String = self.files.iter().map(|file| format!("{}  {}\n", file.sha256, file.path)).collect();
        self.sink.put("SHA256SUMS", sums.as_bytes())
    }
}
