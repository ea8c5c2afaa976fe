//! The renderer's backend for graphics cards: the card finds the nearest face at each pixel, through wgpu.
//!
//! Everything after that (depth, ids, light, materials, weather) is computed by the CPU renderer on the same faces, so
//! the two backends differ at most along edges, where a card may decide differently which pixel centres lie inside.
//!
//! Without the feature `device` this crate is empty.

#[cfg(feature = "device")]
mod card;
#[cfg(feature = "device")]
mod mesh;

#[cfg(feature = "device")]
pub use card::GpuBackend;
