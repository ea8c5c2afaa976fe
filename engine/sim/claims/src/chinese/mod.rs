//! Reads Chinese texts: `text` goes clause by clause, the other rooms know one subject each.

pub mod clothes;
pub(crate) mod garments;
mod numbers;
mod pauses;
mod plain;
mod quantities;
mod text;
mod turns;
mod words;

pub use plain::plain;
pub use text::clauses;
pub use text::read;
