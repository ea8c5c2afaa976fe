//! [`ObservationKeeper`]: pictures and readings beside labels, a file of numpy for each channel and sensor.

use super::npy;
use cosfly_domain::Channel;
use cosfly_domain::channels::Element;
use cosfly_env::pictures::{PictureBatch, PictureFormat, Pictures, Pixels};
use cosfly_env::{Environment, readings};
use cosfly_sensors::{Sensor, SensorSet};

/// Kinds of observations that are kept with every label.
#[derive(Clone, Debug, Default)]
pub struct KeptObservations {
    /// Pictures.
    pub pictures: Option<PictureFormat>,
    /// Sensors, which the environment must read.
    pub sensors: SensorSet,
}

/// Draws, reads and keeps the observations of an episode, one of each kind a step.
pub struct ObservationKeeper {
    pictures: Option<(Pictures, PictureBatch)>,
    sensors: SensorSet,
    /// Name, shape and bytes of all steps so far: channels, then sensors.
    kept: Vec<(&'static str, KeptShape, Vec<u8>)>,
}

impl ObservationKeeper {
    /// A keeper of some kinds of observations.
    pub fn new(wanted: &KeptObservations) -> Self {
        let pictures = wanted.pictures.as_ref();
        let channels = pictures.into_iter().flat_map(|format| {
            let size = [format.width as usize, format.height as usize];
            format.channels.iter().map(move |channel| (channel.name, KeptShape::of(channel, size), Vec::new()))
        });
        let readings = wanted.sensors.iter().map(|sensor| (sensor.name, KeptShape::of_readings(sensor), Vec::new()));
        Self {
            kept: channels.chain(readings).collect(),
            pictures: pictures.map(|format| (Pictures::new(format.clone(), 1), PictureBatch::new(format, 1))),
            sensors: wanted.sensors,
        }
    }

    /// Forgets the observations of an episode before.
    pub fn begin(&mut self) {
        self.kept.iter_mut().for_each(|(_, _, bytes)| bytes.clear());
    }

    /// Keeps the observations of the present state.
    pub fn keep(&mut self, environment: &Environment) {
        let mut kept = self.kept.iter_mut().map(|(_, _, bytes)| bytes);
        if let Some((pictures, batch)) = &mut self.pictures {
            pictures.draw(&[environment], batch, 0);
            for ((_, pixels), bytes) in batch.channels().zip(&mut kept) {
                match pixels {
                    Pixels::Bytes(all) => bytes.extend_from_slice(all),
                    Pixels::Floats(all) => bytes.extend(all.iter().flat_map(|number| number.to_le_bytes())),
                    Pixels::Ids(all) => bytes.extend(all.iter().flat_map(|id| id.to_le_bytes())),
                }
            }
        }
        let is_kept = |sensor: &Sensor| self.sensors.iter().any(|kept| kept.name == sensor.name);
        for ((_, values), bytes) in readings(environment).iter().filter(|(sensor, _)| is_kept(sensor)).zip(kept) {
            bytes.extend(values.iter().flat_map(|value| (*value as f32).to_le_bytes()));
        }
    }

    /// Files of the episode: the name of the channel or sensor, and the file.
    pub fn files(&self) -> impl Iterator<Item = (&'static str, Vec<u8>)> {
        self.kept.iter().map(|(name, shape, bytes)| {
            let steps = bytes.len() / shape.bytes();
            (*name, [&shape.head(steps)[..], bytes].concat())
        })
    }
}

/// Element and shape of what is kept of a step.
pub struct KeptShape {
    dtype: &'static str,
    bytes_per_number: usize,
    sides: Vec<usize>,
}

impl KeptShape {
    /// Pictures of a channel, of a size of columns and rows.
    pub fn of(channel: &Channel, [width, height]: [usize; 2]) -> Self {
        let element = channel.element();
        let (dtype, bytes_per_number) = match element {
            Element::Float | Element::Pair => ("<f4", 4),
            Element::Id => ("<u4", 4),
            Element::Colour | Element::Bytes | Element::Label | Element::Flag => ("|u1", 1),
        };
        let parts = Some(element.parts()).filter(|parts| *parts > 1);
        Self { dtype, bytes_per_number, sides: [height, width].into_iter().chain(parts).collect() }
    }

    /// Readings of a sensor.
    pub fn of_readings(sensor: &Sensor) -> Self {
        Self { dtype: "<f4", bytes_per_number: 4, sides: vec![sensor.quantities.len()] }
    }

    /// Bytes of one step.
    pub fn bytes(&self) -> usize {
        self.bytes_per_number * self.sides.iter().product::<usize>()
    }

    /// Beginning of a file of `steps` steps.
    pub fn head(&self, steps: usize) -> Vec<u8> {
        let sides: Vec<String> = [steps].iter().chain(&self.sides).map(usize::to_string).collect();
        npy::head(self.dtype, &format!("({})", sides.join(", ")))
    }
}
