//! Reason why items of a stage will run.

use crate::change::Change;
use std::fmt;

/// Reason why some items of a stage will run.
#[derive(Clone, Debug, PartialEq)]
pub enum Reason {
    /// Changes of the items themselves, or of the stage as a whole.
    Changed(Vec<Change>),
    /// Stages whose items will be made again and are read.
    Upstream(Vec<String>),
    /// Other inputs are connected.
    Wiring,
}

/// Most stages that a reason names.
const MOST_NAMED: usize = 5;

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Changed(changes) => changes.iter().enumerate().try_for_each(|(index, change)| {
                f.write_str(if index == 0 { "" } else { "; " })?;
                change.fmt(f)
            }),
            Self::Upstream(stages) => {
                let named = stages.len().min(MOST_NAMED);
                write!(f, "its inputs from `{}`", stages[..named].join("`, `"))?;
                match stages.len() - named {
                    0 => f.write_str(" changed"),
                    more => write!(f, " and {more} more stages changed"),
                }
            }
            Self::Wiring => write!(f, "other inputs are connected"),
        }
    }
}
