//! What flows between stages: named blobs in the store, read with their digest checked.

use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_fingerprint::Digest;
use serde::{Deserialize, Serialize};
use std::any::{Any, TypeId};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{Seek, Write};
use std::sync::Arc;

/// Content-addressed bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct BlobRef {
    /// BLAKE3 of the bytes.
    pub digest: Digest,
    /// How many bytes.
    pub bytes: u64,
}

/// The finished output of one item.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Artifact {
    /// Stage (with part suffix) that made it.
    pub stage: String,
    /// Item id in the port that it is read through.
    pub item: String,
    /// Its blobs by name.
    pub blobs: BTreeMap<String, BlobRef>,
}

/// A decoded blob of whatever type its reader asked for.
pub type Decoded = Arc<dyn Any + Send + Sync>;

/// Reads blobs and remembers what was decoded from broadcast ones. Implemented by the store.
pub trait BlobSource: Send + Sync {
    /// All bytes of a blob, digest checked.
    fn read(&self, blob: &BlobRef) -> Result<Vec<u8>>;
    /// The blob as a file, size and digest checked once per process.
    fn open(&self, blob: &BlobRef) -> Result<File>;
    /// `decode(bytes of blob)` of type `kind`, computed once per process while it stays in use by several tasks.
    fn decoded(&self, blob: &BlobRef, kind: TypeId, decode: &dyn Fn(&[u8]) -> Result<Decoded>) -> Result<Decoded>;
}

/// The artifacts that arrive at one port.
#[derive(Clone, Debug, Default)]
pub struct InputGroup {
    /// In item order; exactly one for `Each` and `Broadcast` ports.
    pub artifacts: Vec<Artifact>,
}

/// The inputs of one task.
pub struct Inputs<'a> {
    /// By port name; optional ports that are not connected are absent.
    pub ports: BTreeMap<String, InputGroup>,
    /// Where their bytes are.
    pub blobs: &'a dyn BlobSource,
}

impl Inputs<'_> {
    /// All artifacts at `port`; empty when the port is not connected.
    pub fn all(&self, port: &str) -> &[Artifact] {
        self.ports.get(port).map_or(&[], |group| &group.artifacts)
    }

    /// The only artifact at an `Each` or `Broadcast` port.
    pub fn one(&self, port: &str) -> Result<&Artifact> {
        self.all(port).first().ok_or_else(|| {
            Diagnostic::new("stage-port-empty", Fault::Bug, format!("nothing is connected to port `{port}`"))
        })
    }

    /// The bytes of blob `name` of `artifact`.
    pub fn read(&self, artifact: &Artifact, name: &str) -> Result<Vec<u8>> {
        self.blobs.read(Self::blob(artifact, name)?)
    }

    /// Blob `name` of `artifact` as a file.
    pub fn open(&self, artifact: &Artifact, name: &str) -> Result<File> {
        self.blobs.open(Self::blob(artifact, name)?)
    }

    /// Blob `name` of `artifact`, decoded once for all tasks that share it.
    pub fn decoded<T: Any + Send + Sync>(
        &self,
        artifact: &Artifact,
        name: &str,
        decode: impl Fn(&[u8]) -> Result<T>,
    ) -> Result<Arc<T>> {
        let any = self.blobs.decoded(Self::blob(artifact, name)?, TypeId::of::<T>(), &|bytes| {
            Ok(Arc::new(decode(bytes)?) as Decoded)
        })?;
        any.downcast().map_err(|_| {
            Diagnostic::new("stage-decode-type", Fault::Bug, format!("blob `{name}` was decoded as two types"))
        })
    }

    fn blob<'b>(artifact: &'b Artifact, name: &str) -> Result<&'b BlobRef> {
        artifact.blobs.get(name).ok_or_else(|| {
            Diagnostic::new(
                "stage-blob-missing",
                Fault::Bug,
                format!("`{}/{}` has no blob `{name}`", artifact.stage, artifact.item),
            )
        })
    }
}

/// A file being written by a stage.
pub trait SeekWrite: Write + Seek + Send {}
impl<T: Write + Seek + Send> SeekWrite for T {}

/// Where a stage puts what it makes. Nothing is visible to anyone until the whole task has succeeded.
pub trait OutputSink {
    /// A small blob at once. Names are relative paths with `/`, unique within the item.
    fn put(&mut self, name: &str, bytes: &[u8]) -> Result<()>;
    /// A large blob, streamed by `write` to a file; disk-full errors become the diagnostic.
    fn stream(&mut self, name: &str, write: &mut dyn FnMut(&mut dyn SeekWrite) -> Result<()>) -> Result<BlobRef>;
    /// An existing blob of an input under a new name (no copy).
    fn link(&mut self, name: &str, blob: BlobRef) -> Result<()>;
}

/// What a task says beside its blobs; stored with them and shown by `cosfly run` also when cached.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Produced {
    /// Short facts for the summary, such as `boxes` = `65638 -> 2011`.
    pub notes: BTreeMap<String, String>,
    /// Things a person should know about; never lost data.
    pub warnings: Vec<String>,
    /// Why this item holds no usable result, when it does not (an explicit, published rejection).
    pub rejected: Option<String>,
}
