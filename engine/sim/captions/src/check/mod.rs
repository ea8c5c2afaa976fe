//! The slot check: claims of a text against facts of the trajectory.

mod agreement;
mod claims;
mod clothes;
mod labels;
mod script;
mod slot;
#[cfg(test)]
mod tests;
mod text;

pub(crate) use clothes::clothes_mismatch;
pub(crate) use script::script_mismatch;
pub use slot::{Slot, SlotMismatch};
pub use text::{check, check_clothes, claimed};
