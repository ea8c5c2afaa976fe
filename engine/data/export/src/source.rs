//! The flights that are exported, one at a time, with their rows, captions and pictures.

use crate::called::flights_called;
use crate::shared_options::InstructionLanguage;
use crate::whole_log::whole_log;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_domain::{Channel, channels};
use cosfly_frames::Pose;
use cosfly_read::{
    CaptionReader, FrameRow, LogReader, LoggedFrame, LoggedSweep, PublishedDataset, PublishedFlight, RowIndex,
    inner_path,
};
use cosfly_schema::CaptionRecord;
use cosfly_schema::log::reading::LoggedSensor;
use rayon::prelude::*;
use std::cell::{Cell, OnceCell, RefCell};
use std::collections::BTreeSet;
use std::sync::{Mutex, PoisonError};

/// Number of frames that are read and encoded at the same time, so that memory does not grow with the length of a flight.
const BATCH: usize = 16;

/// The flights of a dataset that are exported.
#[derive(Clone, Debug, Default)]
pub struct Choice {
    /// Splits to export; all when empty.
    pub splits: Vec<String>,
    /// Ids of the trajectories to export, or patterns with `*`; all when empty.
    pub trajectories: Vec<String>,
}

/// A dataset with the flights that were chosen from it.
pub struct Source<'a> {
    /// The dataset.
    pub dataset: &'a PublishedDataset,
    /// Trajectory ids of the chosen flights.
    chosen: BTreeSet<String>,
    captions: RefCell<CaptionReader>,
    /// Places of the rows of table `frames`.
    index: OnceCell<RowIndex>,
    progress: &'a dyn Fn(u64, u64),
    done: Cell<u64>,
    all: Cell<u64>,
    /// Flights whose instruction is not in the wanted language: in another one, and a plain one without any caption.
    fallen_back: RefCell<[BTreeSet<String>; 2]>,
    /// Trajectory ids of the films whose logs are whole.
    whole: RefCell<BTreeSet<String>>,
}

/// A flight with its frames.
pub struct ExportedFlight<'a> {
    /// Row of the table of flights.
    pub flight: &'a PublishedFlight,
    /// Rows of the table of frames.
    pub frames: Vec<FrameRow>,
    /// Captions in all languages.
    pub captions: Vec<CaptionRecord>,
    source: &'a Source<'a>,
    /// Open logs of the flight that no thread reads now.
    logs: Mutex<Vec<LogReader>>,
}

/// A sensor that is no camera, and its readings: time since the first frame, nanoseconds, and numbers of the quantities.
pub type SensorReadings = (LoggedSensor, Vec<(u64, Vec<f64>)>);

/// A lidar, and its sweeps.
pub type LidarSweeps = (String, Vec<LoggedSweep>);

impl<'a> Source<'a> {
    /// The flights of `dataset` in `choice`. `progress` is called with the number of frames that are done and of all.
    ///
    /// # Errors
    /// `export-nothing` when no flight is chosen, `export-split` and `dataset-no-flight` for names that the dataset lacks.
    pub fn new(dataset: &'a PublishedDataset, choice: &Choice, progress: &'a dyn Fn(u64, u64)) -> Result<Self> {
        let splits: BTreeSet<&str> = dataset.flights().iter().map(|flight| &*flight.split).collect();
        if let Some(unknown) = choice.splits.iter().find(|name| !splits.contains(name.as_str())) {
            let names: Vec<_> = splits.iter().map(|name| format!("`{name}`")).collect();
            return Err(Diagnostic::new("export-split", Fault::Recipe, format!("there is no split `{unknown}`"))
                .hint(format!("the splits of this dataset are {}", names.join(", "))));
        }
        let called = flights_called(dataset, &choice.trajectories)?;
        let called: BTreeSet<&str> = called.iter().map(|flight| flight.trajectory_id.as_str()).collect();
        let is_chosen = |flight: &&PublishedFlight| {
            (choice.splits.is_empty() || choice.splits.contains(&flight.split))
                && (called.is_empty() || called.contains(flight.trajectory_id.as_str()))
        };
        let chosen: Vec<_> = dataset.flights().iter().filter(is_chosen).collect();
        if chosen.is_empty() {
            let message = "no flight is both in the splits and among the trajectories that were asked for";
            return Err(Diagnostic::new("export-nothing", Fault::Recipe, message));
        }
        let all = chosen.iter().map(|flight| flight.frames as u64).sum();
        Ok(Self {
            dataset,
            chosen: chosen.into_iter().map(|flight| flight.trajectory_id.clone()).collect(),
            captions: RefCell::new(CaptionReader::of(dataset)?),
            index: OnceCell::new(),
            progress,
            done: Cell::new(0),
            all: Cell::new(all),
            fallen_back: RefCell::default(),
            whole: RefCell::default(),
        })
    }

    /// Name of the dataset, which is the same in every copy.
    pub fn name(&self) -> String {
        self.dataset.name()
    }

    /// The chosen flights, in the dataset's order.
    pub fn flights(&self) -> impl Iterator<Item = &'a PublishedFlight> {
        self.dataset.flights().iter().filter(|flight| self.chosen.contains(&flight.trajectory_id))
    }

    /// Splits of the chosen flights, in the dataset's order.
    pub fn splits(&self) -> Vec<&'a str> {
        let mut splits: Vec<&str> = self.flights().map(|flight| &*flight.split).collect();
        splits.dedup();
        splits
    }

    /// Remarks about instructions that are not what was asked for.
    pub fn remarks(&self) -> Vec<String> {
        let [other, plain] = &*self.fallen_back.borrow();
        let flights = |ids: &BTreeSet<String>| cosfly_diagnose::counted(ids.len(), "flight");
        let remarks = [
            (other, "without a caption in the language asked for: the instruction is in another one"),
            (
                plain,
                "without a caption: the instruction is a plain sentence, the same for all that follow somebody, and singles nobody out",
            ),
        ];
        remarks
            .into_iter()
            .filter(|(ids, _)| !ids.is_empty())
            .map(|(ids, words)| format!("{} {words}", flights(ids)))
            .collect()
    }

    /// The channels on request of the chosen flights' logs, all of them together.
    ///
    /// # Errors
    /// A log that cannot be opened.
    pub fn channels_on_request(&self) -> Result<Vec<&'static Channel>> {
        let mut found = BTreeSet::new();
        for flight in self.flights() {
            found.extend(self.dataset.log(flight)?.channels().iter().map(|channel| channel.name));
        }
        let is_found = |channel: &&Channel| channel.is_on_request() && found.contains(channel.name);
        Ok(channels::ALL.iter().copied().filter(is_found).collect())
    }

    /// The flight called `id`, chosen or not.
    pub fn flight(&self, id: &str) -> Option<&'a PublishedFlight> {
        self.dataset.place(id).map(|place| &self.dataset.flights()[place])
    }

    /// Calls `visit` with each chosen flight, in the dataset's order. One is in memory at a time.
    pub fn each_flight(&self, visit: &mut dyn FnMut(&ExportedFlight<'_>) -> Result<()>) -> Result<()> {
        self.each_flight_of(&|_| true, visit)
    }

    /// Calls `visit` with each chosen flight that is `wanted`, in the dataset's order.
    pub fn each_flight_of(
        &self,
        wanted: &dyn Fn(&PublishedFlight) -> bool,
        visit: &mut dyn FnMut(&ExportedFlight<'_>) -> Result<()>,
    ) -> Result<()> {
        let is_wanted = |flight: &PublishedFlight| self.chosen.contains(&flight.trajectory_id) && wanted(flight);
        self.all.set(self.flights().filter(|flight| wanted(flight)).map(|flight| flight.frames as u64).sum());
        self.done.set(0);
        self.dataset.walk(&is_wanted, &mut |flight, frames| {
            let place = self.dataset.place(&flight.trajectory_id).unwrap_or_default();
            let captions = self.captions.borrow_mut().at(self.dataset, place)?.to_vec();
            let end = self.done.get() + frames.len() as u64;
            visit(&ExportedFlight { flight, frames, captions, source: self, logs: Mutex::default() })?;
            self.set_done(end);
            Ok(())
        })
    }

    /// A flight with its rows, beside the one that is visited; it has no captions.
    ///
    /// # Errors
    /// Damage of table `frames`.
    pub fn exported<'b>(&'b self, flight: &'b PublishedFlight) -> Result<ExportedFlight<'b>> {
        let frames = self.dataset.frames(self.rows()?, flight)?;
        Ok(ExportedFlight { flight, frames, captions: vec![], source: self, logs: Mutex::default() })
    }

    /// Places of the rows of table `frames`, read once.
    fn rows(&self) -> Result<&RowIndex> {
        if let Some(index) = self.index.get() {
            return Ok(index);
        }
        let index = self.dataset.row_index("frames")?;
        Ok(self.index.get_or_init(|| index))
    }

    /// Poses of a flight's expert, which need not be chosen; none where the dataset lacks it.
    ///
    /// # Errors
    /// Damage of table `frames`.
    pub fn expert_poses(&self, flight: &PublishedFlight) -> Result<Vec<Pose>> {
        let expert = flight.expert_id.as_deref().unwrap_or(&flight.trajectory_id);
        let Some(place) = self.dataset.place(expert) else { return Ok(vec![]) };
        Ok(self.dataset.tracks(self.rows()?, &[place].into())?.remove(&place).map_or(vec![], |track| track.poses))
    }

    /// Opens the log of a film, which is compared with its checksums the first time.
    ///
    /// # Errors
    /// Damage of the log.
    pub fn log(&self, film: &PublishedFlight) -> Result<LogReader> {
        let log = self.dataset.log(film)?;
        if self.whole.borrow_mut().insert(film.trajectory_id.clone())
            && let Some(path) = inner_path(self.dataset.folder(), &film.mcap_path)
        {
            whole_log(&path)?;
        }
        Ok(log)
    }

    /// Readings of the sensors of a flight that are no cameras.
    ///
    /// # Errors
    /// Damage of the log.
    pub fn readings(&self, flight: &PublishedFlight) -> Result<Vec<SensorReadings>> {
        let mut log = self.log(flight)?;
        log.sensors().into_iter().map(|sensor| log.readings(&sensor).map(|all| (sensor, all))).collect()
    }

    fn set_done(&self, done: u64) {
        self.done.set(done);
        (self.progress)(done, self.all.get());
    }
}

impl ExportedFlight<'_> {
    /// Readings of the flight's sensors that are no cameras.
    ///
    /// # Errors
    /// Damage of the log.
    pub fn readings(&self) -> Result<Vec<SensorReadings>> {
        self.source.readings(self.flight)
    }

    /// Sweeps of the flight's lidars.
    ///
    /// # Errors
    /// Damage of the log.
    pub fn sweeps(&self) -> Result<Vec<LidarSweeps>> {
        let mut log = self.source.log(self.flight)?;
        log.lidars().into_iter().map(|lidar| log.sweeps(&lidar).map(|all| (lidar, all))).collect()
    }

    /// Reads the pictures of the flight's frames `frames`, calls `make` with them on all cores, and `take` with its results
    /// in the order of `frames`.
    pub fn each_picture<T: Send>(
        &self,
        frames: &[usize],
        make: impl Fn(usize, LoggedFrame) -> Result<T> + Sync,
        take: impl FnMut(usize, T) -> Result<()>,
    ) -> Result<()> {
        self.each_picture_of(self.flight, frames, make, take)
    }

    /// [`Self::each_picture`] of another film of the flight that has the same moments; progress is that of this one.
    pub fn each_picture_of<T: Send>(
        &self,
        film: &PublishedFlight,
        frames: &[usize],
        make: impl Fn(usize, LoggedFrame) -> Result<T> + Sync,
        take: impl FnMut(usize, T) -> Result<()>,
    ) -> Result<()> {
        let is_own = film.trajectory_id == self.flight.trajectory_id;
        let own = Mutex::default();
        let logs = if is_own { &self.logs } else { &own };
        let done =
            |frames: usize| self.source.set_done(self.source.done.get() + if is_own { frames as u64 } else { 0 });
        self.pictures((film, logs), frames, make, take, &done)
    }

    /// [`Self::each_picture`] that no progress is shown of: a look ahead.
    pub fn each_picture_silently<T: Send>(
        &self,
        frames: &[usize],
        make: impl Fn(usize, LoggedFrame) -> Result<T> + Sync,
        take: impl FnMut(usize, T) -> Result<()>,
    ) -> Result<()> {
        self.pictures((self.flight, &self.logs), frames, make, take, &|_| {})
    }

    fn pictures<T: Send>(
        &self,
        (flight, logs): (&PublishedFlight, &Mutex<Vec<LogReader>>),
        frames: &[usize],
        make: impl Fn(usize, LoggedFrame) -> Result<T> + Sync,
        mut take: impl FnMut(usize, T) -> Result<()>,
        done: &dyn Fn(usize),
    ) -> Result<()> {
        let dataset = self.source.dataset;
        let mut open = logs.lock().unwrap_or_else(PoisonError::into_inner);
        if open.is_empty() {
            open.push(self.source.log(flight)?);
        }
        drop(open);
        let made_of = |frame: &usize| {
            // Each thread opens the log once at most.
            let open = logs.lock().unwrap_or_else(PoisonError::into_inner).pop();
            let mut log = open.map_or_else(|| dataset.log(flight), Ok)?;
            let made = make(*frame, log.frame_with_instances(*frame)?);
            logs.lock().unwrap_or_else(PoisonError::into_inner).push(log);
            made
        };
        for batch in frames.chunks(BATCH) {
            let made: Vec<T> = batch.par_iter().map(made_of).collect::<Result<_>>()?;
            for (frame, made) in batch.iter().zip(made) {
                take(*frame, made)?;
            }
            done(batch.len());
        }
        Ok(())
    }

    /// The expert's pose of every frame (for an expert, the own poses).
    ///
    /// # Errors
    /// `dataset-damaged` when the expert or one of its frames is absent.
    pub fn expert_poses(&self) -> Result<Vec<Pose>> {
        let flight = self.flight;
        let poses = self.source.expert_poses(flight)?;
        let pose = |(frame, row): (usize, &FrameRow)| {
            let expert_frame = row.disturbance.as_ref().map_or(frame, |it| it.expert_frame as usize);
            poses.get(expert_frame).copied().ok_or_else(|| {
                let message = format!("the expert of frame {frame} of `{}` is not there", flight.trajectory_id);
                Diagnostic::new("dataset-damaged", Fault::Input, message)
            })
        };
        self.frames.iter().enumerate().map(pose).collect()
    }

    /// Some of the frames as an episode. Its pictures keep the frame numbers of the whole flight.
    pub fn part(&self, frames: std::ops::Range<usize>) -> ExportedFlight<'_> {
        ExportedFlight {
            flight: self.flight,
            frames: self.frames[frames].to_vec(),
            captions: self.captions.clone(),
            source: self.source,
            logs: Mutex::default(),
        }
    }

    /// Every frame.
    pub fn all_frames(&self) -> Vec<usize> {
        (0..self.frames.len()).collect()
    }

    /// The first frame and every `step`-th after it.
    pub fn every_nth_frame(&self, step: usize) -> Vec<usize> {
        (0..self.frames.len()).step_by(step.max(1)).collect()
    }

    /// The instruction in `language`, else in any language, else a plain one.
    pub fn instruction(&self, language: InstructionLanguage) -> &str {
        if let Some(own) = self.captions.iter().find(|caption| caption.language == language.code()) {
            return &own.text;
        }
        let first = self.captions.first();
        let [other, plain] = &mut *self.source.fallen_back.borrow_mut();
        let list = if first.is_some() { other } else { plain };
        list.insert(self.flight.trajectory_id.clone());
        first.map_or(language.plain_instruction(self.flight.target_kind.is_some()), |caption| &caption.text)
    }
}
