//! The lists of channels and of sensors for Python.

use cosfly_domain::Channel;
use cosfly_domain::channels::{ChannelSource, Element};
use cosfly_fly::pilot::units_of;
use cosfly_sensors::Sensor;
use pyo3::prelude::*;

/// A channel for Python: name, type of numpy, values of a pixel, least and greatest value, unit, documentation. The greatest value
/// is absent where it is the environment's greatest depth.
type ChannelFacts = (&'static str, &'static str, usize, f64, Option<f64>, &'static str, &'static str);

/// All channels of pictures that environments have.
#[pyfunction]
pub fn channels() -> Vec<ChannelFacts> {
    let facts = |channel: &'static Channel| {
        let element = channel.element();
        let (kind, least, greatest) = match element {
            Element::Colour | Element::Label | Element::Bytes => ("uint8", 0.0, Some(255.0)),
            Element::Flag => ("uint8", 0.0, Some(1.0)),
            Element::Id => ("uint32", 0.0, Some(f64::from(u32::MAX))),
            Element::Float if matches!(channel.source, ChannelSource::Depth) => ("float32", 0.0, None),
            Element::Float | Element::Pair => ("float32", f64::NEG_INFINITY, Some(f64::INFINITY)),
        };
        (channel.name, kind, element.parts(), least, greatest, units_of(channel)[0], channel.doc)
    };
    cosfly_domain::channels::of_moments().map(facts).collect()
}

/// A sensor for Python: name, documentation, names and documentation of its quantities.
type SensorFacts = (&'static str, &'static str, Vec<(&'static str, &'static str)>);

/// All sensors that are no cameras.
#[pyfunction]
pub fn sensors() -> Vec<SensorFacts> {
    let facts = |sensor: &&'static Sensor| {
        let quantities = sensor.quantities.iter().map(|quantity| (quantity.name, quantity.doc));
        (sensor.name, sensor.doc, quantities.collect())
    };
    cosfly_sensors::ALL.iter().map(facts).collect()
}

/// Names of all weathers.
#[pyfunction]
pub fn weathers() -> Vec<&'static str> {
    cosfly_materials::presets::PRESETS.to_vec()
}
