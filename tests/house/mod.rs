//! Laws of the house, read from the source: circles of files, lengths, purity of `sim`, edges between crates.

mod circles;
pub mod edges;
mod lengths;
mod modules;
mod purity;
mod tokens;
