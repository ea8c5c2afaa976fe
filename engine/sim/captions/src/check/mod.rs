//! The slot check: claims of a text against facts of the trajectory.

mod claims;
mod clothes;
mod script;
mod slot;
#[cfg(test)]
mod tests;
mod text;
mod turns;

pub use slot::{Slot, SlotMismatch};
pub use text::{check, check_clothes, claimed};
