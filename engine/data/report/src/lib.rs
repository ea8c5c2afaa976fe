//! The page of a dataset: numbers, maps, distributions and worst cases in one HTML file that opens offline.
//!
//! * [`model`]: content of the page; [`figures`]: figures over flights and the flights that are drawn, mergeable.
//! * [`page`](fn@page): writes it. No script, nothing is loaded, pictures are inside; the same data give the same bytes.
//!
//! To add a section: one file in `sections/` and its line in the list of sections in `page.rs`.

mod document;
pub mod figures;
mod map;
pub mod model;
mod moments;
mod name_hash;
mod page;
mod pictures;
mod sample;
mod sections;
mod sketch;

pub use document::{Section, document};
pub use figures::Figures;
pub use model::{BoxSketch, KnownNumber, PlannerRow, RejectionSketch, Report, TownSketch};
pub use page::page;
pub use sketch::{FlightSketch, TextSketch};
