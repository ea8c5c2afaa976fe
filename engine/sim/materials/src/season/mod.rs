//! Seasons in colours: leaves of trees, lawns, woods; one row for each season.

mod autumn;
mod list;
mod row;
mod summer;
mod winter;

pub use list::{of_town, row};
pub use row::SeasonRow;
