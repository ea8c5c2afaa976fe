//! The figures of a dataset that card and `croissant.json` state.

use super::shortcuts;
use crate::gathered_extras::merged;
use cosfly_diagnose::Result;
use cosfly_diagnose::counted;
use cosfly_domain::ChannelSet;
use cosfly_metrics::shortcuts::Shortcuts;
use cosfly_schema::extras::ExtraSummary;
use cosfly_schema::tables::DatasetItem;
use cosfly_schema::{LogRecord, Rejection, Role};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

/// Contents of a dataset, counted while it is written.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Expert flights.
    pub experts: u64,
    /// Perturbed flights.
    pub perturbed: u64,
    /// Distinct targets, on foot or not: town and id.
    pub pedestrians: BTreeSet<(String, String)>,
    /// Frames.
    pub frames: u64,
    /// Time flown, seconds.
    pub duration_s: f64,
    /// Items without a flight.
    pub rejected: u64,
    /// Flights whose certificate does not hold.
    pub uncertified: u64,
    /// Bytes of all logs.
    pub mcap_bytes: u64,
    /// Towns by name.
    pub towns: BTreeMap<String, TownSummary>,
    /// Languages of the captions.
    pub languages: BTreeSet<String>,
    /// Weather presets that occur.
    pub weathers: BTreeSet<String>,
    /// Image sizes that occur: width, height.
    pub image_sizes: BTreeSet<(u32, u32)>,
    /// Whether the lens of some flight bends its pictures.
    pub has_lens: bool,
    /// Whether the depth of some flight is that along the rays of its pixels.
    pub has_depth_along_rays: bool,
    /// Mean visibility by rays of each flight, summed over expert and over perturbed flights.
    pub visibility_sums: [f64; 2],
    /// Flights and frames by split name.
    pub splits: BTreeMap<String, (u64, u64)>,
    /// Rows by table name and split name; tables over something else than flights are a split of their own name.
    pub rows: BTreeMap<String, BTreeMap<String, u64>>,
    /// Channels of the logs, all of them together.
    pub channels: ChannelSet,
    /// Signs that give targets away.
    pub shortcuts: Shortcuts,
    /// Tables and files of plugins.
    pub extras: Vec<ExtraSummary>,
    /// Notes on the splits for the user: shares that are missed, walks that chain, flights left out.
    pub warnings: Vec<String>,
}

/// A town of a dataset.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TownSummary {
    /// Flights in it.
    pub flights: u64,
    /// BLAKE3 of its geometry.
    pub geometry_digest: String,
    /// Invented parts, in words.
    pub synthetic_notes: Vec<String>,
}

impl Summary {
    /// Counts one flight of split `split`.
    pub fn count(&mut self, item: &DatasetItem, split: &str) {
        let record = &item.record;
        match record.role {
            Role::Expert => self.experts += 1,
            Role::Perturbed => self.perturbed += 1,
        }
        self.count_log(&item.log, split);
        shortcuts::count(record, &mut self.shortcuts);
        self.pedestrians.insert((record.town.name.clone(), record.pedestrian_id.clone()));
        self.duration_s += record.trajectory.track.duration_s();
        self.uncertified += u64::from(!record.trajectory.certificate.holds);
        self.visibility_sums[record.role as usize] += record.trajectory.certificate.mean_visibility;
        self.weathers.insert(record.weather.name.clone());
        self.image_sizes.insert((record.camera.width, record.camera.height));
        self.has_lens |= !record.lens.is_none();
        self.has_depth_along_rays |= record.lens.is_wide(&record.camera);
        self.languages.extend(item.captions.iter().map(|caption| caption.language.clone()));
        let town = self.towns.entry(record.town.name.clone()).or_default();
        town.flights += 1;
        town.geometry_digest.clone_from(&record.town.geometry_digest);
        town.synthetic_notes.clone_from(&record.town.synthetic.notes);
    }

    fn count_log(&mut self, log: &LogRecord, split: &str) {
        self.frames += log.frames;
        self.mcap_bytes += log.bytes;
        let (flights, frames) = self.splits.entry(split.to_owned()).or_default();
        *flights += 1;
        *frames += log.frames;
    }

    /// Counts the items without a flight.
    pub fn count_rejections(&mut self, rejections: &[Rejection]) {
        self.rejected = rejections.len() as u64;
    }

    /// Counts rows of a table.
    pub fn count_rows(&mut self, table: &str, split: &str, rows: u64) {
        *self.rows.entry(table.to_owned()).or_default().entry(split.to_owned()).or_default() += rows;
    }

    /// Adds the figures of other flights. `has_flights` is true where flights were added before; plugins give of all flights
    /// or of none.
    ///
    /// # Errors
    /// Plugins that gave of some flights only, or something else of some.
    pub fn merge(&mut self, other: Self, has_flights: bool) -> Result<()> {
        if other.flights() > 0 {
            let extras = std::mem::take(&mut self.extras);
            self.extras = if has_flights { merged(extras, other.extras)? } else { other.extras };
        }
        self.experts += other.experts;
        self.perturbed += other.perturbed;
        self.pedestrians.extend(other.pedestrians);
        self.frames += other.frames;
        self.duration_s += other.duration_s;
        self.rejected += other.rejected;
        self.uncertified += other.uncertified;
        self.mcap_bytes += other.mcap_bytes;
        for (name, town) in other.towns {
            let flights = self.towns.get(&name).map_or(0, |known| known.flights);
            self.towns.insert(name, TownSummary { flights: flights + town.flights, ..town });
        }
        self.languages.extend(other.languages);
        self.weathers.extend(other.weathers);
        self.image_sizes.extend(other.image_sizes);
        self.has_lens |= other.has_lens;
        self.has_depth_along_rays |= other.has_depth_along_rays;
        self.visibility_sums.iter_mut().zip(other.visibility_sums).for_each(|(sum, more)| *sum += more);
        for (split, (flights, frames)) in other.splits {
            let sums = self.splits.entry(split).or_default();
            *sums = (sums.0 + flights, sums.1 + frames);
        }
        for (table, rows) in other.rows {
            rows.into_iter().for_each(|(split, rows)| self.count_rows(&table, &split, rows));
        }
        let channels = std::mem::take(&mut self.channels);
        self.channels =
            ChannelSet::of(|channel| [&channels, &other.channels].iter().any(|set| set.iter().any(|it| it == channel)));
        self.shortcuts.merge(other.shortcuts);
        Ok(())
    }

    /// All flights.
    pub fn flights(&self) -> u64 {
        self.experts + self.perturbed
    }

    /// The facts that texts of the card may name ([`card_text::FACTS`]), in words.
    pub fn facts(&self) -> BTreeMap<&'static str, String> {
        let towns: Vec<&str> = self.towns.keys().map(String::as_str).collect();
        let towns = match &towns[..] {
            [others @ .., last] if !others.is_empty() => format!("{} and {last}", others.join(", ")),
            few => few.concat(),
        };
        BTreeMap::from([
            ("towns", towns),
            ("targets", counted(self.pedestrians.len() as u64, "target")),
            ("pedestrians", counted(self.pedestrians.len() as u64, "pedestrian")),
            ("flights", counted(self.flights(), "flight")),
            ("frames", counted(self.frames, "frame")),
            ("minutes", format!("{:.1} minutes", self.duration_s / 60.0)),
        ])
    }

    /// Languages of all texts: those of the captions; columns of tables are English and Chinese in every dataset.
    pub fn text_languages(&self) -> BTreeSet<&str> {
        self.languages.iter().map(String::as_str).chain(["en", "zh"]).collect()
    }

    /// Mean visibility by rays, of expert and of perturbed flights each, in words: twins are perturbed to lose sight of the target, so
    /// one figure for both would describe neither.
    pub fn mean_visibility(&self) -> String {
        let roles = [("expert", self.experts), ("perturbed", self.perturbed)];
        let means = roles.iter().zip(self.visibility_sums).filter(|((_, flights), _)| *flights > 0);
        let words: Vec<String> =
            means.map(|((role, flights), sum)| format!("{:.3} {role}", sum / *flights as f64)).collect();
        words.join(", ")
    }
}
