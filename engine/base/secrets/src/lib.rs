//! The rule that keeps keys, tokens and passwords out of texts: cards, rows, pages, logs, errors.
//!
//! * [`without_secrets`]: hides what a text itself shows to be a secret: `user:password@` and `?key=` of addresses, keys of headers.
//! * [`Secrets`]: hides secrets that are known: a key that was given, values of the environment.
//! * [`has_secret`]: whether an address holds one. Such addresses are refused where they would be written down.

mod address;
mod known;

pub use address::{has_secret, without_secrets};
pub use known::Secrets;
