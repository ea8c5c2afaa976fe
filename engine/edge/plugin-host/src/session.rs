//! One instance of a plugin with its limits: every call has a deadline, and after a trap there is no further one.

use crate::failure::PluginError;
use crate::interface_0_1::Severity;
use crate::plugin::Plugin;
use crate::town::TownView;
use std::sync::Arc;
use std::time::Duration;
use wasmtime::component::{ComponentExportIndex, ComponentNamedList, Instance, Lift, Lower, TypedFunc};
use wasmtime::{ResourceLimiter, Store, Trap};

/// How often deadlines are looked at.
pub(crate) const TICK: Duration = Duration::from_millis(10);
/// Most elements of all tables together.
const MAX_TABLE_ELEMENTS: usize = 100_000;
/// Most messages that are kept, and their greatest length.
const MAX_MESSAGES: usize = 100;
const MAX_MESSAGE_CHARS: usize = 2000;

/// A message of a plugin.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Said {
    /// `debug`, `info`, `warn` or `error`.
    pub severity: &'static str,
    /// In its words.
    pub text: String,
}

/// What a call took, where instructions are counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Effort {
    /// Instructions of the last call.
    pub fuel: u64,
    /// Memory in use, bytes.
    pub memory_bytes: usize,
}

/// What belongs to one instance.
pub struct Guest {
    pub(crate) town: Arc<dyn TownView>,
    said: Vec<(Severity, String)>,
    memory_limit: usize,
    memory: usize,
    /// Memory that was asked for and not given, bytes.
    denied: Option<usize>,
}

impl Guest {
    pub(crate) fn say(&mut self, severity: Severity, text: &str) {
        if self.said.len() < MAX_MESSAGES {
            self.said.push((severity, text.chars().take(MAX_MESSAGE_CHARS).collect()));
        }
    }
}

impl ResourceLimiter for Guest {
    fn memory_growing(&mut self, current: usize, desired: usize, _: Option<usize>) -> wasmtime::Result<bool> {
        let total = self.memory.saturating_add(desired - current);
        if total > self.memory_limit {
            self.denied = Some(total);
            return Ok(false);
        }
        self.memory = total;
        Ok(true)
    }

    fn table_growing(&mut self, _: usize, desired: usize, _: Option<usize>) -> wasmtime::Result<bool> {
        Ok(desired <= MAX_TABLE_ELEMENTS)
    }
}

/// See the module.
pub struct Session {
    store: Store<Guest>,
    instance: Instance,
    interface: ComponentExportIndex,
    shown: String,
    ticks: u64,
    call_ms: u32,
    /// Instructions per call; 0 does not count.
    fuel: u64,
    fuel_used: u64,
    /// Whether a call failed: nothing more is called then.
    is_over: bool,
}

impl Session {
    /// A new instance of `plugin` that sees `town`.
    ///
    /// # Errors
    /// What it did wrong while it started.
    pub fn open(plugin: &Plugin, town: Arc<dyn TownView>) -> Result<Self, PluginError> {
        let limits = plugin.limits;
        let guest = Guest { town, said: Vec::new(), memory_limit: limits.memory_bytes(), memory: 0, denied: None };
        let mut store = Store::new(&plugin.compiled.engine, guest);
        store.limiter(|guest| guest);
        let ticks = u64::from(limits.call_ms).div_ceil(TICK.as_millis() as u64) + 1;
        store.set_epoch_deadline(ticks);
        if limits.fuel > 0 {
            store.set_fuel(limits.fuel).map_err(|error| PluginError::refused(&plugin.shown, format!("{error:#}")))?;
        }
        let (call_ms, fuel) = (limits.call_ms, limits.fuel);
        let instance = plugin.compiled.ready.instantiate(&mut store).map_err(|error| {
            let what = Failing { shown: &plugin.shown, call_ms, fuel, memory_mib: limits.memory_mib };
            what.classify("start", &error, store.data())
        })?;
        let interface = instance.get_export_index(&mut store, None, plugin.kind.interface().as_str());
        let missing = || PluginError::refused(&plugin.shown, format!("it has no `{}`", plugin.kind.interface()));
        let interface = interface.ok_or_else(missing)?;
        let shown = plugin.shown.clone();
        Ok(Self { store, instance, interface, shown, ticks, call_ms, fuel, fuel_used: 0, is_over: false })
    }

    /// A function of its interface.
    ///
    /// # Errors
    /// When there is none, or it is another one than the interface's.
    pub fn function<P, R>(&mut self, name: &'static str) -> Result<TypedFunc<P, R>, PluginError>
    where
        P: ComponentNamedList + Lower,
        R: ComponentNamedList + Lift,
    {
        let index = self.instance.get_export_index(&mut self.store, Some(&self.interface), name);
        let index = index.ok_or_else(|| PluginError::refused(&self.shown, format!("it has no function `{name}`")))?;
        self.instance.get_typed_func(&mut self.store, index).map_err(|error| {
            PluginError::refused(&self.shown, format!("its `{name}` is another one than the interface's: {error:#}"))
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
        if self.is_over {
            return Err(PluginError::failed(&self.shown, name, "it is disabled after an earlier failure"));
        }
        self.store.set_epoch_deadline(self.ticks);
        if self.fuel > 0 && self.store.set_fuel(self.fuel).is_err() {
            return Err(PluginError::failed(&self.shown, name, "its instructions cannot be counted"));
        }
        let outcome = function.call(&mut self.store, given);
        if self.fuel > 0 {
            self.fuel_used = self.fuel - self.store.get_fuel().unwrap_or(0);
        }
        outcome.map_err(|error| {
            self.is_over = true;
            let memory_mib = (self.store.data().memory_limit >> 20) as u32;
            let what = Failing { shown: &self.shown, call_ms: self.call_ms, fuel: self.fuel, memory_mib };
            what.classify(name, &error, self.store.data())
        })
    }

    /// The file, as the user wrote it.
    pub fn shown(&self) -> &str {
        &self.shown
    }

    /// What the last call took.
    pub fn effort(&self) -> Effort {
        Effort { fuel: self.fuel_used, memory_bytes: self.store.data().memory }
    }

    /// What it said so far.
    pub fn said(&self) -> Vec<Said> {
        let said = self.store.data().said.iter();
        said.map(|(severity, text)| Said { severity: severity_name(*severity), text: text.clone() }).collect()
    }

    /// What it said that users are to read.
    pub fn warnings(&self) -> Vec<String> {
        let said = self.store.data().said.iter().filter(|(severity, _)| *severity >= Severity::Warn);
        said.map(|(_, text)| text.clone()).collect()
    }
}

fn severity_name(severity: Severity) -> &'static str {
    match severity {
        Severity::Debug => "debug",
        Severity::Info => "info",
        Severity::Warn => "warn",
        Severity::Error => "error",
    }
}

/// Whose failure is put into words.
struct Failing<'a> {
    shown: &'a str,
    call_ms: u32,
    fuel: u64,
    memory_mib: u32,
}

impl Failing<'_> {
    fn classify(&self, function: &'static str, error: &wasmtime::Error, guest: &Guest) -> PluginError {
        let failed = |message: String| PluginError::failed(self.shown, function, message);
        if let Some(bytes) = guest.denied {
            let message = format!("it asked for {} MiB of memory; its limit is {} MiB", bytes >> 20, self.memory_mib);
            return failed(message).hint("raise `limits.memory_mib` if that is what it needs");
        }
        let words = format!("{error:#}");
        let Some(trap) = error.downcast_ref::<Trap>() else {
            return match words.split("unknown import: `").nth(1).and_then(|rest| rest.split('`').next()) {
                Some(name) => {
                    failed(format!("it called `{name}`; plugins have no clock, files, chance or environment"))
                }
                None => failed(error.root_cause().to_string()),
            };
        };
        match trap {
            Trap::Interrupt => failed(format!("it did not finish within {} ms", self.call_ms))
                .hint("raise `limits.call_ms` if that is what it needs"),
            Trap::OutOfFuel => failed(format!("it used more than {} instructions", self.fuel))
                .hint("`cosfly plugin bench` shows what it uses; raise `limits.fuel` if that is what it needs"),
            Trap::StackOverflow => failed("its stack is full; often that is endless recursion".to_owned()),
            Trap::MemoryOutOfBounds => {
                failed("it read or wrote outside its memory; often that is endless recursion".to_owned())
            }
            other => match guest.said.iter().rev().find(|(severity, _)| *severity == Severity::Error) {
                Some((_, text)) => failed(text.clone()),
                None => failed(other.to_string().trim_start_matches("wasm trap: ").to_owned()),
            },
        }
    }
}
