//! Columns that plugins read and return, and their values.

use serde::{Deserialize, Serialize};

/// Type of a column's values.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum ColumnKind {
    /// 64-bit floats.
    Real,
    /// 64-bit integers.
    Integer,
    /// Booleans.
    Boolean,
    /// Texts.
    Text,
    /// Bytes.
    Bytes,
}

impl ColumnKind {
    /// Name of the type in the plugin interface.
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

/// A column that a plugin declares to read or to return.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct DeclaredColumn {
    /// Name of the column.
    pub name: String,
    /// Type of the values.
    pub kind: ColumnKind,
    /// Meaning of the column.
    pub doc: String,
}

/// Values of a column.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Values {
    /// Finite floats.
    Reals(Vec<f64>),
    /// Integers.
    Integers(Vec<i64>),
    /// Booleans.
    Booleans(Vec<bool>),
    /// Texts.
    Texts(Vec<String>),
    /// Bytes.
    Bytes(Vec<Vec<u8>>),
}

impl Values {
    /// Number of values.
    pub fn len(&self) -> usize {
        match self {
            Self::Reals(values) => values.len(),
            Self::Integers(values) => values.len(),
            Self::Booleans(values) => values.len(),
            Self::Texts(values) => values.len(),
            Self::Bytes(values) => values.len(),
        }
    }

    /// Whether there are no values.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Type of the values.
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
