//! Labels that plugins give to the frames of a flight. They travel with the flight until it is published, apart from
//! its costs.
//!
//! In a [`Trajectory`] they are stored among the terms, with weight 0 and a name that no term can have: names of terms
//! are `a-z`, `0-9` and `_`.

use cosfly_domain::{TermCost, Trajectory};

/// Prefix and separator of such a name.
const MARK: &str = "label/";
const BETWEEN: char = '/';

/// A label: one value per frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlightLabel<'a> {
    /// Name of the label.
    pub name: &'a str,
    /// Name of the plugin that gave it.
    pub plugin: &'a str,
    /// Version of the plugin.
    pub version: &'a str,
    /// Values, one per frame.
    pub per_frame: &'a [f64],
}

/// Costs of a flight: its terms that are not labels.
pub fn costs(flight: &Trajectory) -> impl Iterator<Item = &TermCost> {
    flight.terms.iter().filter(|term| !term.name.starts_with(MARK))
}

/// Labels of a flight, in the order in which they were given.
pub fn labels(flight: &Trajectory) -> impl Iterator<Item = FlightLabel<'_>> {
    flight.terms.iter().filter_map(|term| {
        let mut parts = term.name.strip_prefix(MARK)?.splitn(3, BETWEEN);
        let (name, plugin) = (parts.next()?, parts.next()?);
        Some(FlightLabel { name, plugin, version: parts.next()?, per_frame: &term.per_frame })
    })
}

/// Adds a label to a flight.
///
/// # Errors
/// The flight has a label of that name already.
pub fn add(flight: &mut Trajectory, label: FlightLabel<'_>) -> Result<(), String> {
    let FlightLabel { name, plugin, version, per_frame } = label;
    if let Some(earlier) = labels(flight).find(|earlier| earlier.name == name) {
        return Err(format!(
            "it returned a label `{name}`, but plugin `{}` already gave one of that name",
            earlier.plugin
        ));
    }
    let name = format!("{MARK}{name}{BETWEEN}{plugin}{BETWEEN}{version}");
    let sum = per_frame.iter().sum();
    flight.terms.push(TermCost { name, weight: 0.0, sum, per_frame: per_frame.to_vec() });
    Ok(())
}
