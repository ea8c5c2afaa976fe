//! Files and folders that appear whole or not at all, also where several processes make them at the same moment.
//!
//! No command looks whether a place is free and then creates: between the two another process may have done the same. What is made
//! is made beside its place under a name of its own and renamed, and the rename says who was first.
//!
//! * [`write_file`]: a file; [`draft`]: a file that is written piece by piece.
//! * [`NewFolder`]: a folder; [`Appeared`]: whether it was the first at its place; [`write_files`]: a folder of a few files, which may be there.

mod file;
mod folder;

pub use file::{draft, write_file};
pub use folder::{Appeared, NewFolder, write_files};
