//! Streets alone as OpenDRIVE text, for a plan that somebody else made.

pub use crate::net::network::{acute_ends, short_streets};
pub use crate::net::plan::{Profile, StreetPlan};

use crate::net::network::Network;
use crate::net::ways::all_ways;
use crate::net::write::write_opendrive;

/// OpenDRIVE 1.6 text of the streets of a plan.
pub fn open_drive(plan: &StreetPlan, name: &str) -> String {
    let network = Network::lay(plan);
    write_opendrive(&network, &all_ways(&network), &[], [name, "Streets laid by cosfly. Lengths in metres."])
}
