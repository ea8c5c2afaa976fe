//! Reads English texts: `text` goes clause by clause, the other rooms know one subject each.

pub mod clothes;
mod garments;
mod idioms;
mod negation;
pub mod numbers;
mod pauses;
mod quantities;
mod text;
pub mod tokens;
mod turns;
pub(crate) mod units;
pub(crate) mod words;

pub(crate) use text::is_of_a_walk;
pub use text::read;
