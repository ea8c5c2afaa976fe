//! Readers of measured shapes: point clouds, triangle meshes.
