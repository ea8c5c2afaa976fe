//! From points to a town: ground, classes where the file has none, buildings, trees and other things as boxes.
//!
//! [`sorting`] puts the points in the order of cells, [`survey`] knows them by cell. [`ground`] finds the ground, [`classify`] tells roofs from plants.
//! [`buildings`] are columns of cells down to the ground below the [`slopes`] of their roofs, [`trees`] stacks of boxes, [`things`] the rest.

pub mod buildings;
pub mod classify;
pub mod ground;
mod houses;
mod numbers;
pub mod options;
pub mod outline;
pub mod planes;
pub mod points;
pub mod slopes;
pub mod sorting;
pub mod survey;
pub mod table;
pub mod things;
pub mod town;
pub mod trees;

pub use options::CloudOptions;
pub use points::{Cloud, CloudBuilder, class};
pub use town::town_of;
