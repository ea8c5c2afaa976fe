//! [`Remote`]: a store elsewhere, such as a bucket.

use cosfly_diagnose::Result;
use std::time::SystemTime;

/// Objects by name.
pub trait Remote: Send + Sync {
    /// Place for messages and for other machines, such as `s3://bucket/prefix`.
    fn place(&self) -> &str;

    /// Bytes of an object; `None` where there is none.
    fn get(&self, name: &str) -> Result<Option<Vec<u8>>>;

    /// Size of an object; `None` where there is none.
    fn size(&self, name: &str) -> Result<Option<u64>>;

    /// Writes an object, over an earlier one.
    fn put(&self, name: &str, bytes: Vec<u8>) -> Result<()>;

    /// Writes an object unless there is one; true where it was written. Of any number of writers one gets true.
    fn create(&self, name: &str, bytes: Vec<u8>) -> Result<bool>;

    /// Objects whose names begin with `folder/`.
    fn list(&self, folder: &str) -> Result<Vec<RemoteObject>>;

    /// Removes objects; absent ones are no error.
    fn delete(&self, names: &[String]) -> Result<()>;
}

/// An object in a list.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RemoteObject {
    /// Name.
    pub name: String,
    /// Size, bytes.
    pub bytes: u64,
    /// Time of the last write, by the clock of the remote.
    pub written: SystemTime,
}
