//! The page of a dataset: numbers, maps, distributions and worst cases in one HTML file that opens offline.
//!
//! * [`model`]: content of the page.
//! * [`page`](fn@page): writes it. No script, nothing is loaded, pictures are inside; the same data give the same bytes.
//!
//! To add a section: one file in `sections/` and its line in the list of sections in `page.rs`.

mod map;
pub mod model;
mod moments;
mod page;
mod pictures;
mod sections;

pub use model::{BoxSketch, FlightSketch, Known, PlannerRow, RejectionSketch, Report, TownSketch};
pub use page::page;
