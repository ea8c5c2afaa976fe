//! [`SensorSet`]: the sensors that an environment reads.

use crate::{ALL, Sensor};

/// Sensors in the order of [`ALL`], each once.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SensorSet(u64);

impl SensorSet {
    /// The sensors that `is_chosen` takes.
    pub fn of(is_chosen: impl Fn(&Sensor) -> bool) -> Self {
        let bits = ALL.iter().enumerate().filter(|(_, sensor)| is_chosen(sensor)).map(|(place, _)| 1 << place);
        Self(bits.sum())
    }

    /// The sensors.
    pub fn iter(self) -> impl Iterator<Item = &'static Sensor> {
        ALL.iter().enumerate().filter(move |(place, _)| self.0 >> place & 1 == 1).map(|(_, sensor)| *sensor)
    }
}
