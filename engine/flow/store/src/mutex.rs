//! Mutexes that remain usable after a panic in another thread.

use std::sync::{Mutex, MutexGuard, PoisonError};

/// Data behind a mutex, also after a panic of its holder: all data of a store is valid between two statements.
pub(crate) fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
