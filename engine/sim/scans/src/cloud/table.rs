//! Points as rows of named numbers, as PLY and PCD files have them.

use super::{Cloud, CloudBuilder, class};
use cosfly_frames::DVec3;
use cosfly_town::MapError;

/// Names of a column of classes of the ASPRS standard, lower case.
const CLASSES: [&str; 4] = ["classification", "class", "scalar_classification", "scalar_class"];
/// Name of CARLA's column of labels, lower case. Its sensors are left-handed: y points right.
const CARLA_LABELS: &str = "objtag";

/// Columns of a table that a cloud needs.
#[derive(Clone, Copy, Debug)]
pub struct Columns {
    /// Numbers of the columns x, y and z.
    pub position: [usize; 3],
    class: Option<usize>,
    carla_label: Option<usize>,
}

impl Columns {
    /// Finds the columns by their names.
    ///
    /// # Errors
    /// A coordinate that is missing.
    pub fn find<'n>(names: impl Iterator<Item = &'n str> + Clone) -> Result<Self, MapError> {
        let column =
            |wanted: &[&str]| names.clone().position(|name| wanted.iter().any(|one| name.eq_ignore_ascii_case(one)));
        let check = |name: &str| {
            if names.clone().filter(|own| own.eq_ignore_ascii_case(name)).count() > 1 {
                let error = MapError::new(format!("the points have several numbers called `{name}`"));
                return Err(error.hint("export the cloud with one number of each name"));
            }
            Ok(())
        };
        CLASSES.iter().chain([&CARLA_LABELS]).try_for_each(|name| check(name))?;
        let coordinate = |name: &str| {
            check(name)?;
            column(&[name]).ok_or_else(|| MapError::new(format!("the points have no number called `{name}`")))
        };
        Ok(Self {
            position: [coordinate("x")?, coordinate("y")?, coordinate("z")?],
            class: column(&CLASSES),
            carla_label: column(&[CARLA_LABELS]),
        })
    }

    /// The largest column that is needed.
    pub fn last(&self) -> usize {
        self.position.into_iter().chain(self.class).chain(self.carla_label).max().unwrap_or(0)
    }

    /// Adds a point; `value` gives the number of a column.
    pub fn push(&self, cloud: &mut CloudBuilder, unit_m: f64, value: impl Fn(usize) -> f64) {
        let mut point = unit_m * DVec3::from_array(self.position.map(&value));
        let class = match (self.carla_label, self.class) {
            (Some(column), _) => {
                point.y = -point.y;
                class_of_carla(value(column))
            }
            // Other numbers are none of the standard's.
            (None, Some(column)) => Some(value(column))
                .filter(|class| (1.0..=255.0).contains(class))
                .map_or(class::UNCLASSIFIED, |class| class as u8),
            (None, None) => class::UNCLASSIFIED,
        };
        cloud.push(point, class);
    }

    /// The finished cloud, with a word on the unit and the frame that were assumed.
    ///
    /// # Errors
    /// Those of [`CloudBuilder::finish`].
    pub fn finish(&self, cloud: CloudBuilder, asked_m: Option<f64>) -> Result<Cloud, MapError> {
        let mut warnings = Vec::new();
        if asked_m.is_none() {
            warnings.push(
                "the file does not state the unit of its coordinates: metres are assumed (`options.unit_m` tells another)"
                    .to_owned(),
            );
        }
        if self.carla_label.is_some() {
            warnings.push("the points have CARLA's labels: they are taken in CARLA's left-handed frame".to_owned());
        }
        cloud.finish(None, warnings)
    }
}

/// Warning of a line of a file about the place of its coordinates.
pub fn not_applied(line: &str) -> String {
    let shown: String = line.trim().chars().take(80).collect();
    format!("`{shown}` is not applied: the coordinates are taken as they stand (`more` has `shift_m`)")
}

/// Class of a label of CARLA 0.9.14 and later.
fn class_of_carla(label: f64) -> u8 {
    match label as i64 {
        1 | 24 => class::ROAD,
        2 | 10 | 25 | 27 => class::GROUND,
        3 => class::BUILDING,
        9 => class::HIGH_PLANTS,
        23 => class::WATER,
        26 => class::BRIDGE,
        // Sky, and what moves: people and vehicles are no part of the town.
        11..=19 | 21 => class::HIGH_NOISE,
        _ => class::UNCLASSIFIED,
    }
}
