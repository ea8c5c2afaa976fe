//! Flights as tables for stages that are plugins, and their answers read back: Arrow streams of one record batch.
//!
//! * [`FlightColumns`]: what there is to be read of a flight, as a stream of the columns that a plugin declares.
//! * [`read_answer`], [`verdict`], [`labels`]: answers, held against what the plugin declares to give.

mod answer;
mod offered;

pub use answer::{MOST_FILE_BYTES, MOST_FILES, MOST_ROWS, Verdict, labels, read_answer, verdict};
pub use offered::{FlightColumns, NoColumn, SAMPLE_FRAMES, check_names};

use serde::{Deserialize, Serialize};

/// What a column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum ColumnKind {
    /// 64-bit floats.
    Real,
    /// 64-bit integers.
    Integer,
    /// Truths.
    Boolean,
    /// Texts.
    Text,
    /// Bytes.
    Bytes,
}

impl ColumnKind {
    /// As in the interface of plugins.
    pub fn name(self) -> &'static str {
        match self {
            Self::Real => "real",
            Self::Integer => "integer",
            Self::Boolean => "boolean",
            Self::Text => "text",
            Self::Bytes => "bytes",
        }
    }
}

/// A column that a plugin declares to read or to give.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct DeclaredColumn {
    /// Its name.
    pub name: String,
    /// What it holds.
    pub kind: ColumnKind,
    /// What it means.
    pub doc: String,
}

/// The values of a column.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Values {
    /// Finite floats.
    Reals(Vec<f64>),
    /// Integers.
    Integers(Vec<i64>),
    /// Truths.
    Booleans(Vec<bool>),
    /// Texts.
    Texts(Vec<String>),
    /// Bytes.
    Bytes(Vec<Vec<u8>>),
}

impl Values {
    /// How many there are.
    pub fn len(&self) -> usize {
        match self {
            Self::Reals(values) => values.len(),
            Self::Integers(values) => values.len(),
            Self::Booleans(values) => values.len(),
            Self::Texts(values) => values.len(),
            Self::Bytes(values) => values.len(),
        }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// What they are.
    pub fn kind(&self) -> ColumnKind {
        match self {
            Self::Reals(_) => ColumnKind::Real,
            Self::Integers(_) => ColumnKind::Integer,
            Self::Booleans(_) => ColumnKind::Boolean,
            Self::Texts(_) => ColumnKind::Text,
            Self::Bytes(_) => ColumnKind::Bytes,
        }
    }
}

#[cfg(test)]
mod tests;
