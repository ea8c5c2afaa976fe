//! Reads English texts: `text` goes clause by clause, the other rooms know one subject each.

pub(crate) mod clothes;
mod garments;
mod idioms;
mod negation;
pub(crate) mod numbers;
mod pauses;
mod quantities;
mod text;
pub(crate) mod tokens;
mod turns;
pub(crate) mod units;
pub(crate) mod words;

pub(crate) use text::is_of_a_walk;
pub use text::read;
