//! The type whose constants are the columns of table `trajectories`; its groups stand in files of their own.

/// Columns of table `trajectories`.
pub struct Trajectories;
