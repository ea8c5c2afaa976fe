//! Stages: a trait for authors, and the functions and tables of the interface behind it.

use crate::abi::{Answer as Told, Refusal};
use crate::arrow_stream::{self, Values};
use crate::running::Running;
use crate::{Flight, Metadata, Params};

/// The type of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// 64-bit floats.
    Real,
    /// 64-bit integers.
    Integer,
    /// True or false.
    Boolean,
    /// Texts.
    Text,
}

/// A column that a stage reads or gives.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// `a-z`, `0-9` and `_`.
    pub name: String,
    /// The type.
    pub kind: Kind,
    /// The meaning, with the unit; for columns of answers only.
    pub doc: String,
}

impl Column {
    /// A column of floats.
    pub fn real(name: &str, doc: &str) -> Self {
        Self { name: name.to_owned(), kind: Kind::Real, doc: doc.to_owned() }
    }

    /// A column of integers.
    pub fn integer(name: &str, doc: &str) -> Self {
        Self { kind: Kind::Integer, ..Self::real(name, doc) }
    }

    /// A column of booleans.
    pub fn boolean(name: &str, doc: &str) -> Self {
        Self { kind: Kind::Boolean, ..Self::real(name, doc) }
    }

    /// A column of texts.
    pub fn text(name: &str, doc: &str) -> Self {
        Self { kind: Kind::Text, ..Self::real(name, doc) }
    }
}

/// Columns of floats that a stage reads.
pub fn reals<const N: usize>(names: [&str; N]) -> Vec<Column> {
    names.map(|name| Column::real(name, "")).into()
}

/// The kind of answer that a stage gives to each flight.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Gives {
    /// Whether the flight is kept: [`Answer::Keep`] or [`Answer::Reject`].
    Verdict,
    /// Labels of its frames, columns of floats: [`Answer::Labels`].
    Labels(Vec<Column>),
    /// One row about it, in the dataset's table of this name: [`Answer::Row`].
    Annotation(&'static str, Vec<Column>),
    /// Rows about it, in the dataset's table of this name: [`Answer::Rows`].
    Rows(&'static str, Vec<Column>),
    /// Files, in the dataset's folder `extras/NAME`: [`Answer::Files`].
    Files(&'static str),
}

/// A value of a row.
#[derive(Clone, Debug, PartialEq)]
#[expect(missing_docs, reason = "each holds what its kind is called after")]
pub enum Value {
    Real(f64),
    Integer(i64),
    Boolean(bool),
    Text(String),
}

macro_rules! values {
    ($($from:ty => |$value:ident| $made:expr),* $(,)?) => {$(
        impl From<$from> for Value {
            fn from($value: $from) -> Self {
                $made
            }
        }
    )*};
}

values! {
    f64 => |value| Value::Real(value),
    i64 => |value| Value::Integer(value),
    usize => |value| Value::Integer(value as i64),
    bool => |value| Value::Boolean(value),
    String => |value| Value::Text(value),
    &str => |value| Value::Text(value.to_owned()),
}

/// A file for the dataset.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct File {
    /// Where in the flight's own folder, such as `camera.txt`.
    pub path: String,
    /// The content.
    pub content: Vec<u8>,
}

/// The answer of a stage to a flight.
#[derive(Clone, Debug, PartialEq)]
pub enum Answer {
    /// The flight is kept.
    Keep,
    /// The flight is rejected, for this reason.
    Reject(String),
    /// One number per frame for each label, in the order in which they are declared.
    Labels(Vec<Vec<f64>>),
    /// One value per column, in the order in which they are declared.
    Row(Vec<Value>),
    /// Any number of such rows.
    Rows(Vec<Vec<Value>>),
    /// Files.
    Files(Vec<File>),
}

/// A stage.
pub trait Stage: Sized + 'static {
    /// The parameters; [`NoParams`](crate::NoParams) for none.
    type Params: Params;

    /// Name, version and purpose.
    fn describe() -> Metadata;
    /// A configured stage.
    ///
    /// # Errors
    /// Parameters that contradict each other.
    fn new(params: Self::Params) -> Result<Self, String>;
    /// The columns that it reads; `plugins/wit/stage.wit` lists what there is. Another one is refused before anything runs.
    fn reads(&self) -> Vec<Column>;
    /// The kind of answer that it gives to each flight.
    fn gives(&self) -> Gives;
    /// Looks at a flight.
    ///
    /// # Errors
    /// Why it gives up; the item fails with these words.
    fn run(&self, flight: &Flight) -> Result<Answer, String>;
}

/// Numbers of kinds in the interface; [`Kind`] has the first ones.
const BYTES: usize = 4;

impl<T: Stage> Running<T> {
    pub fn configure_stage(&mut self, text: &str) -> Told {
        let declared = self.put(text, T::new).map(|stage| (stage.gives(), stage.reads()));
        Told::outcome(declared, |all, (gives, reads)| {
            let (effect, name, gives): (usize, &str, Vec<(Column, usize)>) = match gives {
                Gives::Verdict => {
                    let keep = Column::boolean("keep", "whether it is kept");
                    (0, "", numbered(vec![keep, Column::text("reason", "why not")]))
                }
                Gives::Labels(columns) => (1, "", numbered(columns)),
                Gives::Annotation(name, columns) => (2, name, numbered(columns)),
                Gives::Rows(name, columns) => (3, name, numbered(columns)),
                Gives::Files(name) => {
                    let mut gives = numbered(vec![Column::text("path", ""), Column::text("content", "")]);
                    gives[1].1 = BYTES;
                    (4, name, gives)
                }
            };
            let write = |all: Told, (column, kind): (Column, usize)| all.text(column.name).word(kind).text(column.doc);
            all.word(effect).text(name).records(numbered(reads), write).records(gives, write)
        })
    }

    pub fn run(&self, flight: &[u8]) -> Told {
        let answer = self.get().and_then(|stage| answer_of(stage, flight).map_err(Refusal::Failed));
        Told::outcome(answer, Told::list)
    }
}

/// Columns with the numbers of their kinds.
fn numbered(columns: Vec<Column>) -> Vec<(Column, usize)> {
    columns.into_iter().map(|column| (column.kind as usize, column)).map(|(kind, column)| (column, kind)).collect()
}

/// The answer of a stage to a flight, both as Arrow streams.
fn answer_of<T: Stage>(stage: &T, flight: &[u8]) -> Result<Vec<u8>, String> {
    let table = arrow_stream::read(flight)?;
    let item = table.metadata.iter().find(|(name, _)| name == "item").map(|(_, item)| item.clone());
    let (frames, facts, columns) = (table.rows, table.metadata, table.columns);
    let flight = Flight { item: item.unwrap_or_default(), frames, facts, columns };
    let answer = stage.run(&flight)?;
    Ok(arrow_stream::write(&written(answer, stage.gives())?))
}

/// The answer as a table, if it is of the kind that was declared.
fn written(answer: Answer, gives: Gives) -> Result<Vec<(String, Values)>, String> {
    let verdict = |keep: bool, reason: String| {
        vec![("keep".to_owned(), Values::Booleans(vec![keep])), ("reason".to_owned(), Values::Texts(vec![reason]))]
    };
    match (answer, gives) {
        (Answer::Keep, Gives::Verdict) => Ok(verdict(true, String::new())),
        (Answer::Reject(reason), Gives::Verdict) => Ok(verdict(false, reason)),
        (Answer::Labels(labels), Gives::Labels(columns)) if labels.len() == columns.len() => {
            Ok(columns.into_iter().zip(labels).map(|(column, values)| (column.name, Values::Reals(values))).collect())
        }
        (Answer::Row(row), Gives::Annotation(_, columns)) => in_columns(columns, vec![row]),
        (Answer::Rows(rows), Gives::Rows(_, columns)) => in_columns(columns, rows),
        (Answer::Files(files), Gives::Files(_)) => {
            let (paths, contents) = files.into_iter().map(|file| (file.path, file.content)).unzip();
            Ok(vec![("path".to_owned(), Values::Texts(paths)), ("content".to_owned(), Values::Bytes(contents))])
        }
        (answer, gives) => {
            let words = |all: String| all.split(['(', ' ']).next().unwrap_or_default().to_owned();
            let (answer, gives) = (words(format!("{answer:?}")), words(format!("{gives:?}")));
            Err(format!("it answered `{answer}`, which does not fit what it declares, `{gives}`"))
        }
    }
}

fn in_columns(columns: Vec<Column>, rows: Vec<Vec<Value>>) -> Result<Vec<(String, Values)>, String> {
    let empty = |kind: Kind| match kind {
        Kind::Real => Values::Reals(vec![]),
        Kind::Integer => Values::Integers(vec![]),
        Kind::Boolean => Values::Booleans(vec![]),
        Kind::Text => Values::Texts(vec![]),
    };
    let mut all: Vec<(String, Values)> = columns.into_iter().map(|it| (it.name, empty(it.kind))).collect();
    for (number, row) in rows.into_iter().enumerate() {
        if row.len() != all.len() {
            return Err(format!("row {number} has {} values; {} columns are declared", row.len(), all.len()));
        }
        for ((name, values), value) in all.iter_mut().zip(row) {
            match (values, value) {
                (Values::Reals(values), Value::Real(value)) => values.push(value),
                (Values::Integers(values), Value::Integer(value)) => values.push(value),
                (Values::Booleans(values), Value::Boolean(value)) => values.push(value),
                (Values::Texts(values), Value::Text(value)) => values.push(value),
                (_, value) => return Err(format!("`{name}` is {value:?} in row {number}; it is declared otherwise")),
            }
        }
    }
    Ok(all)
}

/// Makes a type that is a [`Stage`](crate::Stage) the plugin of this crate.
#[macro_export]
macro_rules! stage {
    ($stage:ty) => {
        #[cfg(target_family = "wasm")]
        const _: () = {
            use $crate::macros::{RefCell, Running, abi, description, thread_local};
            $crate::border!();
            thread_local! {
                static RUNNING: RefCell<Running<$stage>> = const { RefCell::new(Running::new()) };
            }

            #[unsafe(export_name = "cosfly:plugin/tables@0.1.0#describe")]
            extern "C" fn describe() -> *const usize {
                description::<<$stage as $crate::Stage>::Params>(<$stage as $crate::Stage>::describe()).leave()
            }

            #[unsafe(export_name = "cosfly:plugin/tables@0.1.0#configure")]
            unsafe extern "C" fn configure(text: *mut u8, bytes: usize) -> *const usize {
                // SAFETY: the host keeps to the canonical ABI, here and below.
                let text = unsafe { abi::text(text, bytes) };
                RUNNING.with_borrow_mut(|running| running.configure_stage(&text)).leave()
            }

            #[unsafe(export_name = "cosfly:plugin/tables@0.1.0#run")]
            unsafe extern "C" fn run(flight: *mut u8, bytes: usize) -> *const usize {
                let flight = unsafe { abi::list(flight, bytes) };
                RUNNING.with_borrow(|running| running.run(&flight)).leave()
            }
        };
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_become_columns_of_the_declared_kinds() {
        let columns = vec![Column::real("length_m", ""), Column::text("side", "")];
        let rows = vec![vec![1.5.into(), "left".into()], vec![2.0.into(), "right".into()]];
        let wanted = vec![
            ("length_m".to_owned(), Values::Reals(vec![1.5, 2.0])),
            ("side".to_owned(), Values::Texts(vec!["left".into(), "right".into()])),
        ];
        assert_eq!(in_columns(columns.clone(), rows), Ok(wanted));
        assert!(in_columns(columns.clone(), vec![vec![1.5.into()]]).unwrap_err().contains("1 values; 2 columns"));
        assert!(
            in_columns(columns, vec![vec![true.into(), "a".into()]]).unwrap_err().contains("`length_m` is Boolean")
        );
        let error = written(Answer::Keep, Gives::Labels(vec![])).unwrap_err();
        assert!(error.contains("`Keep`") && error.contains("`Labels`"), "{error}");
    }
}
