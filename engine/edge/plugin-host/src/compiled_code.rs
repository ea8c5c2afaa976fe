//! Compiled plugins, kept in a folder of their own: nothing but what was written there by this very compiler is loaded.

use cosfly_fingerprint::Digest;
use std::fs;
use std::hash::{Hash, Hasher};
use std::io::Write;
use std::path::{Path, PathBuf};
use wasmtime::component::Component;
use wasmtime::{Engine, Module};

/// A form of compiled plugins.
pub trait Compiled: Sized {
    /// Ending of the files that it is kept in.
    const ENDING: &str;
    /// Compiles `bytes`.
    ///
    /// # Errors
    /// The refusal of the compiler.
    fn compile(engine: &Engine, bytes: &[u8]) -> wasmtime::Result<Self>;
    /// Its machine code.
    ///
    /// # Errors
    /// Message of the compiler.
    fn code(&self) -> wasmtime::Result<Vec<u8>>;
    /// The plugin whose machine code [`Self::code`] gave.
    ///
    /// # Errors
    /// That it is of another form, version or engine.
    ///
    /// # Safety
    /// The code is run: it must be what [`Self::code`] gave, whole.
    unsafe fn of_code(engine: &Engine, code: &[u8]) -> wasmtime::Result<Self>;
}

impl Compiled for Component {
    const ENDING: &str = "cwasm";

    fn compile(engine: &Engine, bytes: &[u8]) -> wasmtime::Result<Self> {
        Self::from_binary(engine, bytes)
    }

    fn code(&self) -> wasmtime::Result<Vec<u8>> {
        self.serialize()
    }

    unsafe fn of_code(engine: &Engine, code: &[u8]) -> wasmtime::Result<Self> {
        // SAFETY: the caller vouches for the code.
        unsafe { Self::deserialize(engine, code) }
    }
}

impl Compiled for Module {
    const ENDING: &str = "module.cwasm";

    fn compile(engine: &Engine, bytes: &[u8]) -> wasmtime::Result<Self> {
        Self::from_binary(engine, bytes)
    }

    fn code(&self) -> wasmtime::Result<Vec<u8>> {
        self.serialize()
    }

    unsafe fn of_code(engine: &Engine, code: &[u8]) -> wasmtime::Result<Self> {
        // SAFETY: the caller vouches for the code.
        unsafe { Self::deserialize(engine, code) }
    }
}

/// Compiles `bytes` and keeps that in `folder`; `digest` is that of the plugin's file. A folder that cannot be used is
/// passed over: the plugin is then compiled every time.
///
/// # Errors
/// The refusal of the compiler.
pub fn compile<C: Compiled>(
    engine: &Engine,
    folder: Option<&Path>,
    digest: Digest,
    bytes: &[u8],
) -> wasmtime::Result<C> {
    let compiled = C::compile(engine, bytes)?;
    if let (Some(folder), Ok(code)) = (folder, compiled.code()) {
        let _ = write(&file::<C>(engine, folder, digest), &code);
    }
    Ok(compiled)
}

/// The compiled form of a plugin that was compiled before, without looking at more than its digest.
pub fn find<C: Compiled>(engine: &Engine, folder: Option<&Path>, digest: Digest) -> Option<C> {
    read(engine, &file::<C>(engine, folder?, digest))
}

fn file<C: Compiled>(engine: &Engine, folder: &Path, digest: Digest) -> PathBuf {
    folder.join(format!("{}.{}", key(engine, digest), C::ENDING))
}

/// The digest of the plugin, the compiler and all its settings.
fn key(engine: &Engine, digest: Digest) -> Digest {
    struct Gather(Vec<u8>);
    impl Hasher for Gather {
        fn finish(&self) -> u64 {
            0
        }
        fn write(&mut self, bytes: &[u8]) {
            self.0.extend_from_slice(bytes);
        }
    }
    let mut gather = Gather(digest.0.to_vec());
    engine.precompile_compatibility_hash().hash(&mut gather);
    Digest::of(&gather.0)
}

/// A kept file is the digest of the code and the code, so that a damaged one is not run.
fn read<C: Compiled>(engine: &Engine, file: &Path) -> Option<C> {
    let bytes = fs::read(file).ok()?;
    let (digest, code) = bytes.split_first_chunk::<32>()?;
    if Digest::of(code).0 != *digest {
        return None;
    }
    // SAFETY: the code is what `write` put there, whole, from an engine with the same compatibility hash; the folder is the
    // user's own, which is as trusted as this program's own file.
    unsafe { C::of_code(engine, code) }.ok()
}

fn write(file: &Path, code: &[u8]) -> std::io::Result<()> {
    let folder = file.parent().map(PathBuf::from).unwrap_or_default();
    create_private(&folder)?;
    let draft = file.with_extension(format!("{}.draft", std::process::id()));
    let mut out = fs::File::create(&draft)?;
    out.write_all(&Digest::of(code).0)?;
    out.write_all(code)?;
    out.sync_all()?;
    fs::rename(&draft, file)
}

fn create_private(folder: &Path) -> std::io::Result<()> {
    let mut builder = fs::DirBuilder::new();
    builder.recursive(true);
    #[cfg(unix)]
    std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
    builder.create(folder)
}
