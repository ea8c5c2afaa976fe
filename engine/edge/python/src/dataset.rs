//! A published dataset: its tables, and random access to the images of its logs.

use crate::errors::{raised, refused};
use crate::images::{Image, channel, checked};
use crate::table::Table;
use cosfly_diagnose::{Diagnostic, Fault, Result, counted};
use cosfly_domain::Channel;
use cosfly_domain::channels::rgb;
use cosfly_load::{FlightSource, LoadedFlight};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use std::path::PathBuf;
use std::sync::Arc;

/// Reader of one dataset, of any layout.
#[pyclass(frozen, module = "cosfly._cosfly")]
pub struct Reader(Arc<dyn FlightSource>);

#[pymethods]
impl Reader {
    #[new]
    fn new(py: Python<'_>, folder: PathBuf) -> PyResult<Self> {
        Ok(Self(Arc::from(raised(py, py.detach(|| cosfly_load::open(&folder)))?)))
    }

    /// Digest that tells the dataset from others.
    #[getter]
    fn identity(&self) -> &str {
        self.0.identity()
    }

    /// Refuses where the folder holds another dataset by now.
    fn check(&self, py: Python<'_>) -> PyResult<()> {
        raised(py, self.0.check())
    }

    /// Ids of the trajectories; their numbers are places in this list.
    #[getter]
    fn trajectory_ids(&self) -> Vec<&str> {
        self.0.flights().iter().map(|flight| flight.id.as_str()).collect()
    }

    /// Splits of the trajectories, in the same order.
    #[getter]
    fn splits(&self) -> Vec<&str> {
        self.0.flights().iter().map(|flight| flight.split.as_str()).collect()
    }

    /// Numbers of frames of the trajectories, in the same order.
    #[getter]
    fn frames(&self) -> Vec<usize> {
        self.0.flights().iter().map(|flight| flight.frames).collect()
    }

    /// Image sizes (width, height) of the trajectories, pixels, in the same order.
    #[getter]
    fn sizes(&self) -> Vec<(u32, u32)> {
        self.0.flights().iter().map(|flight| flight.size.into()).collect()
    }

    /// A table, of one split or of all.
    #[pyo3(signature = (name, split = None))]
    fn table(&self, py: Python<'_>, name: &str, split: Option<&str>) -> PyResult<Table> {
        let data = raised(py, py.detach(|| self.0.table(name, split)))?;
        Ok(Table { data, dataset: Arc::clone(&self.0) })
    }

    /// Names of the channels of a trajectory.
    fn channels(&self, py: Python<'_>, trajectory: usize) -> PyResult<Vec<&'static str>> {
        self.flight(py, trajectory)?;
        raised(py, self.0.channels(trajectory))
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
        let size = checked(py, size)?;
        let known: Result<Vec<&'static Channel>> = channels.iter().map(|name| channel(name)).collect();
        let known = raised(py, known)?;
        for (trajectory, frame) in &frames {
            let flight = self.flight(py, *trajectory)?;
            if *frame >= flight.frames {
                let (id, frames) = (&flight.id, flight.frames);
                let message =
                    format!("frame {frame} is beyond `{id}`, which has {frames}", frames = counted(frames, "frame"));
                return Err(refused(py, "OutOfRange", &message));
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
        self.flight(py, trajectory)?;
        match raised(py, self.0.image(trajectory, &rgb::CHANNEL, frame))? {
            cosfly_read::StoredImage::File(file, _) => Ok(file.to_vec()),
            cosfly_read::StoredImage::Raw { .. } => Ok(vec![]),
        }
    }
}

impl Reader {
    fn flight(&self, py: Python<'_>, trajectory: usize) -> PyResult<&LoadedFlight> {
        let all = self.0.flights();
        let message = || format!("trajectory {trajectory} is beyond the dataset, which has {} trajectories", all.len());
        all.get(trajectory).ok_or_else(|| refused(py, "OutOfRange", &message()))
    }

    /// Images of all jobs in their order.
    fn all(&self, jobs: &[(&Channel, (usize, usize))], size: Option<[usize; 2]>, threads: usize) -> Result<Vec<Image>> {
        let one = |(channel, (trajectory, frame)): &(&Channel, (usize, usize))| {
            Image::unpack(channel, self.0.image(*trajectory, channel, *frame)?, size)
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
}
