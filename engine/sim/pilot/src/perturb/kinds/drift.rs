//! `drift`: nothing but the drift that every twin has which a drone could fly.

use super::kind::{Departure, Kind, no_offsets, straight_on};

pub(super) const KIND: Kind = Kind {
    name: "drift",
    doc: "Nothing but the drift.",
    departure: Departure::Flown { offsets: no_offsets, views: straight_on },
};
