//! A leaderboard without a server: a folder of bundles, flown again, as a page.
//!
//! * [`judge`](fn@judge): flies what is new, and gives a [`Board`]; [`Offer`]: a suite that entries may be of.
//! * [`Entry`], with the [`Notes`] of its maker, and what it [proves](Proof).
//! * [`page`](fn@page), [`json`], [`told`]: the board for browsers, programs, terminals.

mod alike;
mod entry;
mod judge;
mod notes;
mod page;
mod sees;
mod sketch;
mod standing;
mod table;

pub use entry::{Entry, Proof};
pub use judge::{Bench, Offer, judge};
pub use notes::Notes;
pub use page::page;
pub use sees::PolicySees;
pub use standing::{Board, Class, Contest, Refused, Standing};
pub use table::{json, told};
