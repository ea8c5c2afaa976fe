//! The drones behind the same walk that were planned before one: what its twins and filters of its flights need to know of them.

use crate::{codec, ports};
use cosfly_blobs::OutputSink;
use cosfly_diagnose::Result;
use cosfly_frames::DVec3;
use cosfly_geometry::OrientedBox;
use cosfly_planner::obstacles::moving::{OtherDrones, drone_boxes};
use cosfly_stage::{Artifact, Inputs};
use serde::{Deserialize, Serialize};

/// Blob of a flight with its [`DronesBefore`]; absent where there is none.
pub const DRONES_BLOB: &str = "drones";

/// Flights of the drones before one.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct DronesBefore {
    /// Smallest distance from drone to drone, metres.
    pub separation_m: f64,
    /// Places of each drone, frame by frame, world frame, metres.
    pub places: Vec<Vec<DVec3>>,
}

impl DronesBefore {
    /// Writes them beside a flight; nothing where there is none.
    pub fn put(&self, outputs: &mut dyn OutputSink) -> Result<()> {
        if self.places.is_empty() {
            return Ok(());
        }
        outputs.put(DRONES_BLOB, &codec::encode(ports::AROUND, self)?)
    }

    /// Those before the drone of a flight.
    pub fn of(inputs: &Inputs<'_>, flight: &Artifact) -> Result<Self> {
        if !flight.blobs.contains_key(DRONES_BLOB) {
            return Ok(Self::default());
        }
        codec::decode(ports::AROUND, &inputs.read(flight, DRONES_BLOB)?)
    }

    /// Adds their boxes to those that move; says what is kept from them.
    pub fn join(&self, movers: &mut Vec<Vec<OrientedBox>>) -> OtherDrones {
        movers.extend(self.places.iter().map(|places| drone_boxes(places)));
        OtherDrones { count: self.places.len(), separation_m: self.separation_m }
    }
}
