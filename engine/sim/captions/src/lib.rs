//! Typed facts of a trajectory, and Chinese and English instructions checked against them.
