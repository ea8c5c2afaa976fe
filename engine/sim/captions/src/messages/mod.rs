//! Messages of all languages as data, and the [`Speaker`] that fills them.

mod languages;
mod slots;
mod speaker;
mod table;
#[cfg(test)]
mod tests;

pub(crate) use languages::{approximately, messages_of};
pub(crate) use slots::{capital, fill};
pub(crate) use speaker::Speaker;
pub(crate) use table::Messages;
