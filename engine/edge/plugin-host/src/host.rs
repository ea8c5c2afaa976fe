//! The host: engines, and the way from a file to a plugin that can be opened.

use crate::failure::PluginError;
use crate::interface_0_1::Metadata;
use crate::kind::Kind;
use crate::layer::{component_of, is_cost_term};
use crate::limits::PluginLimits;
use crate::plugin::{Code, Compiled, Plugin, foreign_import, kinds_of, wrong_kind};
use crate::sandbox::{Guest, TICK};
use crate::session::Session;
use crate::town::NoTown;
use crate::{compiled_code, direct_term, imports, parameters};
use cosfly_diagnose::visible_text;
use cosfly_fingerprint::Digest;
use std::collections::BTreeMap;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use wasmtime::component::Linker;
use wasmtime::{Config, Engine, Inlining, Module};

/// Largest file that is read as a plugin.
pub const MAX_FILE_BYTES: u64 = 64 * 1024 * 1024;
/// Most stack of a plugin, bytes.
const MAX_STACK_BYTES: usize = 512 * 1024;

/// Compiles plugins and keeps what it compiled.
pub struct Host {
    /// Folder for compiled code.
    folder: Option<PathBuf>,
    plain: OnceLock<Result<Workshop, String>>,
    strict: OnceLock<Result<Workshop, String>>,
    known: Mutex<BTreeMap<KnownKey, Known>>,
}

/// The file, whether it runs in strict mode, and as what.
type KnownKey = (Digest, bool, Kind);
type Known = (Arc<Compiled>, Metadata);

struct Workshop {
    engine: Engine,
    linker: Linker<Guest>,
    direct_linker: wasmtime::Linker<Guest>,
}

impl Host {
    /// A host that keeps compiled code in `folder`, which must be the user's own; without one, every process compiles anew.
    pub fn new(folder: Option<PathBuf>) -> Self {
        Self { folder, plain: OnceLock::new(), strict: OnceLock::new(), known: Mutex::default() }
    }

    /// The plugin in the file at `path`, called `shown` in messages; it must be of kind `wanted`.
    ///
    /// # Errors
    /// Why the file is no such plugin.
    pub fn load(
        &self,
        path: &Path,
        shown: &str,
        wanted: Option<Kind>,
        limits: PluginLimits,
    ) -> Result<Plugin, PluginError> {
        self.load_bytes(&read(path, shown)?, shown, wanted, limits)
    }

    /// [`Self::load`] of bytes that were read before.
    ///
    /// # Errors
    /// Why they are no such plugin.
    pub fn load_bytes(
        &self,
        bytes: &[u8],
        shown: &str,
        wanted: Option<Kind>,
        limits: PluginLimits,
    ) -> Result<Plugin, PluginError> {
        let (digest, strict) = (Digest::of(bytes), limits.is_strict());
        if let Some(kind) = wanted {
            let known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
            if let Some((compiled, metadata)) = known.get(&(digest, strict, kind)) {
                let (compiled, metadata) = (Arc::clone(compiled), metadata.clone());
                return Ok(Plugin { shown: shown.to_owned(), digest, kind, limits, metadata, compiled });
            }
        }
        let (kind, compiled) = self.compile(bytes, digest, shown, wanted, strict)?;
        let unnamed = Metadata {
            name: String::new(),
            version: String::new(),
            summary: String::new(),
            params_schema: String::new(),
        };
        let mut plugin = Plugin { shown: shown.to_owned(), digest, kind, limits, metadata: unnamed, compiled };
        plugin.metadata = describe(&plugin)?;
        let entry = (Arc::clone(&plugin.compiled), plugin.metadata.clone());
        self.known.lock().unwrap_or_else(PoisonError::into_inner).insert((digest, strict, kind), entry);
        Ok(plugin)
    }

    fn compile(
        &self,
        bytes: &[u8],
        digest: Digest,
        shown: &str,
        wanted: Option<Kind>,
        strict: bool,
    ) -> Result<(Kind, Arc<Compiled>), PluginError> {
        let refused = |message: String| PluginError::refused(shown, message);
        let slot = if strict { &self.strict } else { &self.plain };
        let workshop = slot.get_or_init(|| workshop(strict).map_err(|error| format!("{error:#}")));
        let workshop = workshop.as_ref().map_err(|error| refused(format!("plugins cannot run here: {error}")))?;
        let engine = &workshop.engine;
        let folder = self.folder.as_deref();
        let is_term = wanted.is_none_or(|wanted| wanted == Kind::CostTerm);
        let kept: Option<Module> = if is_term { compiled_code::find(engine, folder, digest) } else { None };
        if let Some(module) = kept {
            return workshop.term(&module).map_err(|error| refused(format!("{error:#}")));
        }
        let component = match compiled_code::find(engine, folder, digest) {
            Some(component) => component,
            None => {
                let component = component_of(bytes).map_err(refused)?;
                if is_term && is_cost_term(bytes) {
                    let module = compiled_code::compile(engine, folder, digest, bytes);
                    let module = module.map_err(|error| refused(invalid(&error)))?;
                    return workshop.term(&module).map_err(|error| refused(format!("{error:#}")));
                }
                compiled_code::compile(engine, folder, digest, &component).map_err(|error| refused(invalid(&error)))?
            }
        };
        let kind = kinds_of(&component).into_iter().find(|kind| wanted.is_none_or(|wanted| wanted == *kind));
        let kind = kind.ok_or_else(|| refused(wrong_kind(&component, engine, wanted)))?;
        if let Some(name) = foreign_import(&component, engine) {
            let offered = imports::OFFERED.map(|name| format!("`{name}`")).join(" and ");
            return Err(refused(format!("it imports `{name}`, which this cosfly does not offer"))
                .hint(format!("plugins may import {offered}, nothing else")));
        }
        let mut linker = workshop.linker.clone();
        let ready =
            linker.define_unknown_imports_as_traps(&component).and_then(|()| linker.instantiate_pre(&component));
        let ready = ready.map_err(|error| refused(format!("{error:#}")))?;
        Ok((kind, Arc::new(Compiled { engine: engine.clone(), code: Code::Component(ready) })))
    }
}

impl Workshop {
    /// A cost term that is called as the module that it is.
    fn term(&self, module: &Module) -> wasmtime::Result<(Kind, Arc<Compiled>)> {
        let code = Code::Module(self.direct_linker.instantiate_pre(module)?);
        Ok((Kind::CostTerm, Arc::new(Compiled { engine: self.engine.clone(), code })))
    }
}

/// The compiler's refusal in one line.
fn invalid(error: &wasmtime::Error) -> String {
    let words = format!("{error:#}");
    format!("it is not valid WebAssembly: {}", words.lines().next().unwrap_or_default())
}

fn workshop(strict: bool) -> wasmtime::Result<Workshop> {
    let mut config = Config::new();
    config
        .epoch_interruption(true)
        .compiler_inlining(Inlining::Yes)
        .relaxed_simd_deterministic(true)
        .concurrency_support(false)
        .max_wasm_stack(MAX_STACK_BYTES)
        .consume_fuel(strict)
        .cranelift_nan_canonicalization(strict);
    let engine = Engine::new(&config)?;
    let (linker, direct_linker) = (imports::linker(&engine)?, imports::direct_linker(&engine)?);
    let ticking = engine.weak();
    // Only stops what runs too long: no result depends on it.
    std::thread::Builder::new().name("plugin deadlines".to_owned()).spawn(move || {
        loop {
            std::thread::sleep(TICK);
            let Some(engine) = ticking.upgrade() else { return };
            engine.increment_epoch();
        }
    })?;
    Ok(Workshop { engine, linker, direct_linker })
}

fn read(path: &Path, shown: &str) -> Result<Vec<u8>, PluginError> {
    let unreadable = |error: std::io::Error| PluginError::refused(shown, format!("it cannot be read: {error}"));
    let file = std::fs::File::open(path).map_err(unreadable)?;
    let mut bytes = Vec::new();
    file.take(MAX_FILE_BYTES + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    if bytes.len() as u64 > MAX_FILE_BYTES {
        let size = std::fs::metadata(path).map_or(bytes.len() as u64, |metadata| metadata.len());
        let message = format!("it has {} MiB; at most {} are read", size >> 20, MAX_FILE_BYTES >> 20);
        return Err(PluginError::refused(shown, message));
    }
    Ok(bytes)
}

/// The description that a plugin gives, checked.
fn describe(plugin: &Plugin) -> Result<Metadata, PluginError> {
    let mut metadata = match &plugin.compiled.code {
        Code::Module(_) => direct_term::describe(plugin, Arc::new(NoTown))?,
        Code::Component(_) => {
            let mut session = Session::open(plugin, Arc::new(NoTown))?;
            let function = session.function::<(), (Metadata,)>("describe")?;
            session.call("describe", &function, ())?.0
        }
    };
    for text in [&mut metadata.name, &mut metadata.version, &mut metadata.summary] {
        *text = visible_text(text);
    }
    let refused = |message: String| PluginError::failed(&plugin.shown, "describe", message);
    let is_plain = |byte: u8| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'_';
    let name = &metadata.name;
    if !(1..=60).contains(&name.len()) || !name.bytes().all(is_plain) || name.as_bytes()[0].is_ascii_digit() {
        let shown: String = name.chars().take(80).collect();
        return Err(refused(format!(
            "its name is `{shown}`; it must be 1 to 60 of `a-z`, `0-9` and `_`, a letter first"
        )));
    }
    parameters::check_schema(&metadata.params_schema).map_err(refused)?;
    Ok(metadata)
}
