//! A compiled plugin: kind, description, limits.

use crate::imports::OFFERED;
use crate::interface_0_1::{Metadata, PACKAGE, VERSION, is_same_track};
use crate::kind::Kind;
use crate::limits::PluginLimits;
use crate::sandbox::Guest;
use cosfly_fingerprint::Digest;
use std::sync::Arc;
use wasmtime::Engine;
use wasmtime::component::{Component, InstancePre};

/// The compiled code of a file.
pub(crate) struct Compiled {
    pub(crate) engine: Engine,
    pub(crate) code: Code,
}

/// The form of compiled code.
pub(crate) enum Code {
    /// A component.
    Component(InstancePre<Guest>),
    /// A cost term in a core module, which is called directly: sooner.
    Module(wasmtime::InstancePre<Guest>),
}

/// A plugin, ready to be opened as often as wanted.
#[derive(Clone)]
pub struct Plugin {
    /// The file, as the user wrote it.
    pub shown: String,
    /// The digest of the file.
    pub digest: Digest,
    /// The kind that it is used as.
    pub kind: Kind,
    /// Limits of memory and time.
    pub limits: PluginLimits,
    /// The description that it gives.
    pub metadata: Metadata,
    pub(crate) compiled: Arc<Compiled>,
}

/// The kinds that a component is.
pub(crate) fn kinds_of(component: &Component) -> Vec<Kind> {
    Kind::ALL.into_iter().filter(|kind| component.get_export_index(None, kind.interface().as_str()).is_some()).collect()
}

/// Why a component is not of the wanted kind: the interfaces that it exports and the ones that it should.
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
        base == "cosfly:plugin/types" || name.starts_with("wasi:") || (offered && is_same_track(name))
    };
    let component_type = component.component_type();
    component_type.imports(engine).map(|(name, _)| name.to_owned()).find(|name| !is_known(name))
}
