//! Columns: name, kind, meaning and the way from a record to a cell, all in one line; schema, card and
//! `croissant.json` are read off the same list.

/// What a column holds. `nullable` is a property of the column, not of the kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// Text.
    Text,
    /// 64-bit integer.
    Integer,
    /// 64-bit float.
    Real,
    /// True or false.
    Flag,
    /// One of the named classes, stored as its number.
    Label(&'static [&'static str]),
    /// A fixed number of 64-bit floats.
    Reals(usize),
    /// A pixel box: left, top, right, bottom edge as 32-bit floats.
    Box,
    /// Any number of 64-bit floats.
    RealList,
    /// Any number of 32-bit floats.
    FloatList,
    /// Any number of 64-bit integers.
    IntegerList,
    /// Any number of texts.
    TextList,
    /// An image file.
    Image,
}

/// One value of a row.
#[derive(Clone, Debug, PartialEq)]
#[expect(missing_docs, reason = "each holds the value of the kind of the same name")]
pub enum Cell {
    Null,
    Text(String),
    Integer(i64),
    Real(f64),
    Flag(bool),
    Reals(Vec<f64>),
    Box([f32; 4]),
    Floats(Vec<f32>),
    Integers(Vec<i64>),
    Texts(Vec<String>),
    Image(Vec<u8>),
}

macro_rules! cells {
    ($($from:ty => |$value:ident| $cell:expr),* $(,)?) => {$(
        impl From<$from> for Cell {
            fn from($value: $from) -> Self {
                $cell
            }
        }
    )*};
}

cells! {
    String => |value| Cell::Text(value),
    &str => |value| Cell::Text(value.to_owned()),
    &String => |value| Cell::Text(value.clone()),
    i64 => |value| Cell::Integer(value),
    u64 => |value| Cell::Integer(i64::try_from(value).unwrap_or(i64::MAX)),
    u32 => |value| Cell::Integer(i64::from(value)),
    usize => |value| Cell::from(value as u64),
    f64 => |value| Cell::Real(value),
    bool => |value| Cell::Flag(value),
    [f32; 4] => |value| Cell::Box(value),
    Vec<f64> => |value| Cell::Reals(value),
    [f64; 6] => |value| Cell::Reals(value.to_vec()),
    cosfly_frames::DVec3 => |value| Cell::Reals(value.to_array().to_vec()),
    Vec<f32> => |value| Cell::Floats(value),
    Vec<i64> => |value| Cell::Integers(value),
    Vec<String> => |value| Cell::Texts(value),
    Vec<u8> => |value| Cell::Image(value),
}

impl<T: Into<Cell>> From<Option<T>> for Cell {
    fn from(value: Option<T>) -> Self {
        value.map_or(Cell::Null, Into::into)
    }
}

/// One column of a table whose rows come from `S`.
pub struct Column<S> {
    /// Name, with its unit.
    pub name: &'static str,
    /// What it holds.
    pub kind: Kind,
    /// Whether a row may have no value.
    pub nullable: bool,
    /// What it means, with frame and convention.
    pub doc: &'static str,
    /// The value of row `usize` of a record.
    pub cell: fn(&S, usize) -> Cell,
}

impl<S> Column<S> {
    /// A column with a value in every row.
    pub fn new(name: &'static str, kind: Kind, doc: &'static str, cell: fn(&S, usize) -> Cell) -> Self {
        Self { name, kind, nullable: false, doc, cell }
    }

    /// A column that may be empty.
    pub fn optional(name: &'static str, kind: Kind, doc: &'static str, cell: fn(&S, usize) -> Cell) -> Self {
        Self { name, kind, nullable: true, doc, cell }
    }
}

/// A table whose rows come from records of type `S`.
pub struct Table<S> {
    /// Name: folder under `data/` and name of the Hugging Face config.
    pub name: &'static str,
    /// One sentence for the card.
    pub doc: &'static str,
    /// Columns that together name a row.
    pub key: &'static [&'static str],
    /// Rows of one record.
    pub rows: fn(&S) -> usize,
    /// Whether it has a row per frame, so that large datasets split it into several files.
    pub per_frame: bool,
    /// Rows kept together in a file.
    pub rows_per_group: usize,
    /// Whether its cells read the previews.
    pub reads_previews: bool,
    /// Whether its cells read the expert of a perturbed flight.
    pub reads_expert: bool,
    /// The columns, in their order.
    pub columns: Vec<Column<S>>,
}
