//! Finished items as stages read them: named blobs with checked digests.

use crate::{Answers, Blobs, ItemId, ItemName};
use cosfly_blobs::{BlobPart, BlobRef};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use std::any::{Any, TypeId};
use std::collections::BTreeMap;
use std::fs::File;
use std::sync::Arc;

/// A finished item at a port.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Artifact {
    /// Item that the artifact is the output of.
    pub id: ItemId,
    /// Name at the port that it is read through (see [`crate::Takes`]).
    pub name: ItemName,
    /// Blobs of the item.
    pub blobs: Arc<Blobs>,
}

/// A decoded blob, of the type that its reader requested.
pub type Decoded = Arc<dyn Any + Send + Sync>;

/// Source of blobs that caches decoded ones shared by several tasks. Implemented by the store.
pub trait BlobSource: Send + Sync {
    /// Reads all bytes of a blob; the digest is checked.
    fn read(&self, blob: &BlobRef) -> Result<Vec<u8>>;
    /// Reads a part of a blob; the digest of the part is checked, the rest is not read.
    fn read_part(&self, blob: &BlobRef, part: &BlobPart) -> Result<Vec<u8>>;
    /// Opens the blob as a file; size and digest are checked once per process.
    fn open(&self, blob: &BlobRef) -> Result<File>;
    /// Decoded value of the blob, of type `kind`; `decode` runs once per process while tasks use the value.
    fn decoded(&self, blob: &BlobRef, kind: TypeId, decode: &dyn Fn(&[u8]) -> Result<Decoded>) -> Result<Decoded>;
}

/// Artifacts by port, in item order; exactly one at [`crate::Fan::Each`] and [`crate::Fan::Broadcast`] ports. Optional
/// ports that are not connected are absent.
pub type Ports = BTreeMap<&'static str, Arc<[Artifact]>>;

/// Inputs of one task.
pub struct Inputs<'a> {
    /// Artifacts that the task reads, by port.
    pub ports: Ports,
    /// Storage of their bytes.
    pub blobs: &'a dyn BlobSource,
    /// Answers of services outside.
    pub answers: &'a dyn Answers,
}

impl Inputs<'_> {
    /// All artifacts at `port`; empty when the port is not connected.
    pub fn all(&self, port: &str) -> &[Artifact] {
        self.ports.get(port).map_or(&[], |artifacts| artifacts)
    }

    /// Artifact at an `Each` or `Broadcast` port.
    pub fn one(&self, port: &str) -> Result<&Artifact> {
        self.all(port).first().ok_or_else(|| {
            Diagnostic::new("stage-port-empty", Fault::Bug, format!("nothing is connected to port `{port}`"))
        })
    }

    /// Reads the bytes of blob `name` of `artifact`.
    pub fn read(&self, artifact: &Artifact, name: &str) -> Result<Vec<u8>> {
        self.blobs.read(Self::blob(artifact, name)?)
    }

    /// Reads a part of blob `name` of `artifact`.
    pub fn read_part(&self, artifact: &Artifact, name: &str, part: &BlobPart) -> Result<Vec<u8>> {
        self.blobs.read_part(Self::blob(artifact, name)?, part)
    }

    /// Opens blob `name` of `artifact` as a file.
    pub fn open(&self, artifact: &Artifact, name: &str) -> Result<File> {
        self.blobs.open(Self::blob(artifact, name)?)
    }

    /// Decodes blob `name` of `artifact`, once for all tasks that share it.
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
            Diagnostic::new("stage-blob-missing", Fault::Bug, format!("`{}` has no blob `{name}`", artifact.id))
        })
    }
}
