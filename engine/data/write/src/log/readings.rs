//! Readings of all sensors of a flight, in the order of their times.

use super::channels::ChannelWriter;
use cosfly_diagnose::Result;
use cosfly_schema::extras::{Extra, ExtraShape};
use cosfly_schema::flight_table::Values;
use cosfly_schema::log::reading::{LoggedSensor, ReadingMessage};
use std::io::Write;

/// Columns of a table of readings before its quantities: frame and time.
const OWN: usize = 2;

/// Readings that are not written yet.
pub struct Readings<'a> {
    /// The sensors, and the values of each: by quantity.
    sensors: Vec<(LoggedSensor, &'a [Values])>,
    /// Time, number of the sensor and row of each reading, by time.
    order: Vec<(u64, usize, usize)>,
    next: usize,
}

impl<'a> Readings<'a> {
    /// The readings among the extras of a flight.
    pub fn of(extras: &'a [Extra]) -> Self {
        let (mut sensors, mut order) = (vec![], vec![]);
        for extra in extras.iter().filter(|extra| extra.source.shape == ExtraShape::Readings) {
            let [_, Values::Reals(times_s), quantities @ ..] = &extra.values[..] else { continue };
            let time_ns = |time_s: &f64| (time_s * 1e9).round_ties_even() as u64;
            order.extend(times_s.iter().map(time_ns).enumerate().map(|(row, time_ns)| (time_ns, sensors.len(), row)));
            let columns = extra.source.columns.iter().skip(OWN).map(|column| column.name.clone());
            let sensor = LoggedSensor { name: extra.source.name.clone(), quantities: columns.collect() };
            sensors.push((sensor, quantities));
        }
        order.sort_unstable();
        Self { sensors, order, next: 0 }
    }

    /// The sensors.
    pub fn sensors(&self) -> impl Iterator<Item = &LoggedSensor> {
        self.sensors.iter().map(|(sensor, _)| sensor)
    }

    /// Writes the readings up to a time that are not written yet.
    pub fn write<W: Write>(&mut self, log: &mut ChannelWriter<W>, until_ns: u64) -> Result<()> {
        while let Some((time_ns, sensor, row)) = self.order.get(self.next).filter(|it| it.0 <= until_ns) {
            let (sensor, quantities) = &self.sensors[*sensor];
            let number = |values: &Values| if let Values::Reals(values) = values { values[*row] } else { 0.0 };
            let message = ReadingMessage(quantities.iter().map(number).collect());
            log.write(&sensor.topic_name(), *time_ns, &message)?;
            self.next += 1;
        }
        Ok(())
    }
}
