//! A compiled plugin: what it is, what it says of itself, what it may use.

use crate::imports::OFFERED;
use crate::interface_0_1::{Metadata, PACKAGE, VERSION};
use crate::limits::PluginLimits;
use crate::sandbox::Guest;
use cosfly_fingerprint::Digest;
use std::sync::Arc;
use wasmtime::Engine;
use wasmtime::component::{Component, InstancePre};

/// The three things that a plugin can be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// A cost term of the planner.
    CostTerm,
    /// An objective.
    Objective,
    /// A stage.
    Stage,
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::CostTerm, Self::Objective, Self::Stage];

    /// Its world, as on the command line.
    pub fn world(self) -> &'static str {
        match self {
            Self::CostTerm => "cost-term",
            Self::Objective => "objective",
            Self::Stage => "stage",
        }
    }

    /// The interface that it exports.
    pub fn interface(self) -> String {
        let name = match self {
            Self::CostTerm => "cost",
            Self::Objective => "reference",
            Self::Stage => "tables",
        };
        format!("{PACKAGE}{name}@{VERSION}")
    }

    /// What it is, in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::CostTerm => "a cost term",
            Self::Objective => "an objective",
            Self::Stage => "a stage",
        }
    }
}

/// What is compiled once, whatever its limits.
pub(crate) struct Compiled {
    pub(crate) engine: Engine,
    pub(crate) code: Code,
}

/// In which form it is compiled.
pub(crate) enum Code {
    /// As a component.
    Component(InstancePre<Guest>),
    /// A cost term, as the core module that it is in its file: calls are quicker.
    Module(wasmtime::InstancePre<Guest>),
}

/// A plugin, ready to be opened as often as wanted.
#[derive(Clone)]
pub struct Plugin {
    /// The file, as the user wrote it.
    pub shown: String,
    /// Of the file's bytes.
    pub digest: Digest,
    /// What it is used as.
    pub kind: Kind,
    /// What it may use.
    pub limits: PluginLimits,
    /// What it says of itself.
    pub metadata: Metadata,
    pub(crate) compiled: Arc<Compiled>,
}

/// Which kinds a component is; or what it exports instead.
pub(crate) fn kinds_of(component: &Component) -> Vec<Kind> {
    Kind::ALL.into_iter().filter(|kind| component.get_export_index(None, kind.interface().as_str()).is_some()).collect()
}

/// What a component that is not of the wanted kind should be told.
pub(crate) fn wrong_kind(component: &Component, engine: &Engine, wanted: Option<Kind>) -> String {
    let found = kinds_of(component);
    if let (Some(wanted), Some(found)) = (wanted, found.first()) {
        return format!("it is {}; {} is wanted here", found.words(), wanted.words());
    }
    let component_type = component.component_type();
    let exports: Vec<&str> = component_type.exports(engine).map(|(name, _)| name).collect();
    let wanted = wanted.map_or_else(|| format!("`{PACKAGE}cost`, `reference` or `tables`"), |it| it.interface());
    match exports.iter().find(|name| name.starts_with(PACKAGE)) {
        Some(other) => format!("it exports `{other}`; this cosfly runs version {VERSION} of the interface: {wanted}"),
        None if exports.is_empty() => format!("it exports nothing; {wanted} is wanted"),
        None => format!("it exports `{}`; {wanted} is wanted", exports.join("`, `")),
    }
}

/// An import that is neither offered nor of WASI (which libraries bring along without calling it).
pub(crate) fn foreign_import(component: &Component, engine: &Engine) -> Option<String> {
    let is_known = |name: &str| {
        let base = name.split('@').next().unwrap_or(name);
        let offered = OFFERED.iter().any(|offered| offered.split('@').next() == Some(base));
        base == "cosfly:plugin/types" || name.starts_with("wasi:") || (offered && same_track(name))
    };
    let component_type = component.component_type();
    component_type.imports(engine).map(|(name, _)| name.to_owned()).find(|name| !is_known(name))
}

/// Whether a versioned name is of the track 0.1.
fn same_track(name: &str) -> bool {
    name.split('@').nth(1).is_none_or(|version| version.starts_with("0.1."))
}
