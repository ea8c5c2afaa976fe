//! The renderer's backend for graphics cards: a card finds which face is nearest at each pixel, through wgpu.
//!
//! Everything after that (depth, ids, light, materials, weather) is the CPU renderer's own code on the same faces, so the
//! two differ at most along edges, where a card may decide another way which pixel centre lies inside.
//!
//! Without the feature `device` this crate is empty.

#[cfg(feature = "device")]
mod card;
#[cfg(feature = "device")]
mod mesh;

#[cfg(feature = "device")]
pub use card::GpuBackend;
