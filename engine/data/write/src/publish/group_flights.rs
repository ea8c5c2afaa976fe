//! The flights of one group of walks, loaded one by one with everything that tables hold about them.

use super::plan::GroupPlan;
use super::source::{GroupSource, PublishedLog};
use crate::derive::derive;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_schema::config::DatasetConfig;
use cosfly_schema::tables::DatasetItem;
use cosfly_schema::{RenderedTrajectory, TownLayout};
use cosfly_windows::WindowShape;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The flights of a group, in the order of its plan.
pub struct GroupFlights<'a> {
    pub(crate) plan: &'a GroupPlan,
    pub(crate) logs: &'a [PublishedLog],
    pub(crate) source: &'a dyn GroupSource,
    pub(crate) keep_going: &'a dyn Fn() -> Result<()>,
    layouts: BTreeMap<&'a str, Arc<TownLayout>>,
    /// Places of flights by their ids.
    places: BTreeMap<&'a str, usize>,
    windows: WindowShape,
}

impl<'a> GroupFlights<'a> {
    /// The flights that `plan` places, with their `logs`. `keep_going` is asked before every flight and its error ends the
    /// work.
    ///
    /// # Errors
    /// Logs of other flights than those of the plan.
    pub fn new(
        config: &DatasetConfig,
        plan: &'a GroupPlan,
        logs: &'a [PublishedLog],
        source: &'a dyn GroupSource,
        keep_going: &'a dyn Fn() -> Result<()>,
    ) -> Result<Self> {
        let planned = plan.flights.iter().map(|flight| &flight.trajectory_id);
        if !planned.eq(logs.iter().map(|log| &log.record.trajectory_id)) {
            let message = format!("the splits of group {} are of other flights than its logs", plan.name.label());
            return Err(Diagnostic::new("dataset-order", Fault::Bug, message));
        }
        Ok(Self {
            plan,
            logs,
            source,
            keep_going,
            layouts: plan.layouts.iter().map(|(town, layout)| (town.as_str(), Arc::new(layout.clone()))).collect(),
            places: plan.flights.iter().enumerate().map(|(place, it)| (it.trajectory_id.as_str(), place)).collect(),
            windows: config.windows.shape(),
        })
    }

    /// Flight `index` of the group.
    pub(crate) fn load(&self, index: usize) -> Result<DatasetItem> {
        (self.keep_going)()?;
        let (log, planned) = (&self.logs[index].record, &self.plan.flights[index]);
        let record = self.source.trajectory(index)?;
        record.check()?;
        let layout = self.layouts.get(planned.town.as_str());
        let is_same = record.trajectory_id == log.trajectory_id && record.len() as u64 == log.frames;
        let (true, Some(layout)) = (is_same, layout) else {
            let message = format!(
                "the log of `{}` has {} frames; the record is of `{}` with {} frames in `{}`",
                log.trajectory_id,
                log.frames,
                record.trajectory_id,
                record.len(),
                planned.town
            );
            return Err(Diagnostic::new("dataset-order", Fault::Bug, message));
        };
        let landmarks = self.source.landmarks(index)?;
        Ok(DatasetItem {
            derived: derive(&record, &landmarks, &self.windows),
            captions: self.source.captions(index)?,
            previews: self.source.previews(index)?,
            log: log.clone(),
            mcap_path: planned.mcap_path.clone(),
            expert: self.expert_of(&record)?,
            membership: planned.membership.clone(),
            layout: Arc::clone(layout),
            windows: self.windows,
            record,
        })
    }

    /// The expert of a perturbed flight, where the dataset has it.
    fn expert_of(&self, record: &RenderedTrajectory) -> Result<Option<Box<RenderedTrajectory>>> {
        let place = record.pair.as_ref().and_then(|pair| self.places.get(pair.expert_id.as_str()));
        place.map(|place| self.source.trajectory(*place).map(Box::new)).transpose()
    }
}
