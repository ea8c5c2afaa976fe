//! Generated places: kinds of towns as OpenDRIVE 1.6 text, from a few numbers and a seed.
//!
//! [`grid`] draws a downtown on a loose grid. The other kinds stand in [`kinds::ALL`]: each draws a [`net::plan::StreetPlan`]
//! and puts things on the land of a [`site::Site`].

pub mod alignment;
pub mod geometry;
pub mod grid;
pub mod kinds;
pub mod lot;
pub mod net;
pub mod site;
pub mod things;
pub mod xml;
