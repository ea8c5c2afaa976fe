//! World frame, poses, target tracks and platform-independent real maths.
//!
//! # The world frame
//! CARLA's: **left-handed**, x forward (east on a map drawn with y down), y right, z up, metres.
//! Angles are radians in code and degrees in files and recipes. Positive yaw turns x towards y,
//! positive pitch lifts the nose, positive roll lowers the right side. Everything named `*_in_world`
//! is in this frame; conversions happen once, at a border, in a function that names both frames.

pub mod action;
pub mod pose;
pub mod real;
pub mod simd;
pub mod track;

pub use cosfly_random::{RandomStream, Seed};
pub use glam::{DMat3, DQuat, DVec2, DVec3};
pub use pose::Pose;
pub use track::{TargetState, TargetTrack};
