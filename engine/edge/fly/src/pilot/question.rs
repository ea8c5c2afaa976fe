//! [`Question`]: the message that asks for an action, with the pictures and readings that are asked for.

use super::manners::Manners;
use crate::wire::{self, Field};
use cosfly_env::pictures::{PictureBatch, Pictures, Pixels};
use cosfly_env::{Environment, FEATURES, readings};
use cosfly_sensors::SensorSet;

/// Asks for actions. Owns what draws the pictures.
pub struct Question {
    prompt: String,
    sensors: SensorSet,
    pictures: Option<(Pictures, PictureBatch)>,
}

impl Question {
    /// Questions in a manner.
    pub fn new(manners: &Manners) -> Self {
        let pictures = manners.pictures.clone().map(|format| {
            let album = PictureBatch::new(&format, 1);
            (Pictures::new(format, 1), album)
        });
        Self { prompt: manners.prompt.clone(), sensors: manners.sensors, pictures }
    }

    /// The message that asks for an action in the present state.
    pub fn bytes(&mut self, environment: &Environment) -> Vec<u8> {
        let observation = environment.observation();
        let state = observation.features().map(|feature| feature as f32);
        let readings: Vec<(&str, Vec<f32>, [usize; 1])> = readings(environment)
            .into_iter()
            .filter(|(sensor, _)| self.sensors.iter().any(|asked| asked.name == sensor.name))
            .map(|(sensor, values)| {
                (sensor.name, values.iter().map(|value| *value as f32).collect(), [sensor.quantities.len()])
            })
            .collect();
        let mut fields = vec![
            ("episode", Field::Text(&environment.episode().name)),
            ("step", Field::Count(u64::from(observation.step))),
            ("time_s", Field::Number(observation.time_s)),
            ("prompt", Field::Text(&self.prompt)),
            ("state", Field::Floats(&state, &[FEATURES])),
        ];
        fields.extend(readings.iter().map(|(name, values, shape)| (*name, Field::Floats(values, shape))));
        let Some((pictures, album)) = &mut self.pictures else { return wire::encode(&fields) };
        pictures.draw(&[environment], album, 0);
        let format = pictures.format();
        let [rows, columns] = [format.height as usize, format.width as usize];
        let shape = [rows, columns, 3];
        fields.extend(album.channels().map(|(channel, pixels)| {
            let shape = if channel.element().parts() == 1 { &shape[..2] } else { &shape[..] };
            let field = match pixels {
                Pixels::Bytes(bytes) => Field::Bytes(bytes, shape),
                Pixels::Floats(floats) => Field::Floats(floats, shape),
                Pixels::Ids(ids) => Field::Ids(ids, shape),
            };
            (channel.name, field)
        }));
        wire::encode(&fields)
    }
}
