//! Readings of all sensors of a flight, in the order of their times.

use super::channels::ChannelWriter;
use cosfly_diagnose::Result;
use cosfly_schema::extras::{Extra, ExtraShape};
use cosfly_schema::flight_table::Values;
use cosfly_schema::log::reading::{LoggedSensor, ReadingMessage};
use cosfly_schema::log::{Topic, cloud};
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
            if times_s.is_empty() {
                continue; // read along the film of another camera
            }
            let time_ns = |time_s: &f64| (time_s * 1e9).round_ties_even() as u64;
            order.extend(times_s.iter().map(time_ns).enumerate().map(|(row, time_ns)| (time_ns, sensors.len(), row)));
            let columns = extra.source.columns.iter().skip(OWN).map(|column| column.name.clone());
            let sensor = LoggedSensor { name: extra.source.name.clone(), quantities: columns.collect() };
            sensors.push((sensor, quantities));
        }
        order.sort_unstable();
        Self { sensors, order, next: 0 }
    }

    /// The topics of the sensors.
    pub fn topics(&self) -> impl Iterator<Item = Topic> {
        self.sensors.iter().map(|(sensor, quantities)| match sweeps_of(sensor, quantities) {
            Some(_) => cloud::topic(&sensor.name),
            None => sensor.topic(),
        })
    }

    /// Writes the readings up to a time that are not written yet.
    pub fn write<W: Write>(&mut self, log: &mut ChannelWriter<W>, until_ns: u64) -> Result<()> {
        while let Some((time_ns, sensor, row)) = self.order.get(self.next).filter(|it| it.0 <= until_ns) {
            let (sensor, quantities) = &self.sensors[*sensor];
            if let Some((clouds, pose)) = sweeps_of(sensor, quantities) {
                let message = cloud::message(*time_ns, &pose.map(|numbers| numbers[*row]), &clouds[*row]);
                log.write(&sensor.topic_name(), *time_ns, &message)?;
                self.next += 1;
                continue;
            }
            let number = |values: &Values| if let Values::Reals(values) = values { values[*row] } else { 0.0 };
            let message = ReadingMessage(quantities.iter().map(number).collect());
            log.write(&sensor.topic_name(), *time_ns, &message)?;
            self.next += 1;
        }
        Ok(())
    }
}

/// Clouds, and the numbers of the poses, of the sweeps of a lidar.
type Sweeps<'a> = (&'a [Vec<u8>], [&'a [f64]; 7]);

/// The sweeps of a lidar; `None` of other sensors.
fn sweeps_of<'a>(sensor: &LoggedSensor, quantities: &'a [Values]) -> Option<Sweeps<'a>> {
    let of = |name: &str| sensor.quantities.iter().position(|it| it == name).map(|place| &quantities[place]);
    let Values::Bytes(clouds) = of(cloud::COLUMN)? else { return None };
    let mut pose: [&[f64]; 7] = [&[]; 7];
    for (place, name) in pose.iter_mut().zip(cloud::POSE) {
        let Values::Reals(numbers) = of(name)? else { return None };
        *place = numbers;
    }
    Some((clouds, pose))
}
