//! `traffic`: people and vehicles who move together through the town, and the walks of those who are followed.

mod moving;
mod stage;

pub use moving::{around, cut_around, followed, link_moving, put_around, traffic_of};
pub use stage::TrafficKind;
