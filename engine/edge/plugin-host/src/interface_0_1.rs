//! Version 0.1 of the interface: names and records as in `plugins/wit`.

use cosfly_diagnose::visible_text;
use wasmtime::component::{ComponentType, Lift, Lower};

/// The package of all interfaces.
pub const PACKAGE: &str = "cosfly:plugin/";
/// The version of the interface.
pub const VERSION: &str = "0.1.0";

/// Whether the version in a name, where there is one, is 0.1.x.
pub fn is_same_track(name: &str) -> bool {
    name.split('@').nth(1).is_none_or(|version| version.starts_with("0.1."))
}

/// The description of a plugin.
#[derive(Clone, Debug, PartialEq, Eq, ComponentType, Lift)]
#[component(record)]
pub struct Metadata {
    /// The name in tables and messages.
    pub name: String,
    /// The version of the plugin.
    pub version: String,
    /// The purpose, one sentence.
    pub summary: String,
    /// JSON Schema of the parameters; empty where there are none.
    #[component(name = "params-schema")]
    pub params_schema: String,
}

/// Why a plugin gives up.
#[derive(Clone, Debug, PartialEq, Eq, ComponentType, Lift)]
#[component(variant)]
pub enum Refusal {
    /// Parameters contradict each other.
    #[component(name = "invalid-params")]
    InvalidParams(String),
    /// The task is beyond the plugin.
    #[component(name = "unsupported")]
    Unsupported(String),
    /// Any other reason.
    #[component(name = "failed")]
    Failed(String),
}

impl Refusal {
    /// The reason in words that cannot control a terminal.
    pub fn words(&self) -> String {
        match self {
            Self::InvalidParams(words) => format!("parameters: {}", visible_text(words)),
            Self::Unsupported(words) => format!("unsupported: {}", visible_text(words)),
            Self::Failed(words) => visible_text(words),
        }
    }
}

/// Further numbers for each frame.
#[derive(Clone, Debug, PartialEq, ComponentType, Lower)]
#[component(record)]
pub struct Channel {
    /// The name.
    pub name: String,
    /// Numbers per frame.
    pub width: u32,
    /// The numbers.
    pub data: Vec<f64>,
}

/// Properties of a configured cost term.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ComponentType, Lift)]
#[component(record)]
pub struct TermShape {
    /// Neighbours on each side that the cost of a waypoint reads.
    pub support: u32,
    /// Whether it computes gradients.
    pub gradients: bool,
}

/// The constants of a planned flight; world frame, metres, n frames.
#[derive(Clone, Debug, PartialEq, ComponentType, Lower)]
#[component(record)]
pub struct RunContext {
    /// The seed of the item.
    pub seed: u64,
    /// Seconds between frames.
    pub dt: f64,
    /// Feet of the target, 3n.
    pub targets: Vec<f64>,
    /// Headings of the target, n, radians.
    pub headings: Vec<f64>,
    /// Walking directions, unit vectors, 2n.
    pub directions: Vec<f64>,
    /// Eight points of the body, 24n.
    #[component(name = "body-points")]
    pub body_points: Vec<f64>,
    /// Always empty in 0.1.0.
    pub channels: Vec<Channel>,
}

/// Costs and gradients.
#[derive(Clone, Debug, PartialEq, ComponentType, Lift)]
#[component(record)]
pub struct Evaluation {
    /// One per waypoint.
    pub costs: Vec<f64>,
    /// Three per waypoint, or empty.
    pub gradients: Vec<f64>,
}

/// The place of a flight.
#[derive(Clone, Debug, PartialEq, ComponentType, Lower)]
#[component(record)]
pub struct SiteContext {
    /// The seed of the item.
    pub seed: u64,
    /// Seconds between steps.
    pub dt: f64,
    /// Most steps.
    #[component(name = "max-steps")]
    pub max_steps: u32,
    /// Smallest x and y, largest x and y, metres.
    pub bounds: Vec<f64>,
    /// Distance to obstacles, metres.
    pub clearance: f64,
    /// Largest speed, metres per second.
    #[component(name = "max-speed")]
    pub max_speed: f64,
    /// Always empty in 0.1.0.
    pub channels: Vec<Channel>,
}

/// The reference of an objective.
#[derive(Clone, Debug, PartialEq, ComponentType, Lift)]
#[component(record)]
pub struct Plan {
    /// Points that the camera looks at, three numbers per step, metres.
    pub watched: Vec<f64>,
    /// Wished places of the drone, three numbers per step, metres.
    pub places: Vec<f64>,
    /// Weights of the places, one per step, 0 to 1.
    pub pull: Vec<f64>,
    /// Facts for the summary: names and values.
    pub notes: Vec<(String, String)>,
}

/// The type of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ComponentType, Lift)]
#[component(enum)]
#[repr(u8)]
pub enum ValueKind {
    /// 64-bit floats.
    #[component(name = "real")]
    Real,
    /// 64-bit integers.
    #[component(name = "integer")]
    Integer,
    /// True or false.
    #[component(name = "boolean")]
    Boolean,
    /// Texts.
    #[component(name = "text")]
    Text,
    /// Bytes.
    #[component(name = "bytes")]
    Bytes,
}

impl ValueKind {
    /// The name of the type in the interface.
    pub fn words(self) -> &'static str {
        match self {
            Self::Real => "real",
            Self::Integer => "integer",
            Self::Boolean => "boolean",
            Self::Text => "text",
            Self::Bytes => "bytes",
        }
    }
}

/// A column that a stage reads or writes.
#[derive(Clone, Debug, PartialEq, Eq, ComponentType, Lift)]
#[component(record)]
pub struct Column {
    /// Name.
    pub name: String,
    /// The type.
    pub kind: ValueKind,
    /// The meaning, with the unit.
    pub doc: String,
}

/// The use of a stage's answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ComponentType, Lift)]
#[component(enum)]
#[repr(u8)]
pub enum Effect {
    /// Flights are kept or rejected.
    #[component(name = "filter")]
    Filter,
    /// Frames are labelled.
    #[component(name = "label")]
    Label,
    /// One row per flight in a table of the dataset.
    #[component(name = "annotate")]
    Annotate,
    /// Any number of rows in a table of the dataset.
    #[component(name = "rows")]
    Rows,
    /// Files of the dataset.
    #[component(name = "files")]
    Files,
}

impl Effect {
    /// A stage with this effect, in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Filter => "a filter",
            Self::Label => "a labeller",
            Self::Annotate => "an annotator",
            Self::Rows => "a maker of rows",
            Self::Files => "an exporter of files",
        }
    }
}

/// The columns of a configured stage.
#[derive(Clone, Debug, PartialEq, Eq, ComponentType, Lift)]
#[component(record)]
pub struct Declaration {
    /// The use of the answers.
    pub effect: Effect,
    /// Table or folder of the dataset; empty where there is none.
    pub name: String,
    /// Columns of the flights that are read.
    pub reads: Vec<Column>,
    /// Columns of the answers.
    pub gives: Vec<Column>,
}

/// The severity of a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, ComponentType, Lift)]
#[component(enum)]
#[repr(u8)]
pub enum Severity {
    /// For authors.
    #[component(name = "debug")]
    Debug,
    /// For authors.
    #[component(name = "info")]
    Info,
    /// For users.
    #[component(name = "warn")]
    Warn,
    /// For users.
    #[component(name = "error")]
    Error,
}
