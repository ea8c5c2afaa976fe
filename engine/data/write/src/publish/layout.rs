//! The layout of published datasets.

/// Version of the layout of published datasets; raised when paths, tables or conventions change.
pub const LAYOUT_VERSION: u32 = 1;
