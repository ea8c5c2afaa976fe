//! Labels that stages of plugins give to the frames of a flight: with the flight until it is published, apart from its costs.
//!
//! In a [`Trajectory`] they travel among the terms, with weight 0 and a name that no term can have: of terms, names are
//! `a-z`, `0-9` and `_`.

use cosfly_planner::{TermCost, Trajectory};

/// What stands before and between the parts of such a name.
const MARK: &str = "label/";
const BETWEEN: char = '/';

/// A label of every frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlightLabel<'a> {
    /// Its name.
    pub name: &'a str,
    /// The plugin that gave it, as it calls itself.
    pub plugin: &'a str,
    /// Its version.
    pub version: &'a str,
    /// One value per frame.
    pub per_frame: &'a [f64],
}

/// The flight's costs: its terms that are no labels.
pub fn costs(flight: &Trajectory) -> impl Iterator<Item = &TermCost> {
    flight.terms.iter().filter(|term| !term.name.starts_with(MARK))
}

/// The flight's labels, in the order in which they were given.
pub fn labels(flight: &Trajectory) -> impl Iterator<Item = FlightLabel<'_>> {
    flight.terms.iter().filter_map(|term| {
        let mut parts = term.name.strip_prefix(MARK)?.splitn(3, BETWEEN);
        let (name, plugin) = (parts.next()?, parts.next()?);
        Some(FlightLabel { name, plugin, version: parts.next()?, per_frame: &term.per_frame })
    })
}

/// Gives the flight a label.
///
/// # Errors
/// That it has one of that name.
pub fn add(flight: &mut Trajectory, label: FlightLabel<'_>) -> Result<(), String> {
    let FlightLabel { name, plugin, version, per_frame } = label;
    if let Some(earlier) = labels(flight).find(|earlier| earlier.name == name) {
        return Err(format!("it returned a label `{name}`, but plugin `{}` gave one of that name", earlier.plugin));
    }
    let name = format!("{MARK}{name}{BETWEEN}{plugin}{BETWEEN}{version}");
    let sum = per_frame.iter().sum();
    flight.terms.push(TermCost { name, weight: 0.0, sum, per_frame: per_frame.to_vec() });
    Ok(())
}
