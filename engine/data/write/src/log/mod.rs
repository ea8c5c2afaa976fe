//! Writes the log of one trajectory: an MCAP file of Foxglove messages, readable without our code.

mod channels;
mod container;
mod metadata;
mod scene;
mod writer;

pub use writer::write_log;

#[cfg(test)]
mod tests;
