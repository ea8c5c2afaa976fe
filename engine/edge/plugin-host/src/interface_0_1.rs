//! Version 0.1 of the interface: names and records as in `plugins/wit`.

use wasmtime::component::{ComponentType, Lift, Lower};

/// The texts of the interface, for modules that carry none.
pub const WIT: [(&str, &str); 5] = [
    ("types.wit", include_str!("../../../../plugins/wit/types.wit")),
    ("host.wit", include_str!("../../../../plugins/wit/host.wit")),
    ("cost-term.wit", include_str!("../../../../plugins/wit/cost-term.wit")),
    ("objective.wit", include_str!("../../../../plugins/wit/objective.wit")),
    ("stage.wit", include_str!("../../../../plugins/wit/stage.wit")),
];
/// Package of all its interfaces.
pub const PACKAGE: &str = "cosfly:plugin/";
/// Its version.
pub const VERSION: &str = "0.1.0";

/// What a plugin says of itself.
#[derive(Clone, Debug, PartialEq, Eq, ComponentType, Lift)]
#[component(record)]
pub struct Metadata {
    /// Name in tables and messages.
    pub name: String,
    /// Its own version.
    pub version: String,
    /// One sentence.
    pub summary: String,
    /// JSON Schema of its parameters; empty when it has none.
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
    /// Beyond the plugin.
    #[component(name = "unsupported")]
    Unsupported(String),
    /// Anything else.
    #[component(name = "failed")]
    Failed(String),
}

impl Refusal {
    /// In words.
    pub fn words(&self) -> String {
        match self {
            Self::InvalidParams(words) => format!("parameters: {words}"),
            Self::Unsupported(words) => format!("unsupported: {words}"),
            Self::Failed(words) => words.clone(),
        }
    }
}

/// Numbers beside the fixed ones.
#[derive(Clone, Debug, PartialEq, ComponentType, Lower)]
#[component(record)]
pub struct Channel {
    /// Name.
    pub name: String,
    /// Numbers per frame.
    pub width: u32,
    /// The numbers.
    pub data: Vec<f64>,
}

/// What a configured cost term is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ComponentType, Lift)]
#[component(record)]
pub struct TermShape {
    /// Neighbours that the cost of a waypoint reads, on each side.
    pub support: u32,
    /// Whether gradients are given when asked for.
    pub gradients: bool,
}

/// What stays the same while a flight is planned.
#[derive(Clone, Debug, PartialEq, ComponentType, Lower)]
#[component(record)]
pub struct RunContext {
    /// Of the item.
    pub seed: u64,
    /// Seconds between frames.
    pub dt: f64,
    /// Feet, 3 per frame.
    pub targets: Vec<f64>,
    /// Radians, one per frame.
    pub headings: Vec<f64>,
    /// Walking directions, 2 per frame.
    pub directions: Vec<f64>,
    /// Points of the body, 24 per frame.
    #[component(name = "body-points")]
    pub body_points: Vec<f64>,
    /// None.
    pub channels: Vec<Channel>,
}

/// Costs and gradients.
#[derive(Clone, Debug, PartialEq, ComponentType, Lift)]
#[component(record)]
pub struct Evaluation {
    /// One per waypoint.
    pub costs: Vec<f64>,
    /// Three per waypoint, or none.
    pub gradients: Vec<f64>,
}

/// Where a flight is to be.
#[derive(Clone, Debug, PartialEq, ComponentType, Lower)]
#[component(record)]
pub struct SiteContext {
    /// Of the item.
    pub seed: u64,
    /// Seconds between steps.
    pub dt: f64,
    /// Most steps.
    #[component(name = "max-steps")]
    pub max_steps: u32,
    /// Smallest x and y, largest x and y.
    pub bounds: Vec<f64>,
    /// Metres.
    pub clearance: f64,
    /// Metres per second.
    #[component(name = "max-speed")]
    pub max_speed: f64,
    /// None.
    pub channels: Vec<Channel>,
}

/// The reference of an objective.
#[derive(Clone, Debug, PartialEq, ComponentType, Lift)]
#[component(record)]
pub struct Plan {
    /// Three per step.
    pub watched: Vec<f64>,
    /// Three per step.
    pub places: Vec<f64>,
    /// One per step.
    pub pull: Vec<f64>,
    /// Names and values.
    pub notes: Vec<(String, String)>,
}

/// What a column holds.
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
    /// Truths.
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
    /// As in the interface.
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

/// A column that a stage reads or gives.
#[derive(Clone, Debug, PartialEq, Eq, ComponentType, Lift)]
#[component(record)]
pub struct Column {
    /// Name.
    pub name: String,
    /// What it holds.
    pub kind: ValueKind,
    /// What it means.
    pub doc: String,
}

/// What becomes of a stage's answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ComponentType, Lift)]
#[component(enum)]
#[repr(u8)]
pub enum Effect {
    /// Keeps or rejects flights.
    #[component(name = "filter")]
    Filter,
    /// Labels their frames.
    #[component(name = "label")]
    Label,
    /// One row about each, in a table of the dataset.
    #[component(name = "annotate")]
    Annotate,
    /// Any number of rows.
    #[component(name = "rows")]
    Rows,
    /// Files of the dataset.
    #[component(name = "files")]
    Files,
}

impl Effect {
    /// What has this effect, in words.
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

/// What a configured stage reads and gives.
#[derive(Clone, Debug, PartialEq, Eq, ComponentType, Lift)]
#[component(record)]
pub struct Declaration {
    /// What becomes of its answers.
    pub effect: Effect,
    /// Table or folder of the dataset; empty where there is none.
    pub name: String,
    /// The columns that it reads.
    pub reads: Vec<Column>,
    /// The columns that it gives.
    pub gives: Vec<Column>,
}

/// How serious a message is.
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
