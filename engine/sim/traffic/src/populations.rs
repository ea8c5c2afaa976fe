//! The populations of traffic: one function per kind.

use crate::avoided::Avoided;
use crate::config::{RecordedSource, SumoSource, TrafficConfig};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_domain::Town;
use cosfly_frames::{DVec2, Seed};
use cosfly_pedestrians::{Crowd, PedestrianError, Recording, WalkableGrid, scripted};
use cosfly_vehicles::fcd::{self, FcdError, FcdProjection, NetLocation};
use cosfly_vehicles::{VehicleError, Vehicles};
use cosfly_world::{Clock, Population};
use std::io::{self, BufReader, Read};
use std::sync::Arc;

/// Bytes of a SUMO net that hold its location.
const NET_HEAD_BYTES: u64 = 64 * 1024;

/// A file of tracks, which the caller opens.
pub struct TrackFile {
    /// Path for messages.
    pub shown: String,
    /// Opens the file at its beginning.
    pub open: Box<dyn Fn() -> io::Result<Box<dyn Read>>>,
}

impl TrackFile {
    fn opened(&self) -> Result<Box<dyn Read>> {
        (self.open)().map_err(|error| self.unreadable(&error))
    }

    /// Name without folders.
    fn name(&self) -> &str {
        self.shown.rsplit(['/', '\\']).next().unwrap_or_default()
    }

    fn unreadable(&self, error: &io::Error) -> Box<Diagnostic> {
        Diagnostic::new("traffic-unreadable", Fault::Input, format!("cannot read `{}`", self.shown)).because(error)
    }

    fn refused(&self, error: &dyn std::fmt::Display, hint: &str) -> Box<Diagnostic> {
        let message = format!("cannot use the tracks in `{}`", self.shown);
        let refusal = Diagnostic::new("traffic-tracks", Fault::Input, message).because(error);
        if hint.is_empty() { refusal } else { refusal.hint(hint) }
    }
}

/// Populations, and what was left out, in words.
#[derive(Default)]
pub(crate) struct Populations {
    /// In the order of their numbers.
    pub all: Vec<Box<dyn Population>>,
    /// Omissions, in words.
    pub notes: Vec<String>,
}

/// All populations; the last one is `avoided`, if there is anybody. `files` are those of [`TrafficConfig::recorded`], then the two
/// of [`TrafficConfig::sumo`].
pub(crate) fn all(
    config: &TrafficConfig,
    town: &Town,
    (clock, seed): (Clock, Seed),
    files: &[TrackFile],
    avoided: Avoided,
) -> Result<Populations> {
    let mut populations = Populations::default();
    let mut grid: Option<Arc<WalkableGrid>> = None;
    let refused = |error: PedestrianError| refusal(&error, error.hint(), &town.name);
    if config.people.count > 0 || !config.scripted.is_empty() {
        grid = Some(Arc::new(Crowd::grid(town, &config.people).map_err(refused)?));
    }
    if config.vehicles.count > 0 {
        match Vehicles::new(town, &config.vehicles, clock, seed.child("vehicles", 0)) {
            Ok(vehicles) => populations.all.push(Box::new(vehicles)),
            Err(error @ VehicleError::NoLanes { .. }) => populations.notes.push(format!("{error}: there are none")),
            Err(error) => return Err(refusal(&error, error.hint(), &town.name)),
        }
    }
    for (number, recorded) in config.recorded.iter().enumerate() {
        let seed = seed.child("recorded", number as u64);
        populations.all.push(self::recorded(recorded, &files[number], town, clock, seed, &mut populations.notes)?);
    }
    if let Some(grid) = grid.as_ref().filter(|_| !config.scripted.is_empty()) {
        let fastest_mps = config.people.speed.max_mps;
        let people =
            scripted(&config.scripted, grid, fastest_mps, clock, seed.child("scripted", 0)).map_err(refused)?;
        populations.all.push(Box::new(people));
    }
    if let Some(sumo) = &config.sumo {
        populations.all.push(self::sumo(sumo, &files[config.recorded.len()..], town, clock, seed.child("sumo", 0))?);
    }
    if avoided.len() > 0 {
        populations.all.push(Box::new(avoided));
    }
    // People are numbered first, and begin beside everybody else.
    if let Some(grid) = grid.filter(|_| config.people.count > 0) {
        let (seed, others) = (seed.child("people", 0), first_places(&populations.all));
        let crowd = Crowd::beside(grid, &config.people, clock, seed, &others).map_err(refused)?;
        populations.all.insert(0, Box::new(crowd));
    }
    Ok(populations)
}

/// Places in plan and radii of all bodies that are there in the first frame, metres.
fn first_places(populations: &[Box<dyn Population>]) -> Vec<(DVec2, f64)> {
    let mut places = vec![];
    for population in populations {
        let plans = population.plans().into_iter().enumerate();
        places.extend(
            plans.filter_map(|(body, plan)| Some((population.state(body)?.feet_in_world.truncate(), plan.radius_m()))),
        );
    }
    places
}

fn recorded(
    source: &RecordedSource,
    file: &TrackFile,
    town: &Town,
    clock: Clock,
    seed: Seed,
    notes: &mut Vec<String>,
) -> Result<Box<dyn Population>> {
    let mut bytes = vec![];
    file.opened()?.read_to_end(&mut bytes).map_err(|error| file.unreadable(&error))?;
    let refused = |error: cosfly_pedestrians::RecordedError| file.refused(&error, &error.hint);
    let recording = Recording::read(&bytes, &source.options).map_err(refused)?;
    notes.extend(recording.warnings.iter().map(|warning| format!("{}: {warning}", file.name())));
    Ok(Box::new(recording.placed(town, &source.options, clock, seed).map_err(refused)?))
}

fn sumo(
    source: &SumoSource,
    files: &[TrackFile],
    town: &Town,
    clock: Clock,
    seed: Seed,
) -> Result<Box<dyn Population>> {
    let [traffic, net] = files else { return Err(Diagnostic::new("traffic-files", Fault::Bug, "a file is missing")) };
    let refused = |file: &TrackFile, error: FcdError| file.refused(&error, error.hint.as_deref().unwrap_or_default());
    let mut head = vec![];
    net.opened()?.take(NET_HEAD_BYTES).read_to_end(&mut head).map_err(|error| net.unreadable(&error))?;
    let net_location = NetLocation::of_net(&head).map_err(|error| refused(net, error))?;
    let place = FcdProjection::new(town, &net_location, source.options.geo).map_err(|error| refused(net, error))?;
    let recorded = fcd::read(BufReader::new(traffic.opened()?), &place, &source.options, clock, seed)
        .map_err(|error| refused(traffic, error))?;
    Ok(Box::new(recorded))
}

fn refusal(error: &dyn std::fmt::Display, hint: impl Into<String>, town: &str) -> Box<Diagnostic> {
    Diagnostic::new("traffic-refused", Fault::Input, format!("{error}")).because(format!("in town `{town}`")).hint(hint)
}
