//! Reads Chinese texts: `text` goes clause by clause, the other rooms know one subject each.

pub(crate) mod clothes;
pub(crate) mod garments;
mod numbers;
mod pauses;
mod plain;
mod quantities;
mod text;
mod turns;
mod words;

pub(crate) use plain::plain;
pub(crate) use text::clauses;
pub use text::read;
