//! A general street network: any planar graph of streets with 1 to 5 arms per junction, its blocks, and its OpenDRIVE.

pub mod faces;
pub mod network;
pub mod plan;
pub mod ways;
pub mod write;
