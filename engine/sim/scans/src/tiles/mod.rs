//! Folders of OGC 3D Tiles, 1.0 and 1.1, joined to one GLB file at one level of detail: y up, x to the east, metres.
//!
//! [`join`] walks the tiles, [`TilesChoice`] says how fine and where; it opens files of the folder alone, by the caller's hand.

mod contents;
mod earth;
mod implicit;
mod join;
mod joined;
mod paths;
mod tileset;
mod volume;

pub use join::{JoinedTiles, TilesChoice, join};
