//! Generated places: kinds of towns as OpenDRIVE 1.6 text, from a few numbers and a seed.
//!
//! [`grid`] draws a downtown on a loose grid. The other kinds stand in [`kinds::ALL`]: each draws a plan of streets (`net`) and
//! puts things on the land beside them (`site`).

mod alignment;
mod geometry;
pub mod grid;
pub mod kinds;
mod lot;
mod net;
mod prune;
mod relief;
mod site;
pub mod streets;
mod things;
mod xml;
