//! Laws of the house, read from the source: circles of files, lengths, purity of `sim`, edges between crates, public interfaces.

mod circles;
pub mod edges;
mod interfaces;
pub mod lengths;
mod modules;
mod purity;
pub mod tokens;
