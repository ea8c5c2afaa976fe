//! Where a plugin runs: a store with limits. Every call has a deadline, and after a trap there is no further one.

use crate::direct_abi::DirectAbi;
use crate::failure::PluginError;
use crate::interface_0_1::Severity;
use crate::limits::PluginLimits;
use crate::town::TownView;
use cosfly_diagnose::visible_text;
use std::sync::Arc;
use std::time::Duration;
use wasmtime::{Engine, ResourceLimiter, Store, Trap};

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

/// Instructions of a call, where they are counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Effort {
    /// Instructions of the last call.
    pub fuel: u64,
    /// Memory in use, bytes.
    pub memory_bytes: usize,
}

/// State of one instance.
pub struct Guest {
    pub(crate) town: Arc<dyn TownView>,
    said: Vec<(Severity, String)>,
    memory_limit: usize,
    memory: usize,
    /// Memory that was asked for and not given, bytes.
    denied: Option<usize>,
    /// How host functions answer a core module.
    pub(crate) abi: Option<DirectAbi>,
}

impl Guest {
    pub(crate) fn say(&mut self, severity: Severity, text: &str) {
        if self.said.len() < MAX_MESSAGES {
            let text: String = text.chars().take(MAX_MESSAGE_CHARS).collect();
            self.said.push((severity, visible_text(&text)));
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
pub struct Sandbox {
    store: Store<Guest>,
    shown: String,
    ticks: u64,
    limits: PluginLimits,
    fuel_used: u64,
    /// Whether a call failed: nothing more is called then.
    is_over: bool,
}

impl Sandbox {
    /// An empty one for the plugin that is called `shown`.
    pub(crate) fn new(engine: &Engine, shown: &str, limits: PluginLimits, town: Arc<dyn TownView>) -> Self {
        let memory_limit = limits.memory_bytes();
        let guest = Guest { town, said: Vec::new(), memory_limit, memory: 0, denied: None, abi: None };
        let mut store = Store::new(engine, guest);
        store.limiter(|guest| guest);
        let ticks = u64::from(limits.call_ms).div_ceil(TICK.as_millis() as u64) + 1;
        Self { store, shown: shown.to_owned(), ticks, limits, fuel_used: 0, is_over: false }
    }

    /// Does `what`, the function `name` of the plugin, within the limits.
    ///
    /// # Errors
    /// The limit that it met, or how it trapped. After that, everything fails.
    #[inline]
    pub(crate) fn within<R>(
        &mut self,
        name: &'static str,
        what: impl FnOnce(&mut Store<Guest>) -> wasmtime::Result<R>,
    ) -> Result<R, PluginError> {
        if self.is_over {
            return Err(PluginError::failed(&self.shown, name, "it is disabled after an earlier failure"));
        }
        self.store.set_epoch_deadline(self.ticks);
        let fuel = self.limits.fuel;
        if fuel > 0 && self.store.set_fuel(fuel).is_err() {
            return Err(PluginError::failed(&self.shown, name, "its instructions cannot be counted"));
        }
        let outcome = what(&mut self.store);
        if fuel > 0 {
            self.fuel_used = fuel - self.store.get_fuel().unwrap_or(0);
        }
        outcome.map_err(|error| {
            self.is_over = true;
            self.classify(name, &error)
        })
    }

    /// Its store, to look things up.
    pub(crate) fn store(&mut self) -> &mut Store<Guest> {
        &mut self.store
    }

    /// The file, as the user wrote it.
    pub(crate) fn shown(&self) -> &str {
        &self.shown
    }

    /// Instructions of the last call.
    pub(crate) fn effort(&self) -> Effort {
        Effort { fuel: self.fuel_used, memory_bytes: self.store.data().memory }
    }

    /// Messages so far.
    pub(crate) fn said(&self) -> Vec<Said> {
        let said = self.store.data().said.iter();
        said.map(|(severity, text)| Said { severity: severity_name(*severity), text: text.clone() }).collect()
    }

    /// Messages to users.
    pub(crate) fn warnings(&self) -> Vec<String> {
        let said = self.store.data().said.iter().filter(|(severity, _)| *severity >= Severity::Warn);
        said.map(|(_, text)| text.clone()).collect()
    }

    fn classify(&self, function: &'static str, error: &wasmtime::Error) -> PluginError {
        let guest = self.store.data();
        let failed = |message: String| PluginError::failed(&self.shown, function, message);
        if let Some(bytes) = guest.denied {
            let message =
                format!("it asked for {} MiB of memory; its limit is {} MiB", bytes >> 20, self.limits.memory_mib);
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
            Trap::Interrupt => failed(format!("it did not finish within {} ms", self.limits.call_ms))
                .hint("raise `limits.call_ms` if that is what it needs"),
            Trap::OutOfFuel => failed(format!("it used more than {} instructions", self.limits.fuel))
                .hint("`cosfly plugin check` shows what it uses; raise `limits.fuel` if that is what it needs"),
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

fn severity_name(severity: Severity) -> &'static str {
    match severity {
        Severity::Debug => "debug",
        Severity::Info => "info",
        Severity::Warn => "warn",
        Severity::Error => "error",
    }
}
