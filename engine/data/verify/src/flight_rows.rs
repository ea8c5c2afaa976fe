//! [`FlightRows`]: the rows of a flight, and all that they are compared with.

use crate::bodies::SpaceOfFlight;
use crate::body::PlacedBody;
use crate::rows::{PlacedFlight, PlacedFrame};
use crate::tables::{Extent, LossRow, PairRow};
use cosfly_read::FlightTrack;
use std::collections::{BTreeMap, BTreeSet};

/// The rows of a flight in all tables.
pub struct FlightRows<'a> {
    /// File of table `frames`, for findings.
    pub file: &'a str,
    /// Row of table `trajectories`.
    pub flight: &'a PlacedFlight,
    /// Rows of table `frames`, in the order of the file.
    pub frames: &'a [PlacedFrame],
    /// File of table `bodies`, for findings.
    pub bodies_file: &'a str,
    /// Rows of table `bodies`.
    pub bodies: &'a [PlacedBody],
    /// Rows of table `bodies_3d`, where there are some.
    pub in_space: Option<&'a SpaceOfFlight>,
    /// Instance ids of the town's objects.
    pub objects: Option<&'a BTreeSet<u32>>,
    /// Rows of table `pairs` by the perturbed flight.
    pub pairs: &'a BTreeMap<String, PairRow>,
    /// Rows of table `target_losses`, in the order of the file.
    pub losses: &'a [LossRow],
    /// Reach of the town, metres.
    pub extent: Option<&'a Extent>,
    /// Motion of the expert of a perturbed flight.
    pub expert: Option<&'a FlightTrack>,
    /// Another film of the same flight, the one with the most frames, and its motion.
    pub film: Option<(&'a PlacedFlight, &'a FlightTrack)>,
}
