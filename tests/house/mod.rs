//! Laws of the house, read from the source: circles of files, lengths, sizes, names, purity of `sim`, edges between crates, public interfaces.

mod circles;
mod closures;
pub mod edges;
mod interfaces;
pub mod lengths;
mod modules;
mod names;
mod purity;
pub mod tokens;
