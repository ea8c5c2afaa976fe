//! [`PlanError`]: the reason why there is no flight.

use std::error::Error;
use std::fmt::{self, Display, Formatter};

/// The reason why there is no flight. Its text is the reason that [`cosfly_domain::PlanOutcome::Rejected`] carries.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum PlanError {
    /// The configuration, the track or another part of the request cannot be planned for; in words.
    Request(String),
    /// No way around the obstacles was found; in words.
    NoWay(String),
    /// A way was found, but it breaks these rules of its certificate.
    Rules(Vec<String>),
    /// One part of a long flight has no way.
    Part {
        /// The part, as in "in frames 120 to 360".
        place: String,
        /// The reason there.
        cause: Box<PlanError>,
    },
}

impl PlanError {
    /// This error as that of one part of a flight.
    pub(crate) fn at(self, place: String) -> Self {
        Self::Part { place, cause: Box::new(self) }
    }

    /// Whether another request is needed: no map and no effort makes this one a flight.
    pub fn is_bad_request(&self) -> bool {
        match self {
            Self::Request(_) => true,
            Self::NoWay(_) | Self::Rules(_) => false,
            Self::Part { cause, .. } => cause.is_bad_request(),
        }
    }
}

impl Display for PlanError {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Request(reason) | Self::NoWay(reason) => f.write_str(reason),
            Self::Rules(rules) => f.write_str(&rules.join("; ")),
            Self::Part { place, cause } => write!(f, "{place}: {cause}"),
        }
    }
}

impl Error for PlanError {}
