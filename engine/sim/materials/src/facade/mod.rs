//! Buildings: facades with storeys, deep windows, balconies, shops and doors, and flat and pitched roofs, all drawn from the building's
//! seed and its family.

mod balconies;
mod box_face;
mod draws;
mod family;
mod paint;
mod roof;
mod shops;
mod tiles;
mod wall;
mod windows;

pub use box_face::BoxFace;
pub use paint::facade;
pub use roof::{Roof, roofs};
pub use tiles::{Tiles, lift, tiles};
pub use wall::Facade;
