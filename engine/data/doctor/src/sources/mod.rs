//! From what is cosfly's own to episodes: published datasets, and flights that are not published yet.

pub mod ours;
pub mod record;
