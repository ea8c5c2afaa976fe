//! Readers of measured shapes: point clouds, triangle meshes.

pub mod bytes;
pub mod cloud;
pub mod coloured;
pub mod coloured_point;
pub mod faces_and_plates;
pub mod gltf;
pub mod grid;
pub mod ground_filter;
pub mod las;
pub mod mesh;
pub mod obj;
pub mod open_ground;
pub mod pcd;
pub mod plan;
pub mod ply;
pub mod relief;
pub mod scalar;
pub mod solid_cells;
pub mod tiles;
pub mod up_axis;
pub mod way_out;
pub mod window_cover;
