//! Stages: a trait for authors, and the tables between it and the interface.

use crate::arrow_stream::{self, Values};
use crate::bindings::stage::exports::cosfly::plugin::tables as wire;
use crate::running::Running;
use crate::{Json, Metadata, Params};

/// What a column holds.
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
    /// What it holds.
    pub kind: Kind,
    /// What it means, with its unit; for what is given only.
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

    /// A column of truths.
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

/// What a stage gives of each flight.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Gives {
    /// Whether it is kept: [`Answer::Keep`] or [`Answer::Reject`].
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

/// A finished flight: facts, and named columns with one value per frame. It holds the columns that the stage reads.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Flight {
    /// Id of the flight.
    pub item: String,
    frames: usize,
    facts: Vec<(String, String)>,
    columns: Vec<(String, Values)>,
}

impl Flight {
    /// A flight of your own with columns of floats, for tests.
    pub fn new(item: &str, columns: &[(&str, &[f64])]) -> Self {
        let frames = columns.first().map_or(0, |(_, values)| values.len());
        let columns = columns.iter().map(|(name, values)| ((*name).to_owned(), Values::Reals(values.to_vec())));
        Self { item: item.to_owned(), frames, facts: vec![], columns: columns.collect() }
    }

    /// The same with a column of integers, for tests.
    pub fn with_integers(mut self, name: &str, values: &[i64]) -> Self {
        self.columns.push((name.to_owned(), Values::Integers(values.to_vec())));
        self
    }

    /// The same with a column of truths, for tests.
    pub fn with_booleans(mut self, name: &str, values: &[bool]) -> Self {
        self.columns.push((name.to_owned(), Values::Booleans(values.to_vec())));
        self
    }

    /// The same with a fact, for tests.
    pub fn with_fact(mut self, name: &str, value: &str) -> Self {
        self.facts.push((name.to_owned(), value.to_owned()));
        self
    }

    /// A fact, such as `trajectory_id`; `plugins/wit/stage.wit` lists them.
    pub fn fact(&self, name: &str) -> Option<&str> {
        self.facts.iter().find(|(known, _)| known == name).map(|(_, value)| value.as_str())
    }

    /// The first instruction in a language, such as `en`; none where no captions are connected.
    pub fn instruction(&self, language: &str) -> Option<String> {
        let Json::List(captions) = Json::parse(self.fact("captions")?).ok()? else { return None };
        let of = |caption: &Json, key: &str| match caption.get(key) {
            Some(Json::Text(text)) => text.clone(),
            _ => String::new(),
        };
        let found = captions.iter().find(|it| of(it, "language") == language && of(it, "style") == "instruction")?;
        Some(of(found, "text"))
    }

    /// A column of floats, such as `visibility`.
    ///
    /// # Errors
    /// That the stage does not read it, and what it reads.
    pub fn column(&self, name: &str) -> Result<&[f64], String> {
        match self.values(name)? {
            Values::Reals(values) => Ok(values),
            _ => Err(format!("`{name}` holds no floats")),
        }
    }

    /// A column of integers, such as `frame`.
    ///
    /// # Errors
    /// As [`Self::column`].
    pub fn integers(&self, name: &str) -> Result<&[i64], String> {
        match self.values(name)? {
            Values::Integers(values) => Ok(values),
            _ => Err(format!("`{name}` holds no integers")),
        }
    }

    /// A column of truths, such as `in_view`.
    ///
    /// # Errors
    /// As [`Self::column`].
    pub fn booleans(&self, name: &str) -> Result<&[bool], String> {
        match self.values(name)? {
            Values::Booleans(values) => Ok(values),
            _ => Err(format!("`{name}` holds no truths")),
        }
    }

    fn values(&self, name: &str) -> Result<&Values, String> {
        match self.columns.iter().find(|(known, _)| known == name) {
            Some((_, values)) => Ok(values),
            None => {
                let known: Vec<&str> = self.columns.iter().map(|(name, _)| name.as_str()).collect();
                Err(format!("it does not read `{name}`; it reads `{}`", known.join("`, `")))
            }
        }
    }

    /// How many frames it has.
    pub fn len(&self) -> usize {
        self.frames
    }

    /// Whether it has none.
    pub fn is_empty(&self) -> bool {
        self.frames == 0
    }
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
    /// What is in it.
    pub content: Vec<u8>,
}

/// What a stage says of a flight.
#[derive(Clone, Debug, PartialEq)]
pub enum Answer {
    /// It is kept.
    Keep,
    /// It is rejected, for this reason.
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
    /// Its parameters; [`NoParams`](crate::NoParams) for none.
    type Params: Params;

    /// What it says of itself.
    fn describe() -> Metadata;
    /// A configured stage.
    ///
    /// # Errors
    /// What of the parameters contradicts itself.
    fn new(params: Self::Params) -> Result<Self, String>;
    /// The columns that it reads; `plugins/wit/stage.wit` lists what there is. Another one is refused before anything runs.
    fn reads(&self) -> Vec<Column>;
    /// What it gives of each flight.
    fn gives(&self) -> Gives;
    /// Looks at a flight.
    ///
    /// # Errors
    /// Why it gives up; the item fails with these words.
    fn run(&self, flight: &Flight) -> Result<Answer, String>;
}

impl<T: Stage> Running<T> {
    pub fn configure_stage(&mut self, text: &str) -> Result<wire::Declaration, wire::Error> {
        let stage = self.put(text, T::new)?;
        let (effect, name, gives) = match stage.gives() {
            Gives::Verdict => {
                let gives = vec![Column::boolean("keep", "whether it is kept"), Column::text("reason", "why not")];
                (wire::Effect::Filter, "", wired(gives))
            }
            Gives::Labels(columns) => (wire::Effect::Label, "", wired(columns)),
            Gives::Annotation(name, columns) => (wire::Effect::Annotate, name, wired(columns)),
            Gives::Rows(name, columns) => (wire::Effect::Rows, name, wired(columns)),
            Gives::Files(name) => {
                let mut gives = wired(vec![Column::text("path", ""), Column::text("content", "")]);
                gives[1].kind = wire::Kind::Bytes;
                (wire::Effect::Files, name, gives)
            }
        };
        Ok(wire::Declaration { effect, name: name.to_owned(), reads: wired(stage.reads()), gives })
    }

    pub fn run(&self, flight: &[u8]) -> Result<Vec<u8>, wire::Error> {
        let stage = self.get()?;
        let table = arrow_stream::read(flight).map_err(wire::Error::Failed)?;
        let item = table.metadata.iter().find(|(name, _)| name == "item").map(|(_, item)| item.clone());
        let (frames, facts, columns) = (table.rows, table.metadata, table.columns);
        let flight = Flight { item: item.unwrap_or_default(), frames, facts, columns };
        let answer = stage.run(&flight).and_then(|answer| written(answer, stage.gives()));
        Ok(arrow_stream::write(&answer.map_err(wire::Error::Failed)?))
    }
}

fn wired(columns: Vec<Column>) -> Vec<wire::Column> {
    let wired = |column: Column| wire::Column {
        name: column.name,
        doc: column.doc,
        kind: match column.kind {
            Kind::Real => wire::Kind::Real,
            Kind::Integer => wire::Kind::Integer,
            Kind::Boolean => wire::Kind::Boolean,
            Kind::Text => wire::Kind::Text,
        },
    };
    columns.into_iter().map(wired).collect()
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
            use $crate::bindings::stage::exports::cosfly::plugin::tables as wire;
            $crate::macros::thread_local! {
                static RUNNING: $crate::macros::RefCell<$crate::macros::Running<$stage>> =
                    const { $crate::macros::RefCell::new($crate::macros::Running::new()) };
            }
            struct Plugin;
            impl wire::Guest for Plugin {
                fn describe() -> wire::Metadata {
                    $crate::macros::Running::<$stage>::describe::<<$stage as $crate::Stage>::Params>(
                        <$stage as $crate::Stage>::describe(),
                    )
                }
                fn configure(params: String) -> Result<wire::Declaration, wire::Error> {
                    RUNNING.with_borrow_mut(|running| running.configure_stage(&params))
                }
                fn run(flight: Vec<u8>) -> Result<Vec<u8>, wire::Error> {
                    RUNNING.with_borrow(|running| running.run(&flight))
        }
            }
            $crate::bindings::stage::export_stage!(Plugin with_types_in $crate::bindings::stage);
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

    #[test]
    fn instructions_are_found_by_their_language() {
        let captions = r#"[{"language":"zh","style":"instruction","text":"跟随"},{"language":"en","style":"instruction","text":"Follow"}]"#;
        let flight = Flight::default().with_fact("captions", captions);
        assert_eq!(flight.instruction("en").as_deref(), Some("Follow"));
        assert_eq!(Flight::default().instruction("en"), None);
    }
}
