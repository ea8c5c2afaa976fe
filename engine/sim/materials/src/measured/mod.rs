//! Pitched roofs whose boxes are steps of a measured surface: planes below the steps, and the parts of boxes below them.
//!
//! [`terraces`] is the plan of a building as heights on a grid; [`planes`] finds the planes that its terraces stand for; [`pieces`]
//! cuts each box to them ([`roofs`]). What is drawn lies within the boxes.

pub mod pieces;
pub mod planes;
pub mod roofs;
pub mod terraces;
