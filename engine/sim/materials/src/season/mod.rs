//! Seasons in colours: leaves of trees, lawns, woods; one row for each season.

mod autumn;
mod row;
mod summer;
mod winter;

pub use row::{SeasonRow, of_town, row};
