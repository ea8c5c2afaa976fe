//! Kinds of bodies, a row and a file each.
//!
//! To add one, write its file, add its `mod` here, and its variant with its lines in `kind.rs`.

mod bicycle;
mod bus;
mod car;
mod drone;
mod kind;
mod motorcycle;
mod pedestrian;
mod row;
mod truck;
mod van;

pub use kind::BodyKind;
pub use row::{BodyKindRow, Driving};
