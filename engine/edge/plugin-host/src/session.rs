//! One instance of a component: its functions, called within the limits of a sandbox.

use crate::failure::PluginError;
use crate::plugin::{Code, Plugin};
use crate::sandbox::{Said, Sandbox};
use crate::town::TownView;
use std::sync::Arc;
use wasmtime::component::{ComponentExportIndex, ComponentNamedList, Instance, Lift, Lower, TypedFunc};

/// An instance of a plugin.
pub struct Session {
    sandbox: Sandbox,
    instance: Instance,
    interface: ComponentExportIndex,
}

impl Session {
    /// A new instance of `plugin` that sees `town`.
    ///
    /// # Errors
    /// The failure while it started.
    pub fn open(plugin: &Plugin, town: Arc<dyn TownView>) -> Result<Self, PluginError> {
        let refused = |message: String| PluginError::refused(&plugin.shown, message);
        let Code::Component(component) = &plugin.compiled.code else {
            return Err(refused("it is not compiled as a component".to_owned()));
        };
        let mut sandbox = Sandbox::new(&plugin.compiled.engine, &plugin.shown, plugin.limits, town);
        let instance = sandbox.within("start", |store| component.instantiate(store))?;
        let interface = instance.get_export_index(sandbox.store(), None, plugin.kind.interface().as_str());
        let interface = interface.ok_or_else(|| refused(format!("it has no `{}`", plugin.kind.interface())))?;
        Ok(Self { sandbox, instance, interface })
    }

    /// A function of its interface.
    ///
    /// # Errors
    /// When the export is missing, or has another type than the interface's.
    pub fn function<P, R>(&mut self, name: &'static str) -> Result<TypedFunc<P, R>, PluginError>
    where
        P: ComponentNamedList + Lower,
        R: ComponentNamedList + Lift,
    {
        let refused = |sandbox: &Sandbox, message: String| PluginError::refused(sandbox.shown(), message);
        let index = self.instance.get_export_index(self.sandbox.store(), Some(&self.interface), name);
        let index = index.ok_or_else(|| refused(&self.sandbox, format!("it has no function `{name}`")))?;
        self.instance.get_typed_func(self.sandbox.store(), index).map_err(|error| {
            refused(&self.sandbox, format!("its `{name}` is another one than the interface's: {error:#}"))
        })
    }

    /// Calls a function within the limits.
    ///
    /// # Errors
    /// The limit that it met, or how it trapped. After that, every call fails.
    pub fn call<P, R>(&mut self, name: &'static str, function: &TypedFunc<P, R>, given: P) -> Result<R, PluginError>
    where
        P: ComponentNamedList + Lower,
        R: ComponentNamedList + Lift,
    {
        self.sandbox.within(name, |store| function.call(store, given))
    }

    /// The sandbox that it runs in.
    pub(crate) fn sandbox(&self) -> &Sandbox {
        &self.sandbox
    }

    /// All messages so far.
    pub fn said(&self) -> Vec<Said> {
        self.sandbox.said()
    }

    /// The messages that users are to read.
    pub fn warnings(&self) -> Vec<String> {
        self.sandbox.warnings()
    }
}
