//! A value computed from one broadcast input, kept by a stage for all its items.

use cosfly_fingerprint::Digest;
use std::sync::{Arc, Mutex, PoisonError};

/// The last computed value and the digest of the blob that it was computed from.
pub struct Memo<T>(Mutex<Option<(Digest, Arc<T>)>>);

impl<T> Default for Memo<T> {
    fn default() -> Self {
        Self(Mutex::new(None))
    }
}

impl<T> Memo<T> {
    /// Value for `input`; `compute` runs at most once at a time, others wait for it.
    pub fn get<E>(&self, input: Digest, compute: impl FnOnce() -> Result<T, E>) -> Result<Arc<T>, E> {
        let mut slot = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((digest, value)) = &*slot
            && *digest == input
        {
            return Ok(Arc::clone(value));
        }
        let value = Arc::new(compute()?);
        *slot = Some((input, Arc::clone(&value)));
        Ok(value)
    }
}
