//! The windows of a dataset: inputs of models, and the truth.

use crate::settings::{InputRole, Settings};
use cosfly_diagnose::{Diagnostic, Fault, Result, counted};
use cosfly_frames::Pose;
use cosfly_metrics::baselines::{Anchor, InputFrames};
use cosfly_read::{FlightTrack, PublishedDataset, PublishedFlight, RowIndex};
use cosfly_windows::{WindowFeatures, WindowFrames, WindowShape};
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Frames whose tracks are in memory at a time.
const FRAMES_AT_ONCE: usize = 250_000;

/// A dataset's flights, with the tracks of all or some of them.
#[derive(Clone, Debug)]
pub struct Flights {
    /// Name of the dataset, which is the same in every copy.
    pub name: String,
    /// The folder as it was given.
    pub folder: String,
    /// Rows of the table of flights.
    pub rows: Arc<Vec<PublishedFlight>>,
    /// The expert of each flight; itself for an expert.
    pub expert: Arc<Vec<usize>>,
    /// Flights whose ids have a dot, by their keys in WebDataset.
    by_key: Arc<BTreeMap<String, usize>>,
    dataset: Arc<PublishedDataset>,
    index: Arc<RowIndex>,
    /// Frames of the flights that are loaded.
    tracks: BTreeMap<usize, FlightTrack>,
    frames_at_once: usize,
}

/// A window: flight and first frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// Place of the flight that the model sees.
    pub flight: usize,
    /// First frame.
    pub start: usize,
}

impl Flights {
    /// Reads the flights of `dataset`; their tracks, too, where they have a quarter of a million frames at most.
    ///
    /// # Errors
    /// Damage of the dataset: an expert that is not there, or frames that an expert does not have.
    pub fn read(dataset: &PublishedDataset) -> Result<Self> {
        Self::with_frames_at_once(dataset, FRAMES_AT_ONCE)
    }

    /// Reads the flights of `dataset`, with tracks of so many frames in memory at a time.
    ///
    /// # Errors
    /// Those of [`Self::read`].
    pub fn with_frames_at_once(dataset: &PublishedDataset, frames_at_once: usize) -> Result<Self> {
        let rows = dataset.shared_flights();
        let mut expert = Vec::with_capacity(rows.len());
        for (place, row) in rows.iter().enumerate() {
            let of = row.expert_id.as_ref().map_or(Some(place), |id| dataset.place(id));
            let absent =
                || format!("has the expert `{}`, which is not there", row.expert_id.as_deref().unwrap_or_default());
            expert.push(of.ok_or_else(|| damaged(row, &absent()))?);
        }
        let dotted = rows.iter().enumerate().filter(|(_, row)| row.trajectory_id.contains('.'));
        let by_key = dotted.rev().map(|(place, row)| (row.trajectory_id.replace('.', "_"), place)).collect();
        let mut flights = Self {
            name: dataset.name(),
            folder: dataset.folder().display().to_string(),
            rows,
            expert: Arc::new(expert),
            by_key: Arc::new(by_key),
            dataset: Arc::new(dataset.clone()),
            index: Arc::new(dataset.row_index("frames")?),
            tracks: BTreeMap::new(),
            frames_at_once,
        };
        if flights.rows.iter().map(|row| row.frames).sum::<usize>() <= frames_at_once {
            flights.tracks = flights.load(&(0..flights.rows.len()).collect::<Vec<_>>())?;
        }
        Ok(flights)
    }

    /// Tracks of some flights and their experts.
    fn load(&self, flights: &[usize]) -> Result<BTreeMap<usize, FlightTrack>> {
        let wanted = flights.iter().flat_map(|flight| [*flight, self.expert[*flight]]).collect();
        let tracks = self.dataset.tracks(&self.index, &wanted)?;
        for flight in flights {
            let frames = self.rows[self.expert[*flight]].frames;
            if let Some(frame) = tracks[flight].expert_frame.iter().find(|frame| **frame as usize >= frames) {
                let what =
                    format!("belongs to frame {frame} of an expert with {frames}", frames = counted(frames, "frame"));
                return Err(damaged(&self.rows[*flight], &what));
            }
        }
        Ok(tracks)
    }

    /// Flights with the tracks of at least these and their experts.
    ///
    /// # Errors
    /// Damage of the dataset.
    pub fn part(&self, flights: &[usize]) -> Result<Cow<'_, Self>> {
        if flights.iter().all(|flight| self.tracks.contains_key(flight)) {
            return Ok(Cow::Borrowed(self));
        }
        let without = Self {
            name: self.name.clone(),
            folder: self.folder.clone(),
            rows: Arc::clone(&self.rows),
            expert: Arc::clone(&self.expert),
            by_key: Arc::clone(&self.by_key),
            dataset: Arc::clone(&self.dataset),
            index: Arc::clone(&self.index),
            tracks: BTreeMap::new(),
            frames_at_once: self.frames_at_once,
        };
        Ok(Cow::Owned(Self { tracks: self.load(flights)?, ..without }))
    }

    /// `items` in parts whose flights have about as many frames as may be in memory at a time.
    pub fn parts<'i, T>(&self, items: &'i [T], flight_of: &dyn Fn(&T) -> usize) -> Vec<&'i [T]> {
        let (mut parts, mut start, mut frames) = (vec![], 0, 0);
        for (at, item) in items.iter().enumerate() {
            let is_new = at == start || flight_of(&items[at - 1]) != flight_of(item);
            // With the expert's.
            let more = if is_new { 2 * self.rows[flight_of(item)].frames } else { 0 };
            if at > start && is_new && frames + more > self.frames_at_once {
                parts.push(&items[start..at]);
                (start, frames) = (at, 0);
            }
            frames += more;
        }
        parts.push(&items[start..]);
        parts
    }

    /// Track of a flight that is loaded.
    pub fn track(&self, flight: usize) -> &FlightTrack {
        &self.tracks[&flight]
    }

    /// Place of a flight.
    pub fn place(&self, trajectory_id: &str) -> Option<usize> {
        self.dataset.place(trajectory_id)
    }

    /// Place of a flight by its id as keys of WebDataset have it, with `_` for `.`.
    pub fn place_by_key(&self, key: &str) -> Option<usize> {
        self.by_key.get(key).copied()
    }

    /// Which flights models see.
    pub fn role(&self, flight: usize) -> InputRole {
        if self.rows[flight].expert_id.is_some() { InputRole::Perturbed } else { InputRole::Expert }
    }

    /// The inputs of a window.
    pub fn view(&self, window: Window, shape: &WindowShape) -> InputFrames<'_> {
        let (track, camera) = (self.track(window.flight), &self.rows[window.flight].camera);
        let frames = window.start..window.start + shape.history;
        InputFrames {
            poses: &track.poses[frames.clone()],
            feet: &track.feet[frames.clone()],
            boxes: &track.boxes[frames],
            image_px: [camera.width as f32, camera.height as f32],
            horizon: shape.horizon,
        }
    }

    /// The expert's frame of frame `frame` of the flight of `window`.
    fn expert_frame(&self, window: Window, frame: usize) -> (usize, usize) {
        (self.expert[window.flight], self.track(window.flight).expert_frame[frame] as usize)
    }

    /// The expert's poses in the frames to predict.
    pub fn truth(&self, window: Window, shape: &WindowShape) -> Vec<Pose> {
        let first = window.start + shape.history;
        let pose = |frame| {
            let (expert, frame) = self.expert_frame(window, frame);
            self.track(expert).poses[frame]
        };
        (first..first + shape.horizon).map(pose).collect()
    }

    /// The target's boxes in the expert's images of the frames to predict.
    pub fn true_boxes(&self, window: Window, shape: &WindowShape) -> impl Iterator<Item = Option<[f64; 4]>> {
        let first = window.start + shape.history;
        (first..first + shape.horizon).map(move |frame| {
            let (expert, frame) = self.expert_frame(window, frame);
            self.track(expert).boxes[frame].map(|edges| edges.map(f64::from))
        })
    }

    /// The pose that increments start from.
    pub fn anchor(&self, window: Window, shape: &WindowShape, anchor: Anchor) -> Pose {
        let current = window.start + shape.history - 1;
        match anchor {
            Anchor::Input => self.track(window.flight).poses[current],
            Anchor::Expert => {
                let (expert, frame) = self.expert_frame(window, current);
                self.track(expert).poses[frame]
            }
        }
    }

    /// Features that make a window easy or hard.
    pub fn features(&self, window: Window, shape: &WindowShape) -> WindowFeatures {
        let track = self.track(window.flight);
        let frames = window.start..window.start + shape.size();
        let of_expert = |frame| self.expert_frame(window, frame);
        let expert: Vec<Pose> = frames.clone().map(of_expert).map(|(it, frame)| self.track(it).poses[frame]).collect();
        let visible: Vec<f64> =
            frames.clone().map(of_expert).map(|(it, frame)| self.track(it).visible[frame]).collect();
        WindowFeatures::of(&WindowFrames {
            expert: &expert,
            feet: &track.feet[frames.clone()],
            heading_rad: &track.heading_rad[frames],
            visible: &visible,
            dt_s: self.rows[window.flight].dt_s,
        })
    }
}

fn damaged(row: &PublishedFlight, what: &str) -> Box<Diagnostic> {
    Diagnostic::new("dataset-damaged", Fault::Input, format!("flight `{}` {what}", row.trajectory_id))
}

/// The windows that are to be predicted, flight by flight.
#[derive(Debug)]
pub struct WindowSet {
    /// How they are cut.
    pub shape: WindowShape,
    /// Flights, in the dataset's order, with the number of their first window.
    pub flights: Vec<(usize, usize)>,
    /// Number of windows.
    pub len: usize,
    /// Place of a flight among [`Self::flights`].
    by_flight: BTreeMap<usize, usize>,
}

impl WindowSet {
    /// Windows of the flights of a role in some splits.
    pub fn new(flights: &Flights, settings: &Settings, splits: &BTreeSet<String>) -> Self {
        let mut set = Self { shape: settings.window, flights: vec![], len: 0, by_flight: BTreeMap::new() };
        for (flight, row) in flights.rows.iter().enumerate() {
            let windows = set.shape.count(row.frames);
            let is_chosen = splits.contains(&row.split) && settings.takes(row.camera_name.as_deref());
            if windows > 0 && flights.role(flight) == settings.input && is_chosen {
                set.by_flight.insert(flight, set.flights.len());
                set.flights.push((flight, set.len));
                set.len += windows;
            }
        }
        set
    }

    /// Windows of a flight with their numbers.
    pub fn of_flight(&self, (flight, first): (usize, usize), frames: usize) -> impl Iterator<Item = (usize, Window)> {
        self.shape.starts(frames).zip(first..).map(move |(start, number)| (number, Window { flight, start }))
    }

    /// Number of the window of `flight` that starts at `start`; `None` when there is none.
    pub fn number(&self, flight: usize, start: usize, frames: usize) -> Option<usize> {
        let (_, first) = self.flights[*self.by_flight.get(&flight)?];
        self.shape.number(start, frames).map(|window| first + window)
    }

    /// All windows in order.
    pub fn all<'a>(&'a self, flights: &'a Flights) -> impl Iterator<Item = Window> + 'a {
        self.flights.iter().flat_map(|(flight, first)| {
            self.of_flight((*flight, *first), flights.rows[*flight].frames).map(|(_, window)| window)
        })
    }
}
