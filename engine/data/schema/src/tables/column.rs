//! Columns, defined once: name, unit, type, meaning and the function from a record to a value. Writers, readers,
//! checker, card, manifest and reference page all use the column's entry.

use super::value::{Kind, Value};
use arrow_array::ArrayRef;

/// One column of a table whose rows come from `S`; its values are `T`.
#[derive(Debug)]
pub struct Column<S, T> {
    /// Name, with the unit as its ending.
    pub name: &'static str,
    /// Unit where the name does not end in one.
    pub unit: Option<&'static str>,
    /// Meaning, with frame and convention.
    pub doc: &'static str,
    /// Function from a record and a row number to the value.
    pub cell: fn(&S, usize) -> T,
}

impl<S, T> Clone for Column<S, T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S, T> Copy for Column<S, T> {}

impl<S, T> Column<S, T> {
    /// A column whose name is not a Rust identifier, such as those of foreign formats.
    pub const fn named(name: &'static str, doc: &'static str, cell: fn(&S, usize) -> T) -> Self {
        Self { name, unit: None, doc, cell }
    }
}

/// A value that a column cannot hold: row and rule.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CellProblem {
    /// Row number among those of the record.
    pub row: usize,
    /// The violated rule.
    pub rule: String,
}

/// A column of any type, for lists of columns.
pub trait AnyColumn<S>: Sync {
    /// Name, with the unit as its ending.
    fn name(&self) -> &'static str;
    /// Unit of the numbers, where they have one.
    fn unit(&self) -> Option<&'static str>;
    /// Meaning, with frame and convention.
    fn doc(&self) -> &'static str;
    /// Type of the values.
    fn kind(&self) -> Kind;
    /// Whether rows may be null.
    fn nullable(&self) -> bool;
    /// Array of the first `rows` rows of a record.
    ///
    /// # Errors
    /// The first value that the column cannot hold, such as NaN.
    fn array(&self, record: &S, rows: usize) -> Result<ArrayRef, CellProblem>;
}

impl<S, T: Value> AnyColumn<S> for Column<S, T> {
    fn name(&self) -> &'static str {
        self.name
    }

    fn unit(&self) -> Option<&'static str> {
        self.unit.or_else(|| unit_of(self.name))
    }

    fn doc(&self) -> &'static str {
        self.doc.trim_start()
    }

    fn kind(&self) -> Kind {
        T::KIND
    }

    fn nullable(&self) -> bool {
        T::NULLABLE
    }

    fn array(&self, record: &S, rows: usize) -> Result<ArrayRef, CellProblem> {
        let values: Vec<T> = (0..rows).map(|row| (self.cell)(record, row)).collect();
        if let Some((row, rule)) = values.iter().enumerate().find_map(|(row, value)| Some((row, value.problem()?))) {
            return Err(CellProblem { row, rule });
        }
        Ok(T::array(values))
    }
}

/// Suffixes of names and their units; the first that fits counts.
const UNITS: [(&str, &str); 8] = [
    ("_m", "m"),
    ("_deg_s", "degrees/s"),
    ("_s", "s"),
    ("_deg", "degrees"),
    ("_px", "pixels"),
    ("_mps", "m/s"),
    ("_mps2", "m/s^2"),
    ("_mps3", "m/s^3"),
];

/// Unit given by the suffix of a name.
fn unit_of(name: &str) -> Option<&'static str> {
    UNITS.iter().find(|(ending, _)| name.ends_with(ending)).map(|(_, unit)| *unit)
}

/// Defines the columns of a table, one entry each: meaning, name, type, unit where the name does not end in it, value.
///
/// `columns! { Frames::COLUMNS of DatasetItem; ... }` makes each an associated constant [`Column`] of the type
/// `Frames`, such as `Frames::drone_x_m`, by which readers request it, and the list of all of them, `Frames::COLUMNS`.
macro_rules! columns {
    ($table:ident::$list:ident of $source:ty; $($(#[doc = $doc:literal])+ $name:ident: $kind:ty $([$unit:literal])? = $cell:expr;)*) => {
        #[expect(non_upper_case_globals, reason = "the constants bear the names of the columns")]
        impl $table {
            $(
                $(#[doc = $doc])+
                pub const $name: $crate::tables::Column<$source, $kind> = $crate::tables::Column {
                    name: stringify!($name),
                    unit: columns!(@unit $($unit)?),
                    doc: concat!($($doc),+),
                    cell: $cell,
                };
            )*
            /// Columns in their order.
            pub const $list: &[&dyn $crate::tables::AnyColumn<$source>] = &[$(&Self::$name),*];
        }
    };
    (@unit) => { None };
    (@unit $unit:literal) => { Some($unit) };
}
pub(super) use columns;
