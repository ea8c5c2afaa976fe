//! Kinds of bodies, a row and a file each.
//!
//! To add one, write its file, add its `mod` here, and its variant with its lines in `kind.rs`.

mod bicycle;
mod bus;
mod car;
mod child;
mod dog_walker;
mod drone;
mod e_scooter;
mod elder;
mod kind;
mod motorcycle;
mod pedestrian;
mod push_chair;
mod row;
mod runner;
mod sitter;
mod truck;
mod van;
mod wheelchair;

pub use kind::BodyKind;
pub use row::{BodyKindRow, Driving, Walking};
