//! The RGB pass: light, materials and weather for the faces seen, in bands of rows.
//!
//! Pixels of one face (of one label, for ground) in a band are gathered into blocks of sixteen, and kernels take a
//! block through all of shading: where it is ([`geometry`], [`shadow`]), what it is made of ([`ground`], [`facade`],
//! [`things`]), what it sends to the camera ([`lighting`]). Bands depend on nothing but the faces, so threads share them.

mod bands;
mod body_shadow;
mod cloth;
mod coach;
mod contact;
mod curve;
mod face_material;
pub mod foliage;
pub mod geometry;
pub(crate) mod headlights;
mod kernels;
pub mod lighting;
pub(crate) mod material;
pub mod outskirts;
mod seen_places;
pub mod setting;
pub mod shader;
pub mod shadow;
pub mod simple;
mod skin;
pub mod sky;
pub mod smooth;
mod sun_map;
pub(crate) mod sun_tiles;
mod sun_window;
mod sunlight;
