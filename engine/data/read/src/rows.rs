//! Rows of a table's file, row group by row group. Columns are requested by their entries in the schema and decoded on
//! the first request, so that no reader lists the columns that it needs.

use super::damage::damaged;
use super::parquet_metadata::{self, Batches};
use arrow_array::cast::AsArray;
use arrow_array::{Array, ArrayRef, RecordBatch};
use arrow_schema::DataType;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_schema::tables::{Column, Kind, Value};
use parquet::arrow::ProjectionMask;
use parquet::arrow::arrow_reader::{ArrowReaderMetadata, ParquetRecordBatchReaderBuilder};
use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::marker::PhantomData;
use std::path::Path;

/// An open file of a table.
pub struct TableFile<'p> {
    path: &'p Path,
    file: File,
    metadata: ArrowReaderMetadata,
    /// Columns requested so far; in the next row group they are decoded together.
    wanted: RefCell<BTreeSet<usize>>,
}

/// The rows of one row group.
pub struct Rows<'f> {
    file: &'f TableFile<'f>,
    group: usize,
    rows: usize,
    decoded: RefCell<BTreeMap<usize, ArrayRef>>,
    /// Requested columns, with their checked types.
    asked: RefCell<Vec<(&'static str, Kind, ArrayRef)>>,
}

/// Values of a column in the rows of one group.
pub struct RowValues<'f, T> {
    array: ArrayRef,
    name: &'static str,
    path: &'f Path,
    kind: PhantomData<T>,
}

/// Calls `visit` with the rows of the file at `path`, one row group after the other.
///
/// # Errors
/// The file is not Parquet, or an error of `visit`.
pub fn read(path: &Path, visit: &mut dyn FnMut(&Rows<'_>) -> Result<()>) -> Result<()> {
    let file = TableFile::open(path)?;
    (0..file.metadata.metadata().num_row_groups()).try_for_each(|group| visit(&file.group(group)?))
}

impl<'p> TableFile<'p> {
    /// Reads the footer of the file at `path`.
    ///
    /// # Errors
    /// The file cannot be opened or is not Parquet.
    pub fn open(path: &'p Path) -> Result<Self> {
        let file = File::open(path).map_err(|error| Diagnostic::io(format!("open `{}`", path.display()), &error))?;
        let metadata = parquet_metadata::load(&file).map_err(|error| damaged(path, "it is not Parquet", error))?;
        Ok(Self { path, file, metadata, wanted: RefCell::default() })
    }

    /// Arrow schema of the file.
    pub fn schema(&self) -> &arrow_schema::Schema {
        self.metadata.schema()
    }

    /// Number of row groups.
    pub fn groups(&self) -> usize {
        self.metadata.metadata().num_row_groups()
    }

    /// Reads a row group; the columns requested in earlier groups are decoded at once.
    ///
    /// # Errors
    /// The group cannot be decoded.
    pub fn group(&self, group: usize) -> Result<Rows<'_>> {
        let rows = usize::try_from(self.metadata.metadata().row_group(group).num_rows()).unwrap_or(0);
        let wanted: Vec<usize> = self.wanted.borrow().iter().copied().collect();
        let decoded = wanted.iter().copied().zip(self.decode(group, &wanted)?).collect();
        Ok(Rows { file: self, group, rows, decoded: RefCell::new(decoded), asked: RefCell::default() })
    }

    /// Decodes some columns of a row group, each as one array.
    fn decode(&self, group: usize, columns: &[usize]) -> Result<Vec<ArrayRef>> {
        if columns.is_empty() {
            return Ok(vec![]);
        }
        let unreadable = |error: &dyn std::fmt::Display| damaged(self.path, "it cannot be read", error);
        let file = self.file.try_clone().map_err(|error| Diagnostic::io("read a table", &error))?;
        let builder = ParquetRecordBatchReaderBuilder::new_with_metadata(file, self.metadata.clone());
        let mask = ProjectionMask::roots(builder.parquet_schema(), columns.iter().copied());
        let rows = usize::try_from(self.metadata.metadata().row_group(group).num_rows()).unwrap_or(0);
        let reader = builder.with_row_groups(vec![group]).with_projection(mask).with_batch_size(rows.max(1)).build();
        let batches: Vec<RecordBatch> = Batches::of(reader.map_err(|error| unreadable(&error))?)
            .collect::<std::result::Result<_, _>>()
            .map_err(|error| unreadable(&error))?;
        match &batches[..] {
            [batch] if batch.num_rows() == rows => Ok(batch.columns().to_vec()),
            [] if rows == 0 => {
                let schema = self.metadata.schema();
                Ok(columns.iter().map(|at| arrow_array::new_empty_array(schema.field(*at).data_type())).collect())
            }
            _ => Err(damaged(
                self.path,
                "a row group does not have its declared number of rows",
                format!("row group {group}"),
            )),
        }
    }
}

impl<'f> Rows<'f> {
    /// Number of rows.
    pub fn len(&self) -> usize {
        self.rows
    }

    /// Place of the first row in the file.
    pub fn first(&self) -> usize {
        let groups = self.file.metadata.metadata().row_groups();
        groups[..self.group].iter().map(|group| usize::try_from(group.num_rows()).unwrap_or(0)).sum()
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.rows == 0
    }

    /// Whether the file has a column; older datasets have fewer columns.
    pub fn has<S, T>(&self, column: Column<S, T>) -> bool {
        self.place(column.name).is_some()
    }

    /// Values of a column.
    ///
    /// # Errors
    /// `dataset-column`: the file has no such column, or one of another type.
    pub fn values<S, T: Value>(&self, column: Column<S, T>) -> Result<RowValues<'f, T>> {
        Ok(RowValues {
            array: self.column(column.name, T::KIND)?,
            name: column.name,
            path: self.file.path,
            kind: PhantomData,
        })
    }

    fn column(&self, name: &'static str, kind: Kind) -> Result<ArrayRef> {
        let is_same = |it: &&(&'static str, Kind, ArrayRef)| std::ptr::eq(it.0, name) && it.1 == kind;
        if let Some((_, _, array)) = self.asked.borrow().iter().find(is_same) {
            return Ok(ArrayRef::clone(array));
        }
        let fits = |at: &usize| same_type(self.file.schema().field(*at).data_type(), &kind.data_type());
        let place = self.place(name).filter(fits).ok_or_else(|| {
            let (path, kind) = (self.file.path.display(), kind.words());
            let message = format!("`{path}` has no column `{name}` of the documented type, {kind}");
            Diagnostic::new("dataset-column", Fault::Input, message)
        })?;
        let array = self.array(place)?;
        self.asked.borrow_mut().push((name, kind, ArrayRef::clone(&array)));
        Ok(array)
    }

    /// Value of a column in a row; [`Self::values`] is faster for many rows.
    ///
    /// # Errors
    /// The errors of [`Self::values`], and `dataset-damaged`: the row has no such value.
    pub fn get<S, T: Value>(&self, column: Column<S, T>, row: usize) -> Result<T> {
        self.values(column)?.at(row)
    }

    /// Value of a column in a row, or `default` in a dataset from before the column existed.
    ///
    /// # Errors
    /// The errors of [`Self::get`].
    pub fn get_or<S, T: Value>(&self, column: Column<S, T>, row: usize, default: T) -> Result<T> {
        if self.has(column) { self.get(column, row) } else { Ok(default) }
    }

    /// Column number `place` of the file.
    ///
    /// # Errors
    /// The column cannot be decoded.
    pub fn array(&self, place: usize) -> Result<ArrayRef> {
        if let Some(array) = self.decoded.borrow().get(&place) {
            return Ok(ArrayRef::clone(array));
        }
        let array = self.file.decode(self.group, &[place])?.remove(0);
        self.file.wanted.borrow_mut().insert(place);
        self.decoded.borrow_mut().insert(place, ArrayRef::clone(&array));
        Ok(array)
    }

    fn place(&self, name: &str) -> Option<usize> {
        self.file.schema().index_of(name).ok()
    }
}

/// Whether two types are equal apart from the names of list items.
fn same_type(found: &DataType, expected: &DataType) -> bool {
    match (found, expected) {
        (DataType::List(a), DataType::List(b)) => a.data_type() == b.data_type(),
        (DataType::FixedSizeList(a, n), DataType::FixedSizeList(b, m)) => n == m && a.data_type() == b.data_type(),
        _ => found == expected,
    }
}

impl<T: Value> RowValues<'_, T> {
    /// Value of a row.
    ///
    /// # Errors
    /// `dataset-damaged`: the row has no such value, such as null or NaN.
    pub fn at(&self, row: usize) -> Result<T> {
        T::read(self.array.as_ref(), row).ok_or_else(|| {
            let what = format!("column `{}` has no {} in row {row}", self.name, T::KIND.words());
            damaged(self.path, &what, "null, NaN, or out of range")
        })
    }
}

impl RowValues<'_, String> {
    /// Text of a row; empty for null.
    pub fn text(&self, row: usize) -> &str {
        let texts = self.array.as_string_opt::<i32>().filter(|texts| texts.is_valid(row));
        texts.map_or("", |texts| texts.value(row))
    }
}
