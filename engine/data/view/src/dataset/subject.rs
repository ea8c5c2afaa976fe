//! [`DatasetSubject`].

use super::opened::Opened;
use super::pictures::Logs;
use super::summary::{Summary, light, summaries, sun_deg};
use super::{around, flight};
use crate::subject::{Index, ViewSubject, ViewedPicture, unknown};
use cosfly_diagnose::{Result, Stop};
use cosfly_read::PublishedFlight;
use serde_json::{Value, json};
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// Most flights of the index; the page keeps it in memory.
const MOST_FLIGHTS: usize = 50_000;
/// Most towns that are kept.
const MOST_TOWNS: usize = 8;

/// A published dataset.
pub struct DatasetSubject {
    opened: Opened,
    summaries: Vec<Summary>,
    logs: Logs,
    /// Boxes of the towns that were asked for last, the newest at the end.
    towns: Mutex<Vec<(String, Value)>>,
}

impl DatasetSubject {
    /// Opens the dataset in `folder` and reads table `frames` once.
    ///
    /// # Errors
    /// Those of [`PublishedDataset::open`]; `view-outside`; damage of tables; `stopped`.
    pub fn open(folder: &Path, stop: &Stop) -> Result<Self> {
        let opened = Opened::of(folder)?;
        let summaries = summaries(&opened.dataset, &opened.causes, stop)?;
        Ok(Self { opened, summaries, logs: Logs::default(), towns: Mutex::default() })
    }
}

impl ViewSubject for DatasetSubject {
    fn about(&self) -> Result<Value> {
        let flights = self.opened.dataset.flights().len();
        Ok(json!({
            "name": self.opened.dataset.name(), "kind": "dataset", "version": self.opened.dataset.identity().digest(),
            "flights": flights, "shown": flights.min(MOST_FLIGHTS),
            "rejected": self.opened.dataset.rejections().map_or(0, |rejected| rejected.len()),
        }))
    }

    fn index(&self) -> Result<Index> {
        let flights = &self.opened.dataset.flights()[..self.opened.dataset.flights().len().min(MOST_FLIGHTS)];
        let mut index = Index::default();
        let mut texts = |name: &str, doc: &str, text: &dyn Fn(&PublishedFlight) -> String| {
            index.texts(name, doc, flights.iter().map(text).collect());
        };
        texts("name", "Id of the trajectory.", &|it| it.trajectory_id.clone());
        let role = |it: &PublishedFlight| if it.expert_id.is_some() { "twin" } else { "expert" };
        texts("role", "`expert`, or `twin` for a perturbed trajectory.", &|it| role(it).to_owned());
        texts("split", "Split.", &|it| it.split.clone());
        texts("town", "Name of the town.", &|it| it.town.clone());
        texts("weather", "Name of the weather.", &|it| it.weather.clone());
        texts("light", "`day`, `dusk` (sun below 15 degrees) or `night`.", &|it| light(it).to_owned());
        texts("target", "Kind of the target.", &|it| it.target_kind.clone().unwrap_or_default());
        index.texts(
            "reason",
            "Worst moment in words.",
            self.summaries[..flights.len()].iter().map(|it| it.reason.clone()).collect(),
        );
        let mut numbers = |name: &str, doc: &str, number: &dyn Fn(&Summary, &PublishedFlight) -> f64| {
            index.numbers(name, doc, self.summaries.iter().zip(flights).map(|(a, b)| number(a, b)));
        };
        numbers("losses_s", "Longest interval without a visible pixel of the target, seconds.", &|it, _| it.losses_s);
        numbers("visible", "Mean share of the target that is visible, 0 to 1.", &|it, _| it.visible);
        numbers("clearance_m", "Smallest distance to an obstacle, metres.", &|it, _| it.clearance_m);
        numbers("distance_m", "Mean distance to the target, metres.", &|it, _| it.distance_m);
        numbers("sun_deg", "Height of the sun, degrees.", &|_, it| sun_deg(it).unwrap_or(f64::NAN));
        numbers("sun_facing", "Share of frames whose camera looks within 35 degrees of the sun.", &|it, _| {
            it.sun_facing
        });
        numbers("look_alikes", "Most visible bodies in the target's clothes at once.", &|it, _| it.look_alikes);
        numbers("frames", "Number of frames.", &|_, it| it.frames as f64);
        numbers("duration_s", "Duration, seconds.", &|_, it| it.frames as f64 * it.dt_s);
        numbers("worst_frame", "Frame that is shown first.", &|it, _| it.worst_frame as f64);
        numbers("start_x_m", "First place of the drone: x, metres.", &|it, _| it.start_m[0]);
        numbers("start_y_m", "First place of the drone: y, metres.", &|it, _| it.start_m[1]);
        index.rank(&self.summaries[..flights.len()].iter().map(|it| [it.losses_s, it.visible]).collect::<Vec<_>>());
        Ok(index)
    }

    fn flight(&self, number: usize) -> Result<Value> {
        let log = self.logs.of(&self.opened, number);
        flight::flight(&self.opened, number, log)
    }

    fn bodies(&self, number: usize) -> Result<Value> {
        around::bodies(&self.opened, number)
    }

    fn town(&self, number: usize) -> Result<Value> {
        let town = &self.opened.at(number)?.town;
        let mut known = self.towns.lock().unwrap_or_else(PoisonError::into_inner);
        let boxes = match known.iter().position(|(known, _)| known == town) {
            Some(at) => known.remove(at).1,
            None => around::town(&self.opened.dataset, town)?,
        };
        known.push((town.clone(), boxes.clone()));
        if known.len() > MOST_TOWNS {
            known.remove(0);
        }
        Ok(boxes)
    }

    fn paths(&self, number: usize) -> Result<Value> {
        let town = &self.opened.at(number)?.town;
        let flights = self.opened.dataset.flights().iter().zip(&self.summaries).take(MOST_FLIGHTS).enumerate();
        let of_town = flights.filter(|(_, (flight, _))| flight.town == *town);
        let paths: Vec<Value> = of_town.map(|(place, (_, summary))| json!([place, summary.path])).collect();
        Ok(json!({ "flights": paths }))
    }

    fn picture(&self, number: usize, frame: usize, channel: &str) -> Result<ViewedPicture> {
        let flight = self.opened.at(number)?;
        if frame >= flight.frames {
            return Err(unknown(format!("frame {frame}: there are {}, from 0", flight.frames)));
        }
        self.logs.of(&self.opened, number)?.picture(frame, channel)
    }
}
