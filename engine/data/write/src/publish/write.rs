//! Writes what belongs to a dataset as a whole, from the shards of its groups: objects, rejections, manifest, card, page.

use super::files::Files;
use super::plan::path_of_table;
use super::shard::Shard;
use super::source::DatasetSource;
use super::summary::Summary;
use super::{card, report, viewers};
use crate::croissant;
use cosfly_blobs::OutputSink;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_report::Figures;
use cosfly_schema::Rejection;
use cosfly_schema::card_text::filled;
use cosfly_schema::config::DatasetConfig;
use cosfly_schema::extras::{ExtraShape, ExtraSummary};
use cosfly_schema::log::target_state;
use cosfly_schema::tables::{self, FileRecord};
use std::collections::BTreeMap;

/// Writes the files of a dataset that are not in `shards`.
pub fn write_dataset(
    sink: &mut dyn OutputSink,
    config: &DatasetConfig,
    shards: Shards,
    source: &dyn DatasetSource,
) -> Result<Summary> {
    let Shards { mut summary, mut listed, figures, rejections, .. } = shards;
    if summary.flights() == 0 {
        return Err(nothing_to_publish(&rejections));
    }
    check_sensors(&summary.extras)?;
    let config = &with_facts(config, &summary);
    let mut files = Files::new(sink);
    let boxes = source.objects()?;
    let objects = tables::of_objects();
    let rows = files.table(&objects, &path_of_table(objects.name), &boxes)?;
    summary.count_rows(objects.name, objects.name, rows);
    let rejected = tables::of_rejections();
    let rows = files.table(&rejected, &path_of_table(rejected.name), &rejections)?;
    summary.count_rows(rejected.name, rejected.name, rows);
    files.put("splits.json", cosfly_splits::split_policy(config).as_bytes())?;
    for (path, text) in viewers::FILES {
        files.put(path, text.as_bytes())?;
    }
    let page = report::page(config, &summary, figures, &boxes, &rejections, source)?;
    files.put(report::PATH, page.as_bytes())?;
    files.put("schemas/cosfly.proto", target_state::proto_text().as_bytes())?;
    files.put("LICENSE", card::license_text(config).as_bytes())?;
    files.put("README.md", card::readme(config, &summary).as_bytes())?;
    listed.append(&mut files.records);
    finish(files, config, &summary, listed)?;
    Ok(summary)
}

/// Sums over all groups.
#[derive(Default)]
pub struct Shards {
    summary: Summary,
    listed: Vec<FileRecord>,
    figures: Figures,
    rejections: Vec<Rejection>,
    /// Whether some group had flights.
    has_flights: bool,
}

impl Shards {
    /// Adds a group.
    ///
    /// # Errors
    /// Plugins that gave of some flights only, or something else of some.
    pub fn add(&mut self, shard: Shard) -> Result<()> {
        let has_flights = shard.summary.flights() > 0;
        self.summary.merge(shard.summary, self.has_flights)?;
        self.has_flights |= has_flights;
        self.listed.extend(shard.files);
        self.figures.merge(shard.figures);
        self.rejections.extend(shard.rejections);
        Ok(())
    }
}

/// The configuration with facts instead of their names in title and description.
fn with_facts(config: &DatasetConfig, summary: &Summary) -> DatasetConfig {
    let facts = summary.facts();
    let [title, description] = [&config.title, &config.description].map(|text| filled(text, &facts));
    DatasetConfig { title, description, ..config.clone() }
}

/// A sensor that reads along the films of one camera has that camera in some flight.
fn check_sensors(extras: &[ExtraSummary]) -> Result<()> {
    let is_silent = |it: &&ExtraSummary| it.source.shape == ExtraShape::Readings && it.rows.values().sum::<u64>() == 0;
    extras.iter().find(is_silent).map_or(Ok(()), |it| {
        let message = format!("{} gave `{}` no reading of any flight", it.source.origin(), it.source.name);
        let hint = "its key `camera` names a camera that films no flight: cameras are the tables below `cameras` of the stage \
                    `render`; those of a pair end in `_left` and `_right`";
        Err(Diagnostic::new("dataset-extras", Fault::Recipe, message).hint(hint))
    })
}

/// An empty dataset is no success: says what was rejected and why.
fn nothing_to_publish(rejections: &[Rejection]) -> Box<Diagnostic> {
    let message = format!("there is no flight to publish: {} of {0} items were rejected", rejections.len());
    let reasons = rejections.iter().take(3).map(|it| format!("`{}/{}`: {}", it.stage, it.trajectory_id, it.reason));
    let refusal = reasons.fold(Diagnostic::new("dataset-empty", Fault::Input, message), Diagnostic::because);
    if !rejections.iter().any(|it| it.reason.contains("the drone's limit")) {
        return refusal;
    }
    refusal.hint(
        "targets are faster than the drone: `follow.max_speed_mps` of the stage `traffic` leaves them out, or raise \
         `limits.speed_mps` of the stage `plan`",
    )
}

/// `files.parquet`, then `croissant.json`, which names its hash, then `SHA256SUMS` over both.
fn finish(mut files: Files<'_>, config: &DatasetConfig, summary: &Summary, mut listed: Vec<FileRecord>) -> Result<()> {
    listed.sort();
    files.table(&tables::of_files(), "files.parquet", &listed)?;
    let by_path: BTreeMap<&str, &FileRecord> = listed.iter().map(|file| (file.path.as_str(), file)).collect();
    let mut named: Vec<FileRecord> = files.records.clone();
    let singles =
        viewers::FILES.iter().map(|(path, _)| *path).chain(["schemas/cosfly.proto", "LICENSE", "splits.json"]);
    named.extend(singles.filter_map(|path| by_path.get(path).map(|file| (*file).clone())));
    let text = croissant::document(config, summary, &named);
    files.put("croissant.json", text.as_bytes())?;
    let sums: String = files.records.iter().map(|file| format!("{}  {}\n", file.sha256, file.path)).collect();
    files.put_unnamed("SHA256SUMS", sums.as_bytes())
}
