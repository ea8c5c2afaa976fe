//! States of the lattice's nodes: hidden body points, nearness of obstacles.

/// State of a node: the number of hidden body points (0..=8), [`CLOSE`] added when an obstacle is near, or
/// [`UNSAFE`].
pub type NodeState = u8;
/// Set when an obstacle is within the clearance plus [`CLOSE_EXTRA_M`].
pub const CLOSE: NodeState = 0x10;
/// The node is too near an obstacle or the ground.
pub const UNSAFE: NodeState = 0xff;
/// Distance below which a node is [`CLOSE`], metres.
pub const CLOSE_EXTRA_M: f64 = 1.5;
