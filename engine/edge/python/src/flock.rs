//! Environments of `cosfly.gym`: a suite, and many environments over its episodes, stepped with the GIL released.

use crate::calls::on_own_threads;
use crate::errors::{InvalidValue, exception};
use cosfly::Refusal;
use cosfly_diagnose::Diagnostic;
use cosfly_domain::{ChannelSet, Weather, channels};
use cosfly_env::ActionNumber;
use cosfly_env::pictures::{PictureBatch, PictureFormat, Pixels};
use cosfly_fly::pilot::wrong_number;
use cosfly_fly::settings::FlySettings;
use cosfly_fly::suite::{EpisodeTask, Suite};
use cosfly_fly::vector::{ACTIONS, Autoreset, Copies, TERMS, VectorEnvironment};
use cosfly_render::PictureLook;
use cosfly_runner::RunOptions;
use cosfly_sensors::SensorSet;
use cosfly_store::Store;
use numpy::{Element, PyArrayDyn, PyArrayMethods, PyReadonlyArray2, PyReadwriteArrayDyn};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PySlice};
use std::borrow::Cow;
use std::path::PathBuf;
use std::sync::Arc;

/// Settings of environments: attributes of Python's `EnvConfig`.
#[derive(FromPyObject)]
struct EnvConfig {
    recipe: PathBuf,
    changes: Vec<String>,
    place: PathBuf,
    step_s: f64,
    latency_s: Option<f64>,
    expert_action: bool,
    channels: Vec<String>,
    sensors: Vec<String>,
    sides: (u32, u32),
    max_depth_m: f32,
    weather: Option<String>,
    look: String,
    threads: usize,
}

/// Environments over the episodes of a recipe.
#[pyclass(name = "VectorEnvironment")]
pub struct PyFlock {
    flock: VectorEnvironment,
    /// Arrays that every call of [`Self::outputs`] without copies fills and gives.
    kept: Option<Py<PyDict>>,
}

#[pymethods]
impl PyFlock {
    /// Makes the episodes that the store lacks, and `count` environments over them.
    #[new]
    fn new(py: Python<'_>, config: EnvConfig, count: usize, mode: &str, is_team: bool) -> PyResult<Self> {
        let mode = match mode {
            "next_step" => Autoreset::NextStep,
            "same_step" => Autoreset::SameStep,
            "disabled" => Autoreset::Disabled,
            other => return Err(InvalidValue::new_err(format!("`{other}` is no mode of autoreset"))),
        };
        let made = py.detach(|| on_own_threads(|| made(&config.recipe, &config.changes, &config.place)));
        let (tasks, suite) = match made {
            Ok(made) => made,
            Err(Refusal::Work(refusals)) => return Err(exception(py, &refusals)),
            Err(Refusal::Arguments(error)) => return Err(InvalidValue::new_err(error.to_string())),
        };
        let suite = suite.environment();
        let latency_s = config.latency_s.unwrap_or(suite.latency_s);
        if let Some(unknown) = config.sensors.iter().find(|name| cosfly_sensors::called(name).is_none()) {
            return Err(InvalidValue::new_err(format!("there is no sensor `{unknown}`")));
        }
        let sensors = SensorSet::of(|sensor| config.sensors.iter().any(|name| name == sensor.name));
        let settings = cosfly_env::EnvironmentSettings { step_s: config.step_s, latency_s, sensors, ..suite };
        let flock = VectorEnvironment::new(tasks, count, settings, mode, config.expert_action);
        let flock = if is_team { flock.as_team() } else { flock };
        let flock =
            flock.on_threads(config.threads.min(count)).map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
        if let Some(unknown) = config.channels.iter().find(|name| !channels::of_moments().any(|it| it.name == **name)) {
            return Err(InvalidValue::new_err(format!("there is no channel `{unknown}`")));
        }
        let channels = ChannelSet::of(|channel| config.channels.iter().any(|name| name == channel.name));
        if channels.is_empty() {
            return Ok(Self { flock, kept: None });
        }
        let weather = config.weather.as_deref().map(preset).transpose()?;
        let look = PictureLook::named(&config.look).ok_or_else(|| {
            let known = PictureLook::ALL.map(|(name, _)| name).join(", ");
            InvalidValue::new_err(format!("look is `{}`; it is one of {known}", config.look))
        })?;
        let (width, height) = config.sides;
        let farthest_m = config.max_depth_m;
        let format = PictureFormat { width, height, channels, farthest_m, weather, look };
        Ok(Self { flock: flock.with_pictures(format), kept: None })
    }

    /// Begins episodes: of all environments, or of those that `mask` chooses.
    fn reset(&mut self, py: Python<'_>, seeds: Vec<Option<u64>>, mask: Option<Vec<bool>>) {
        let flock = &mut self.flock;
        py.detach(|| flock.reset(&seeds, |number| mask.as_ref().is_none_or(|mask| mask.get(number) == Some(&true))));
    }

    /// Begins the draws of environments anew, without an episode.
    fn seed(&mut self, seeds: Vec<Option<u64>>) {
        self.flock.seed(&seeds);
    }

    /// One step of all environments.
    fn step(&mut self, py: Python<'_>, actions: Actions<'_>) -> PyResult<()> {
        match &actions {
            Actions::Singles(actions) => self.fly(py, actions),
            Actions::Doubles(actions) => self.fly(py, actions),
        }
    }

    /// Results of the last reset or step, by name: in arrays of their own, or in the arrays of the calls before.
    fn outputs<'py>(&mut self, py: Python<'py>, copy: bool) -> PyResult<Bound<'py, PyDict>> {
        let told = match self.kept.as_ref().filter(|_| !copy) {
            Some(kept) => kept.bind(py).clone(),
            None => PyDict::new(py),
        };
        self.put_all(&told)?;
        if !copy && self.kept.is_none() {
            self.kept = Some(told.clone().unbind());
        }
        Ok(told)
    }

    /// Seconds that all calls so far spent in work that is shared between the threads.
    fn shared_s(&self) -> f64 {
        self.flock.shared_s()
    }

    /// Names of all episodes.
    fn episodes(&self) -> Vec<&str> {
        self.flock.episodes().collect()
    }

    /// Steps of the whole episode that an environment flies.
    fn planned_steps(&self, number: usize) -> PyResult<u32> {
        if number < self.flock.len() {
            Ok(self.flock.planned_steps(number))
        } else {
            Err(InvalidValue::new_err(format!("there is no environment {number}")))
        }
    }

    /// Begins the episode of a name in one environment.
    fn begin_episode(&mut self, py: Python<'_>, number: usize, name: &str) -> PyResult<()> {
        let flock = &mut self.flock;
        if number < flock.len() && py.detach(|| flock.begin_episode(number, name)) {
            Ok(())
        } else {
            Err(InvalidValue::new_err(format!("there is no environment {number} or no episode `{name}`")))
        }
    }

    /// Name of the episode that an environment flies.
    fn episode(&self, number: usize) -> PyResult<&str> {
        if number < self.flock.len() {
            Ok(self.flock.episode(number))
        } else {
            Err(InvalidValue::new_err(format!("there is no environment {number}")))
        }
    }
}

/// The weather of a name.
fn preset(name: &str) -> PyResult<Weather> {
    cosfly_materials::presets::preset(name).ok_or_else(|| {
        let presets = cosfly_materials::presets::PRESETS.join(", ");
        InvalidValue::new_err(format!("weather is `{name}`; it is one of {presets}"))
    })
}

/// Actions of all environments, a row each.
#[derive(FromPyObject)]
enum Actions<'py> {
    Singles(PyReadonlyArray2<'py, f32>),
    Doubles(PyReadonlyArray2<'py, f64>),
}

impl PyFlock {
    fn fly<N: Element + ActionNumber>(&mut self, py: Python<'_>, actions: &PyReadonlyArray2<'_, N>) -> PyResult<()> {
        let given = actions.as_slice().map_err(|error| InvalidValue::new_err(error.to_string()))?;
        if let Some(wrong) = wrong_number(given, ACTIONS) {
            let message = format!("actions have {wrong}; the action space has 12 m/s and 60 degrees/s at most");
            return Err(InvalidValue::new_err(message));
        }
        let (rows, rest) = given.as_chunks::<ACTIONS>();
        if rows.len() != self.flock.len() || !rest.is_empty() {
            let message = format!("actions must have the shape ({}, {ACTIONS})", self.flock.len());
            return Err(InvalidValue::new_err(message));
        }
        let flock = &mut self.flock;
        py.detach(|| flock.step(rows));
        Ok(())
    }

    /// Puts all results into arrays of a dictionary: new ones where it lacks them.
    fn put_all(&self, told: &Bound<'_, PyDict>) -> PyResult<()> {
        let (outputs, count) = (self.flock.outputs(), self.flock.len());
        let is_same_step = self.flock.mode() == Autoreset::SameStep;
        let mut columns = Columns { told, all: vec![] };
        columns.put("features", outputs.features.as_flattened(), &[count, cosfly_env::FEATURES])?;
        if is_same_step {
            columns.put("last_features", outputs.last_features.as_flattened(), &[count, cosfly_env::FEATURES])?;
        }
        columns.put("rewards", &outputs.rewards[..], &[count])?;
        columns.put("terminated", &outputs.terminated[..], &[count])?;
        columns.put("truncated", &outputs.truncated[..], &[count])?;
        columns.put("tracked", &outputs.tracked[..], &[count])?;
        columns.put("look_alikes", &outputs.look_alikes[..], &[count])?;
        if let Some(format) = self.flock.format() {
            let size = [count, format.height as usize, format.width as usize, 3];
            columns.put_pictures("", &outputs.album, size)?;
            columns.put_pictures("last_", &outputs.last_album, size)?;
        }
        self.put_readings(&mut columns, "", &outputs.readings)?;
        if is_same_step {
            self.put_readings(&mut columns, "last_", &outputs.last_readings)?;
        }
        if let Some(width) = outputs.beside.first().map(Vec::len) {
            columns.put("beside", outputs.beside.concat(), &[count, width])?;
        }
        if self.flock.has_experts() {
            columns.put("expert_action", outputs.expert_actions.as_flattened(), &[count, ACTIONS])?;
        }
        columns.put("last_terms", outputs.terms.as_flattened(), &[count, TERMS])?;
        columns.copy(&self.flock)?;
        // Views of the terms are made with their array.
        if !told.contains("reward_visibility")? {
            for (at, name) in cosfly_env::Reward::NAMES.iter().enumerate() {
                let name = format!("reward_{name}");
                let column = (PySlice::full(told.py()), at);
                told.set_item(name, told.as_any().get_item("last_terms")?.get_item(column)?)?;
            }
        }
        Ok(())
    }

    /// Puts the readings of each sensor as an array of (environment, quantity).
    fn put_readings<'py: 'a, 'a>(
        &self,
        columns: &mut Columns<'_, 'py, 'a>,
        prefix: &str,
        rows: &[Vec<f32>],
    ) -> PyResult<()> {
        let mut first = 0;
        for sensor in self.flock.settings().sensors.iter() {
            let end = first + sensor.quantities.len();
            // Before the first reset there are no readings.
            let own = |row: &Vec<f32>| row.get(first..end).map_or_else(|| vec![0.0; end - first], <[f32]>::to_vec);
            let own: Vec<f32> = rows.iter().flat_map(own).collect();
            columns.put(&format!("{prefix}{}", sensor.name), own, &[rows.len(), end - first])?;
            first = end;
        }
        Ok(())
    }
}

/// A column of results, and the array that it goes into.
trait Column {
    fn add_to<'a>(&'a mut self, copies: &mut Copies<'a>) -> PyResult<()>;
}

impl<T: Element + Copy + Send + Sync> Column for (PyReadwriteArrayDyn<'_, T>, Cow<'_, [T]>) {
    fn add_to<'a>(&'a mut self, copies: &mut Copies<'a>) -> PyResult<()> {
        let to = self.0.as_slice_mut().map_err(|error| InvalidValue::new_err(error.to_string()))?;
        copies.add(to, &self.1);
        Ok(())
    }
}

/// All columns of a step, and the dictionary of their arrays.
struct Columns<'t, 'py, 'a> {
    told: &'t Bound<'py, PyDict>,
    all: Vec<Box<dyn Column + 'a>>,
}

impl<'py: 'a, 'a> Columns<'_, 'py, 'a> {
    /// Values for the array of a name, which is made where it is missing.
    fn put<T: Element + Copy + Send + Sync + 'a>(
        &mut self,
        name: &str,
        values: impl Into<Cow<'a, [T]>>,
        shape: &[usize],
    ) -> PyResult<()> {
        let array = match self.told.get_item(name)? {
            Some(array) => array.cast_into::<PyArrayDyn<T>>()?,
            None => {
                let array = PyArrayDyn::zeros(self.told.py(), shape, false);
                self.told.set_item(name, &array)?;
                array
            }
        };
        let array =
            array.try_readwrite().map_err(|_| InvalidValue::new_err(format!("the array `{name}` is read-only")))?;
        self.all.push(Box::new((array, values.into())));
        Ok(())
    }

    /// The channels of an album as arrays of (environment, row, column), and value where a pixel has three.
    fn put_pictures(&mut self, prefix: &str, album: &'a PictureBatch, size: [usize; 4]) -> PyResult<()> {
        for (channel, pixels) in album.channels() {
            let shape = if channel.element().parts() == 1 { &size[..3] } else { &size[..] };
            let name = format!("{prefix}{}", channel.name);
            match pixels {
                Pixels::Bytes(bytes) => self.put(&name, bytes, shape)?,
                Pixels::Floats(floats) => self.put(&name, floats, shape)?,
                Pixels::Ids(ids) => self.put(&name, ids, shape)?,
            }
        }
        Ok(())
    }

    /// Fills the arrays, all together.
    fn copy(mut self, flock: &VectorEnvironment) -> PyResult<()> {
        let mut copies = Copies::default();
        self.all.iter_mut().try_for_each(|column| column.add_to(&mut copies))?;
        self.told.py().detach(|| flock.copy(copies));
        Ok(())
    }
}

/// Episodes, and what their recipe says of the drone.
type Made = (Arc<[EpisodeTask]>, FlySettings);

fn made(recipe: &std::path::Path, overrides: &[String], store: &std::path::Path) -> Result<Made, Refusal> {
    let one = |refusal: Box<Diagnostic>| Refusal::Work(vec![refusal]);
    let recipe = cosfly::recipe_file::load(recipe, overrides).map_err(Refusal::Work)?;
    let settings = FlySettings::of(&recipe).map_err(one)?;
    let store = Store::open(store).map_err(one)?;
    let jobs = std::thread::available_parallelism().map_or(1, usize::from);
    let options = RunOptions { jobs, ..RunOptions::default() };
    let suite = Suite::make(&recipe, &store, &options, &|_| ()).map_err(one)?;
    Ok((suite.tasks.into(), settings))
}
