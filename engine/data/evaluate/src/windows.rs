//! The windows of a dataset: inputs of models, and the truth.

use crate::settings::{InputRole, Settings};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_frames::Pose;
use cosfly_metrics::baselines::{Anchor, View};
use cosfly_metrics::difficulty::WindowFrames;
use cosfly_metrics::{WindowFeatures, WindowShape};
use cosfly_read::{FlightTrack, PublishedDataset, PublishedFlight};
use std::collections::{BTreeMap, BTreeSet};

/// A dataset's flights with their tracks.
#[derive(Debug)]
pub struct Flights {
    /// Name of the dataset's folder.
    pub name: String,
    /// The folder as it was given.
    pub folder: String,
    /// Rows of the table of flights.
    pub rows: Vec<PublishedFlight>,
    /// Frames of each flight.
    pub tracks: Vec<FlightTrack>,
    /// The expert of each flight; itself for an expert.
    pub expert: Vec<usize>,
    places: BTreeMap<String, usize>,
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
    /// Reads all flights of `dataset`.
    ///
    /// # Errors
    /// Damage of the dataset: an expert that is not there, or frames that an expert does not have.
    pub fn read(dataset: &PublishedDataset) -> Result<Self> {
        let all = (0..dataset.flights().len()).collect();
        let tracks: Vec<FlightTrack> = dataset.tracks(&dataset.row_index("frames")?, &all)?.into_values().collect();
        let rows = dataset.flights().to_vec();
        let places: BTreeMap<String, usize> =
            rows.iter().enumerate().map(|(place, row)| (row.trajectory_id.clone(), place)).collect();
        let mut expert = Vec::with_capacity(rows.len());
        for (place, (row, track)) in rows.iter().zip(&tracks).enumerate() {
            let damaged = |what: String| {
                let message = format!("flight `{}` {what}", row.trajectory_id);
                Diagnostic::new("dataset-damaged", Fault::Input, message)
            };
            let of = row.expert_id.as_ref().map_or(Some(place), |id| places.get(id).copied());
            let of = of.ok_or_else(|| {
                damaged(format!(
                    "has the expert `{}`, which is not there",
                    row.expert_id.as_deref().unwrap_or_default()
                ))
            })?;
            let frames = tracks[of].poses.len();
            if let Some(frame) = track.expert_frame.iter().find(|frame| **frame as usize >= frames) {
                return Err(damaged(format!("belongs to frame {frame} of an expert with {frames} frames")));
            }
            expert.push(of);
        }
        let folder = dataset.folder();
        let name = folder.file_name().map_or_else(|| ".".to_owned(), |name| name.to_string_lossy().into_owned());
        Ok(Self { name, folder: folder.display().to_string(), rows, tracks, expert, places })
    }

    /// Place of a flight.
    pub fn place(&self, trajectory_id: &str) -> Option<usize> {
        self.places.get(trajectory_id).copied()
    }

    /// Place of a flight by its id as keys of WebDataset have it, with `_` for `.`.
    pub fn place_by_key(&self, key: &str) -> Option<usize> {
        self.rows.iter().position(|row| row.trajectory_id.contains('.') && row.trajectory_id.replace('.', "_") == key)
    }

    /// Which flights models see.
    pub fn role(&self, flight: usize) -> InputRole {
        if self.rows[flight].expert_id.is_some() { InputRole::Perturbed } else { InputRole::Expert }
    }

    /// The inputs of a window.
    pub fn view(&self, window: Window, shape: &WindowShape) -> View<'_> {
        let (track, camera) = (&self.tracks[window.flight], &self.rows[window.flight].camera);
        let frames = window.start..window.start + shape.history;
        View {
            poses: &track.poses[frames.clone()],
            feet: &track.feet[frames.clone()],
            boxes: &track.boxes[frames],
            image_px: [camera.width as f32, camera.height as f32],
            horizon: shape.horizon,
        }
    }

    /// The expert's frame of frame `frame` of the flight of `window`.
    fn expert_frame(&self, window: Window, frame: usize) -> (usize, usize) {
        (self.expert[window.flight], self.tracks[window.flight].expert_frame[frame] as usize)
    }

    /// The expert's poses in the frames to predict.
    pub fn truth(&self, window: Window, shape: &WindowShape) -> Vec<Pose> {
        let first = window.start + shape.history;
        let pose = |frame| {
            let (expert, frame) = self.expert_frame(window, frame);
            self.tracks[expert].poses[frame]
        };
        (first..first + shape.horizon).map(pose).collect()
    }

    /// The target's boxes in the expert's images of the frames to predict.
    pub fn true_boxes(&self, window: Window, shape: &WindowShape) -> impl Iterator<Item = Option<[f64; 4]>> {
        let first = window.start + shape.history;
        (first..first + shape.horizon).map(move |frame| {
            let (expert, frame) = self.expert_frame(window, frame);
            self.tracks[expert].boxes[frame].map(|edges| edges.map(f64::from))
        })
    }

    /// The pose that increments start from.
    pub fn anchor(&self, window: Window, shape: &WindowShape, anchor: Anchor) -> Pose {
        let current = window.start + shape.history - 1;
        match anchor {
            Anchor::Input => self.tracks[window.flight].poses[current],
            Anchor::Expert => {
                let (expert, frame) = self.expert_frame(window, current);
                self.tracks[expert].poses[frame]
            }
        }
    }

    /// Features that make a window easy or hard.
    pub fn features(&self, window: Window, shape: &WindowShape) -> WindowFeatures {
        let track = &self.tracks[window.flight];
        let frames = window.start..window.start + shape.size();
        let of_expert = |frame| self.expert_frame(window, frame);
        let expert: Vec<Pose> = frames.clone().map(of_expert).map(|(it, frame)| self.tracks[it].poses[frame]).collect();
        let visible: Vec<f64> =
            frames.clone().map(of_expert).map(|(it, frame)| self.tracks[it].visible[frame]).collect();
        WindowFeatures::of(&WindowFrames {
            expert: &expert,
            feet: &track.feet[frames.clone()],
            heading_rad: &track.heading_rad[frames],
            visible: &visible,
            dt_s: self.rows[window.flight].dt_s,
        })
    }
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
            if windows > 0 && flights.role(flight) == settings.input && splits.contains(&row.split) {
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
