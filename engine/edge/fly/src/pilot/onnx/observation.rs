//! [`Observation`]: what an input of a network is fed with.

use cosfly_diagnose::{counted, nearest_name};
use cosfly_domain::Channel;
use cosfly_domain::channels::{self, Element};
use cosfly_env::FEATURES;
use cosfly_onnx::{Kind, Port};
use cosfly_sensors::Sensor;

/// Unit of the state and of sensors: each number in its own of these.
const UNITS: &[&str] = &["m, s, degrees"];
/// Sizes of pictures, pixels.
const SIZES_PX: std::ops::RangeInclusive<usize> = 16..=512;

/// Source of an input of a network.
#[derive(Clone, Copy, Debug)]
pub enum Observation {
    /// The state.
    State,
    /// Readings of a sensor.
    Sensor(&'static Sensor),
    /// A picture.
    Channel(&'static Channel),
}

/// Units in which a network may ask for a channel; the first is the channel's own.
pub fn units_of(channel: &Channel) -> &'static [&'static str] {
    match channel.element() {
        Element::Colour => &["0..255", "0..1"],
        Element::Bytes => &["0..255"],
        Element::Float if *channel == channels::depth::CHANNEL => &["m"],
        Element::Float | Element::Pair => &["number"],
        Element::Label | Element::Id => &["id"],
        Element::Flag => &["0, 1"],
    }
}

/// Order of the numbers of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// Row by row, each pixel whole.
    PixelsWhole,
    /// One part of all pixels after the other.
    PartsApart,
}

impl Observation {
    /// The observation of a name.
    ///
    /// # Errors
    /// The nearest name and all that are allowed, in words.
    pub fn called(name: &str) -> Result<Self, String> {
        if name == "state" {
            return Ok(Self::State);
        }
        let sensor = || cosfly_sensors::called(name).map(Self::Sensor);
        let channel = channels::of_moments().find(|it| it.name == name);
        channel.map(Self::Channel).or_else(sensor).ok_or_else(|| {
            let channels = channels::of_moments().map(|it| it.name);
            let all: Vec<&str> =
                ["state"].into_iter().chain(channels).chain(cosfly_sensors::ALL.iter().map(|it| it.name)).collect();
            let near = nearest_name(name, all.iter().copied())
                .map_or(".".to_owned(), |near| format!("; did you mean `{near}`?"));
            format!("there is no observation `{name}`{near} Allowed are {}", all.join(", "))
        })
    }

    /// Name.
    pub fn name(self) -> &'static str {
        match self {
            Self::State => "state",
            Self::Sensor(sensor) => sensor.name,
            Self::Channel(channel) => channel.name,
        }
    }

    /// Units in which it may be asked for; the first is its own.
    pub fn units(self) -> &'static [&'static str] {
        let Self::Channel(channel) = self else { return UNITS };
        units_of(channel)
    }

    /// Size of pictures (rows, columns; none for other observations) and the order of their numbers, for an input that is fed with the
    /// last `history` observations.
    ///
    /// # Errors
    /// The shapes that are allowed, in words.
    pub fn fit(self, port: &Port, history: usize) -> Result<(Option<[usize; 2]>, Order), String> {
        let (shape, count) = (&port.shape, port.shape.iter().product::<usize>());
        let plain = |numbers: usize, order: Order| match count == numbers * history {
            true => Ok((None, order)),
            false => Err(format!(
                "its shape is {shape:?}; `{}` has {numbers}, {history} times",
                self.name(),
                numbers = counted(numbers, "number")
            )),
        };
        let channel = match self {
            Self::State => return plain(FEATURES, Order::PixelsWhole),
            Self::Sensor(sensor) => return plain(sensor.quantities.len(), Order::PixelsWhole),
            Self::Channel(channel) => channel,
        };
        let parts = channel.element().parts();
        let (size, order) = match *shape.as_slice() {
            [.., rows, columns, last] if last == parts && columns > parts => ([rows, columns], Order::PixelsWhole),
            [.., rows, columns] => ([rows, columns], Order::PartsApart),
            _ => ([0; 2], Order::PartsApart),
        };
        let fits = size.iter().all(|size| SIZES_PX.contains(size)) && count == size[0] * size[1] * parts * history;
        let (least, most) = (SIZES_PX.start(), SIZES_PX.end());
        match fits {
            true => Ok((Some(size), order)),
            false => Err(format!(
                "its shape is {shape:?}; a picture `{}` is ({parts}, rows, columns) or (rows, columns, {parts}), {history} times, \
                 with {least} to {most} rows and columns",
                self.name()
            )),
        }
    }

    /// Whether an input of a kind can hold it in a unit.
    ///
    /// # Errors
    /// Allowed names, in words.
    pub fn check(self, unit: &str, kind: Kind) -> Result<(), String> {
        let units = self.units();
        if !units.contains(&unit) {
            let allowed: Vec<String> = units.iter().map(|unit| format!("\"{unit}\"")).collect();
            return Err(format!(
                "`{}` is not given in the unit \"{unit}\"; allowed is {}",
                self.name(),
                allowed.join(" or ")
            ));
        }
        let is_whole = matches!(unit, "0..255" | "id" | "0, 1");
        match kind == Kind::Float || is_whole {
            true => Ok(()),
            false => Err(format!("`{}` in the unit \"{unit}\" needs an input of floats", self.name())),
        }
    }
}
