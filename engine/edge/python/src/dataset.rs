//! A published dataset: its tables, and random access to the images of its logs.

use crate::errors::raised;
use crate::images::{Image, checked};
use crate::table::Table;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_read::{ImageLog, PublishedDataset, PublishedFlight};
use cosfly_render::channels::{self, Channel};
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

/// Logs kept open; each needs a file descriptor and about 100 kB for its index.
const OPEN_LOGS: usize = 64;

/// Reader of one dataset.
#[pyclass(frozen, module = "cosfly._cosfly")]
pub struct Reader {
    dataset: PublishedDataset,
    /// Open logs by the number of their trajectory, the latest last.
    logs: Mutex<VecDeque<(usize, Arc<ImageLog>)>>,
}

#[pymethods]
impl Reader {
    #[new]
    fn new(py: Python<'_>, folder: PathBuf) -> PyResult<Self> {
        let dataset = raised(py, py.detach(|| PublishedDataset::open(&folder)))?;
        Ok(Self { dataset, logs: Mutex::default() })
    }

    /// Ids of the trajectories; their numbers are places in this list.
    #[getter]
    fn trajectory_ids(&self) -> Vec<&str> {
        self.dataset.flights().iter().map(|flight| flight.trajectory_id.as_str()).collect()
    }

    /// Splits of the trajectories, in the same order.
    #[getter]
    fn splits(&self) -> Vec<&str> {
        self.dataset.flights().iter().map(|flight| flight.split.as_str()).collect()
    }

    /// Numbers of frames of the trajectories, in the same order.
    #[getter]
    fn frames(&self) -> Vec<usize> {
        self.dataset.flights().iter().map(|flight| flight.frames).collect()
    }

    /// Image sizes (width, height) of the trajectories, pixels, in the same order.
    #[getter]
    fn sizes(&self) -> Vec<(u32, u32)> {
        self.dataset.flights().iter().map(|flight| (flight.camera.width, flight.camera.height)).collect()
    }

    /// A table, of one split or of all.
    #[pyo3(signature = (name, split = None))]
    fn table(&self, py: Python<'_>, name: &str, split: Option<&str>) -> PyResult<Table> {
        let files = raised(py, self.dataset.files(name))?;
        if files.is_empty() {
            return raised(py, Err(self.no_table(name)));
        }
        let is_wanted = |of: &str| split.is_none_or(|split| split == of || !matches!(of, "train" | "val" | "test"));
        Ok(Table { files: files.into_iter().filter(|(of, _)| is_wanted(of)).map(|(_, path)| path).collect() })
    }

    /// Names of the channels in the log of a trajectory.
    fn channels(&self, py: Python<'_>, trajectory: usize) -> PyResult<Vec<&'static str>> {
        let log = raised(py, self.log(self.flight(trajectory)?, trajectory))?;
        Ok(log.channels().collect())
    }

    /// Images of some frames of some trajectories, in the given order: for each channel a list of arrays. Threads share the
    /// work; the result does not depend on their number.
    #[pyo3(signature = (frames, channels, size = None, threads = 1))]
    fn images<'py>(
        &self,
        py: Python<'py>,
        frames: Vec<(usize, usize)>,
        channels: Vec<String>,
        size: Option<(usize, usize)>,
        threads: usize,
    ) -> PyResult<Bound<'py, PyDict>> {
        let size = checked(size)?;
        let known: Result<Vec<&'static Channel>> = channels.iter().map(|name| channel(name)).collect();
        let known = raised(py, known)?;
        for (trajectory, frame) in &frames {
            let flight = self.flight(*trajectory)?;
            if *frame >= flight.frames {
                let (id, frames) = (&flight.trajectory_id, flight.frames);
                return Err(PyIndexError::new_err(format!(
                    "frame {frame} is beyond `{id}`, which has {frames} frames"
                )));
            }
        }
        let jobs: Vec<_> = known.iter().flat_map(|it| frames.iter().map(|frame| (*it, *frame))).collect();
        let images = raised(py, py.detach(|| self.all(&jobs, size, threads)))?;
        let found = PyDict::new(py);
        let mut images = images.into_iter();
        for channel in &known {
            let arrays: PyResult<Vec<_>> =
                images.by_ref().take(frames.len()).map(|image| image.into_array(py)).collect();
            found.set_item(channel.name, PyList::new(py, arrays?)?)?;
        }
        Ok(found)
    }

    /// The stored file of a colour image, undecoded.
    fn rgb_file(&self, py: Python<'_>, trajectory: usize, frame: usize) -> PyResult<Vec<u8>> {
        let flight = self.flight(trajectory)?;
        let stored = self.log(flight, trajectory).and_then(|log| log.image(&channels::rgb::CHANNEL, frame));
        match raised(py, stored)? {
            cosfly_read::StoredImage::File(file, _) => Ok(file.to_vec()),
            cosfly_read::StoredImage::Raw { .. } => Ok(vec![]),
        }
    }
}

impl Reader {
    fn flight(&self, trajectory: usize) -> PyResult<&PublishedFlight> {
        let all = self.dataset.flights();
        let message = || format!("trajectory {trajectory} is beyond the dataset, which has {} trajectories", all.len());
        all.get(trajectory).ok_or_else(|| PyIndexError::new_err(message()))
    }

    /// The open log of a trajectory; the one unused for longest is closed when there are too many.
    fn log(&self, flight: &PublishedFlight, trajectory: usize) -> Result<Arc<ImageLog>> {
        let mut logs = self.logs.lock().unwrap_or_else(PoisonError::into_inner);
        let place = logs.iter().position(|(number, _)| *number == trajectory);
        let entry = match place.and_then(|place| logs.remove(place)) {
            Some(entry) => entry,
            None => (trajectory, Arc::new(self.dataset.image_log(flight)?)),
        };
        let log = Arc::clone(&entry.1);
        logs.push_back(entry);
        if logs.len() > OPEN_LOGS {
            logs.pop_front();
        }
        Ok(log)
    }

    /// Images of all jobs in their order.
    fn all(&self, jobs: &[(&Channel, (usize, usize))], size: Option<[usize; 2]>, threads: usize) -> Result<Vec<Image>> {
        let one = |(channel, (trajectory, frame)): &(&Channel, (usize, usize))| {
            let flight = &self.dataset.flights()[*trajectory];
            Image::unpack(channel, self.log(flight, *trajectory)?.image(channel, *frame)?, size)
        };
        let threads = threads.clamp(1, jobs.len().max(1));
        if threads == 1 {
            return jobs.iter().map(one).collect();
        }
        // Threads of this call alone: a pool would not survive a fork.
        let mut parts: Vec<Result<Vec<(usize, Image)>>> = vec![];
        std::thread::scope(|scope| {
            let started: Vec<_> = (0..threads)
                .map(|first| {
                    let mine = jobs.iter().enumerate().skip(first).step_by(threads);
                    scope.spawn(move || mine.map(|(place, job)| Ok((place, one(job)?))).collect())
                })
                .collect();
            let lost = || Diagnostic::new("internal-panic", Fault::Bug, "a thread that decodes images panicked");
            parts.extend(started.into_iter().map(|thread| thread.join().unwrap_or_else(|_| Err(lost()))));
        });
        let mut images: Vec<(usize, Image)> = vec![];
        for part in parts {
            images.extend(part?);
        }
        images.sort_by_key(|(place, _)| *place);
        Ok(images.into_iter().map(|(_, image)| image).collect())
    }

    fn no_table(&self, name: &str) -> Box<Diagnostic> {
        let folder = self.dataset.folder().display().to_string();
        Diagnostic::new("dataset-none", Fault::Input, format!("`{folder}` has no table `{name}`"))
            .hint("the tables are the folders in `data`")
    }
}

/// The channel called `name`.
fn channel(name: &str) -> Result<&'static Channel> {
    channels::called(name).ok_or_else(|| {
        let all: Vec<_> = channels::ALL.iter().map(|channel| channel.name).collect();
        Diagnostic::new("dataset-channel", Fault::Recipe, format!("there is no channel `{name}`"))
            .hint(format!("the channels are {}", all.join(", ")))
    })
}
