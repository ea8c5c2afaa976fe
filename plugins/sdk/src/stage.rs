//! Stages: a trait for authors, and the Arrow streams between it and the interface.

use crate::arrow_stream::{self, Column};
use crate::bindings::stage::exports::cosfly::plugin::transform as wire;
use crate::{Metadata, Param, Params, params};

/// A finished flight: named columns with one number per frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Flight {
    /// Id of the flight.
    pub item: String,
    columns: Vec<(String, Vec<f64>)>,
}

impl Flight {
    /// A flight of your own, for tests.
    pub fn new(item: &str, columns: &[(&str, &[f64])]) -> Self {
        let columns = columns.iter().map(|(name, values)| ((*name).to_owned(), values.to_vec()));
        Self { item: item.to_owned(), columns: columns.collect() }
    }

    /// A column, such as `visibility`; `plugins/wit/stage.wit` lists them.
    ///
    /// # Errors
    /// That there is none, and which there are.
    pub fn column(&self, name: &str) -> Result<&[f64], String> {
        match self.columns.iter().find(|(known, _)| known == name) {
            Some((_, values)) => Ok(values),
            None => {
                let known: Vec<&str> = self.columns.iter().map(|(name, _)| name.as_str()).collect();
                Err(format!("flights have no column `{name}`; they have `{}`", known.join("`, `")))
            }
        }
    }

    /// How many frames it has.
    pub fn len(&self) -> usize {
        self.columns.first().map_or(0, |(_, values)| values.len())
    }

    /// Whether it has none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// What a stage says of a flight.
#[derive(Clone, Debug, PartialEq)]
pub enum Answer {
    /// It is kept.
    Keep,
    /// It is rejected, for this reason.
    Reject(String),
    /// Labels by name, one number per frame each.
    Labels(Vec<(String, Vec<f64>)>),
}

/// A stage.
pub trait Stage: Sized + 'static {
    /// Its parameters; [`NoParams`](crate::NoParams) for none.
    type Params: Params;
    /// Whether it labels flights; it judges them otherwise.
    const LABELS: bool;

    /// What it says of itself.
    fn describe() -> Metadata;
    /// A configured stage.
    ///
    /// # Errors
    /// What of the parameters contradicts itself.
    fn new(params: Self::Params) -> Result<Self, String>;
    /// Judges or labels a flight.
    ///
    /// # Errors
    /// Why it gives up; the item fails with these words.
    fn run(&self, flight: &Flight) -> Result<Answer, String>;
}

/// A stage at work, behind the interface's functions.
#[doc(hidden)]
pub struct Running<T>(Option<T>);

impl<T: Stage> Running<T> {
    pub const fn new() -> Self {
        Self(None)
    }

    pub fn describe() -> wire::Metadata {
        let told = T::describe();
        wire::Metadata {
            name: told.name.to_owned(),
            version: told.version.to_owned(),
            summary: told.summary.to_owned(),
            params_schema: format!("{{{}}}", T::Params::schema()),
        }
    }

    pub fn configure(&mut self, text: &str) -> Result<wire::Effect, wire::Error> {
        crate::log::panics_as_messages();
        self.0 = Some(params::from_text(text).and_then(T::new).map_err(wire::Error::InvalidParams)?);
        Ok(if T::LABELS { wire::Effect::Label } else { wire::Effect::Filter })
    }

    pub fn run(&self, flight: &[u8]) -> Result<Vec<u8>, wire::Error> {
        let stage = self.0.as_ref().ok_or_else(|| wire::Error::Failed("it was not configured".to_owned()))?;
        let answer = read(flight).and_then(|flight| stage.run(&flight));
        answer.map(written).map_err(wire::Error::Failed)
    }
}

fn read(stream: &[u8]) -> Result<Flight, String> {
    let table = arrow_stream::read(stream)?;
    let item = table.metadata.into_iter().find(|(name, _)| name == "item").map(|(_, item)| item).unwrap_or_default();
    Ok(Flight { item, columns: table.columns })
}

fn written(answer: Answer) -> Vec<u8> {
    let verdict = |keep: bool, reason: String| {
        vec![("keep".to_owned(), Column::Bools(vec![keep])), ("reason".to_owned(), Column::Texts(vec![reason]))]
    };
    arrow_stream::write(&match answer {
        Answer::Keep => verdict(true, String::new()),
        Answer::Reject(reason) => verdict(false, reason),
        Answer::Labels(labels) => {
            labels.into_iter().map(|(name, values)| (name, Column::Reals(values))).collect::<Vec<_>>()
        }
    })
}

/// Makes a type that is a [`Stage`](crate::Stage) the plugin of this crate.
#[macro_export]
macro_rules! stage {
    ($stage:ty) => {
        #[cfg(target_family = "wasm")]
        const _: () = {
            use $crate::bindings::stage::exports::cosfly::plugin::transform as wire;
            $crate::macros::thread_local! {
                static RUNNING: $crate::macros::RefCell<$crate::macros::RunningStage<$stage>> =
                    const { $crate::macros::RefCell::new($crate::macros::RunningStage::new()) };
            }
            struct Plugin;
            impl wire::Guest for Plugin {
                fn describe() -> wire::Metadata {
                    $crate::macros::RunningStage::<$stage>::describe()
                }
                fn configure(params: String) -> Result<wire::Effect, wire::Error> {
                    RUNNING.with_borrow_mut(|running| running.configure(&params))
                }
                fn run(flight: Vec<u8>) -> Result<Vec<u8>, wire::Error> {
                    RUNNING.with_borrow(|running| running.run(&flight))
                }
            }
    $crate::bindings::stage::export_stage!(Plugin with_types_in $crate::bindings::stage);
        };
    };
}
