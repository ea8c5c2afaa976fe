//! The kinds of plugins, and the interface that each exports.

use crate::interface_0_1::{PACKAGE, VERSION};

/// The kind of a plugin.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// A cost term of the planner.
    CostTerm,
    /// An objective.
    Objective,
    /// A stage.
    Stage,
}

impl Kind {
    /// All kinds.
    pub const ALL: [Self; 3] = [Self::CostTerm, Self::Objective, Self::Stage];

    /// The name of the interface without package and version.
    pub(crate) fn interface_name(self) -> &'static str {
        match self {
            Self::CostTerm => "cost",
            Self::Objective => "reference",
            Self::Stage => "tables",
        }
    }

    /// The interface that plugins of this kind export, such as `cosfly:plugin/cost@0.1.0`.
    pub fn interface(self) -> String {
        format!("{PACKAGE}{}@{VERSION}", self.interface_name())
    }

    /// The kind in words, such as "a cost term".
    pub fn words(self) -> &'static str {
        match self {
            Self::CostTerm => "a cost term",
            Self::Objective => "an objective",
            Self::Stage => "a stage",
        }
    }
}
