//! Compiled plugins, kept in a folder of their own: nothing but what was written there by this very compiler is loaded.

use cosfly_fingerprint::Digest;
use std::fs;
use std::hash::{Hash, Hasher};
use std::io::Write;
use std::path::{Path, PathBuf};
use wasmtime::Engine;
use wasmtime::component::Component;

/// Compiles `component`, or takes it from `folder`; `digest` is that of the plugin's file. A folder that cannot be used is
/// passed over: the plugin is then compiled every time.
///
/// # Errors
/// What the compiler refuses.
pub fn compile(
    engine: &Engine,
    folder: Option<&Path>,
    digest: Digest,
    component: &[u8],
) -> wasmtime::Result<Component> {
    let file = folder.map(|folder| folder.join(format!("{}.cwasm", key(engine, digest))));
    if let Some(known) = file.as_deref().and_then(|file| read(engine, file)) {
        return Ok(known);
    }
    let compiled = Component::from_binary(engine, component)?;
    if let (Some(file), Ok(code)) = (&file, compiled.serialize()) {
        let _ = write(file, &code);
    }
    Ok(compiled)
}

/// The compiled form of a plugin that was compiled before, without looking at more than its digest.
pub fn find(engine: &Engine, folder: Option<&Path>, digest: Digest) -> Option<Component> {
    read(engine, &folder?.join(format!("{}.cwasm", key(engine, digest))))
}

/// Of the plugin, the compiler and all its settings.
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
fn read(engine: &Engine, file: &Path) -> Option<Component> {
    let bytes = fs::read(file).ok()?;
    let (digest, code) = bytes.split_first_chunk::<32>()?;
    if Digest::of(code).0 != *digest {
        return None;
    }
    // SAFETY: the code is what `write` put there, whole, from an engine with the same compatibility hash; the folder is the
    // user's own, which is as trusted as this program's own file.
    unsafe { Component::deserialize(engine, code) }.ok()
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
