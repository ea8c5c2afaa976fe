//! Environments of `cosfly.gym`: a suite, and many environments over its episodes, stepped with the GIL released.

use crate::calls::on_own_threads;
use crate::errors::{InvalidValue, exception};
use cosfly::Refusal;
use cosfly_diagnose::Diagnostic;
use cosfly_domain::{ChannelSet, Weather, channels};
use cosfly_env::pictures::{PictureBatch, PictureFormat, Pixels};
use cosfly_fly::pilot::wrong_number;
use cosfly_fly::settings::FlySettings;
use cosfly_fly::suite::{Suite, Task};
use cosfly_fly::vector::{ACTIONS, Autoreset, VectorEnvironment};
use cosfly_render::PictureLook;
use cosfly_runner::RunOptions;
use cosfly_sensors::SensorSet;
use cosfly_store::Store;
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
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
        if let Some(unknown) = config.channels.iter().find(|name| channels::called(name).is_none()) {
            return Err(InvalidValue::new_err(format!("there is no channel `{unknown}`")));
        }
        let channels = ChannelSet::of(|channel| config.channels.iter().any(|name| name == channel.name));
        if channels.is_empty() {
            return Ok(Self { flock });
        }
        let weather = config.weather.as_deref().map(preset).transpose()?;
        let look = PictureLook::named(&config.look).ok_or_else(|| {
            let known = PictureLook::ALL.map(|(name, _)| name).join(", ");
            InvalidValue::new_err(format!("look is `{}`; it is one of {known}", config.look))
        })?;
        let (width, height) = config.sides;
        let farthest_m = config.max_depth_m;
        let format = PictureFormat { width, height, channels, farthest_m, weather, look };
        let flock = flock
            .with_pictures(format, config.threads.min(count))
            .map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
        Ok(Self { flock })
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
    fn step(&mut self, py: Python<'_>, actions: PyReadonlyArray2<'_, f64>) -> PyResult<()> {
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
        let rows: Vec<[f32; ACTIONS]> = rows.iter().map(|row| row.map(|number| number as f32)).collect();
        let flock = &mut self.flock;
        py.detach(|| flock.step(&rows));
        Ok(())
    }

    /// Copies of what the last reset or step gave, by name.
    fn outputs<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (outputs, told) = (self.flock.outputs(), PyDict::new(py));
        let rows = |rows: &[[f32; cosfly_env::FEATURES]]| {
            let rows: Vec<Vec<f32>> = rows.iter().map(|row| row.to_vec()).collect();
            PyArray2::from_vec2(py, &rows)
        };
        told.set_item("features", rows(&outputs.features)?)?;
        told.set_item("last_features", rows(&outputs.last_features)?)?;
        told.set_item("rewards", PyArray1::from_slice(py, &outputs.rewards))?;
        told.set_item("terminated", PyArray1::from_slice(py, &outputs.terminated))?;
        told.set_item("truncated", PyArray1::from_slice(py, &outputs.truncated))?;
        told.set_item("tracked", PyArray1::from_slice(py, &outputs.tracked))?;
        told.set_item("look_alikes", PyArray1::from_slice(py, &outputs.look_alikes))?;
        if let Some(format) = self.flock.format() {
            let size = [self.flock.len(), format.height as usize, format.width as usize];
            put_pictures(&told, "", &outputs.album, size)?;
            put_pictures(&told, "last_", &outputs.last_album, size)?;
        }
        for (prefix, rows) in [("", &outputs.readings), ("last_", &outputs.last_readings)] {
            put_readings(&told, prefix, self.flock.settings().sensors, rows)?;
        }
        if !outputs.beside.is_empty() {
            told.set_item("beside", PyArray2::from_vec2(py, &outputs.beside)?)?;
        }
        for (at, name) in cosfly_env::Reward::NAMES.iter().enumerate() {
            let term: Vec<f64> = outputs.terms.iter().map(|terms| terms[at]).collect();
            told.set_item(format!("reward_{name}"), PyArray1::from_vec(py, term))?;
        }
        if !outputs.expert_actions.is_empty() {
            let rows: Vec<Vec<f32>> = outputs.expert_actions.iter().map(|row| row.to_vec()).collect();
            told.set_item("expert_action", PyArray2::from_vec2(py, &rows)?)?;
        }
        Ok(told)
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

/// Adds each channel of an album as an array of (environment, row, column), and value where a pixel has three.
fn put_pictures(
    told: &Bound<'_, PyDict>,
    prefix: &str,
    album: &PictureBatch,
    [count, height, width]: [usize; 3],
) -> PyResult<()> {
    let (py, shape) = (told.py(), [count, height, width, 3]);
    for (channel, pixels) in album.channels() {
        let shape = if channel.element().parts() == 1 { &shape[..3] } else { &shape[..] };
        let array = match pixels {
            Pixels::Bytes(bytes) => PyArray1::from_slice(py, bytes).reshape(shape)?.into_any(),
            Pixels::Floats(floats) => PyArray1::from_slice(py, floats).reshape(shape)?.into_any(),
            Pixels::Ids(ids) => PyArray1::from_slice(py, ids).reshape(shape)?.into_any(),
        };
        told.set_item(format!("{prefix}{}", channel.name), array)?;
    }
    Ok(())
}

/// Adds the readings of each sensor as an array of (environment, quantity).
fn put_readings(told: &Bound<'_, PyDict>, prefix: &str, sensors: SensorSet, rows: &[Vec<f32>]) -> PyResult<()> {
    let mut first = 0;
    for sensor in sensors.iter() {
        let end = first + sensor.quantities.len();
        // Before the first reset there are no readings.
        let own = rows.iter().map(|row| row.get(first..end).map_or_else(|| vec![0.0; end - first], <[f32]>::to_vec));
        let own: Vec<Vec<f32>> = own.collect();
        told.set_item(format!("{prefix}{}", sensor.name), PyArray2::from_vec2(told.py(), &own)?)?;
        first = end;
    }
    Ok(())
}

/// Episodes, and what their recipe says of the drone.
type Made = (Arc<[Task]>, FlySettings);

fn made(recipe: &std::path::Path, overrides: &[String], store: &std::path::Path) -> Result<Made, Refusal> {
    let one = |refusal: Box<Diagnostic>| Refusal::Work(vec![refusal]);
    let recipe = if recipe.is_dir() { recipe.join("recipe.toml") } else { recipe.to_owned() };
    let recipe = cosfly_recipe::load(&recipe, overrides, &cosfly_stages::registry()).map_err(Refusal::Work)?;
    let settings = FlySettings::of(&recipe).map_err(one)?;
    let store = Store::open(store).map_err(one)?;
    let jobs = std::thread::available_parallelism().map_or(1, usize::from);
    let options = RunOptions { jobs, ..RunOptions::default() };
    let suite = Suite::make(&recipe, &store, &options, &|_| ()).map_err(one)?;
    Ok((suite.tasks.into(), settings))
}
