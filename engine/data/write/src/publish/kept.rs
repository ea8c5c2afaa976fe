//! Flights that an area of the splits holds: the others are left out, each with its row in table `rejected`.

use super::source::{DatasetSource, PublishedLog};
use cosfly_diagnose::Result;
use cosfly_report::PlannerRow;
use cosfly_schema::config::{DatasetConfig, SplitBy};
use cosfly_schema::extras::Extra;
use cosfly_schema::tables::ObjectRecord;
use cosfly_schema::{CaptionRecord, PreviewStrip, Rejection, RenderedTrajectory, TownLayout};
use cosfly_splits::{FlightFacts, area};
use std::sync::Arc;

/// Name of the stage in rows of flights that are left out.
const STAGE: &str = "dataset";

/// The flights of a source that are published, and the configuration with the areas of all towns.
pub struct Kept<'a> {
    source: &'a dyn DatasetSource,
    places: Vec<usize>,
    /// Logs of the kept flights.
    pub logs: Vec<PublishedLog>,
    /// The given rejections and those of flights left out.
    pub rejections: Vec<Rejection>,
    /// Configuration whose areas name all towns.
    pub config: DatasetConfig,
    /// Number of flights left out.
    pub left_out: usize,
}

impl<'a> Kept<'a> {
    /// Cuts the towns into areas; `None` where the splits have no areas.
    ///
    /// # Errors
    /// The errors of the source.
    pub fn of(
        config: &DatasetConfig,
        logs: &[PublishedLog],
        source: &'a dyn DatasetSource,
        rejections: &[Rejection],
    ) -> Result<Option<Self>> {
        if config.splits.by != SplitBy::Area {
            return Ok(None);
        }
        let fact = |index| Ok(FlightFacts::of_record(&source.trajectory(index)?, &source.layout(index)?, 0));
        let facts: Vec<FlightFacts> = (0..logs.len()).map(fact).collect::<Result<_>>()?;
        let config = DatasetConfig { splits: area::resolved(&facts, &config.splits), ..config.clone() };
        let reasons = area::left_out(&facts, &config.splits);
        let mut kept =
            Self { source, places: vec![], logs: vec![], rejections: rejections.to_vec(), config, left_out: 0 };
        for (place, (it, reason)) in facts.into_iter().zip(reasons).enumerate() {
            match reason {
                None => {
                    kept.places.push(place);
                    kept.logs.push(logs[place].clone());
                }
                Some(reason) => {
                    kept.left_out += 1;
                    kept.rejections.push(Rejection {
                        trajectory_id: it.trajectory_id,
                        stage: STAGE.to_owned(),
                        pedestrian_id: it.pedestrian_id,
                        town: it.town,
                        reason,
                    });
                }
            }
        }
        Ok(Some(kept))
    }
}

impl DatasetSource for Kept<'_> {
    fn trajectory(&self, index: usize) -> Result<RenderedTrajectory> {
        self.source.trajectory(self.places[index])
    }

    fn captions(&self, index: usize) -> Result<Vec<CaptionRecord>> {
        self.source.captions(self.places[index])
    }

    fn objects(&self) -> Result<Vec<ObjectRecord>> {
        self.source.objects()
    }

    fn layout(&self, index: usize) -> Result<Arc<TownLayout>> {
        self.source.layout(self.places[index])
    }

    fn planners(&self) -> Result<Vec<PlannerRow>> {
        self.source.planners()
    }

    fn previews(&self, index: usize) -> Result<PreviewStrip> {
        self.source.previews(self.places[index])
    }

    fn extras(&self, index: usize) -> Result<Vec<Extra>> {
        self.source.extras(self.places[index])
    }
}
