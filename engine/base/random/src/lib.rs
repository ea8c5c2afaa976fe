//! Seeded random streams: one per (recipe seed, stage, item), the same on every machine and thread count.

pub mod seed;
pub mod stream;

pub use seed::Seed;
pub use stream::RandomStream;
