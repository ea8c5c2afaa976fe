//! Messages of all languages as data, and the [`Speaker`] that fills them.

mod languages;
#[cfg(test)]
mod laws;
mod slots;
mod speaker;
mod table;

pub(crate) use languages::{approximately, messages};
pub(crate) use slots::{capital, fill};
pub(crate) use speaker::Speaker;
pub(crate) use table::Messages;
