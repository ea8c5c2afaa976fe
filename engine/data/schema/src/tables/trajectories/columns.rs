//! The type whose constants are the columns of table `trajectories`; groups of columns are in separate files.

/// Columns of table `trajectories`.
pub struct Trajectories;
