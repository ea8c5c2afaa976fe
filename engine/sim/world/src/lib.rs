//! People and vehicles at a time: bodies with tracks.
//!
//! [`cosfly_domain::Traffic`] holds all tracks of one town; planner, renderer, captions and tables read it. A [`Population`] is a group of
//! bodies that move by one rule (a crowd, vehicles on lanes, recorded tracks); [`simulate`] steps several of them together:
//! all see the same [`Snapshot`] of the moment before, so results depend neither on their order nor on threads.

mod contacts;
mod gap;
mod look_alikes;
mod looks;
mod population;
mod prescribed;
mod snapshot;

pub use contacts::{Contact, contacts};
pub use gap::gap_m;
pub use look_alikes::{LookAlikeConfig, OutfitsBySeed, dress};
pub use looks::{BagShares, BuildShares, GaitShares, LooksConfig, give_looks};
pub use population::{Clock, Population, simulate};
pub use prescribed::Prescribed;
pub use snapshot::{Present, Snapshot};
