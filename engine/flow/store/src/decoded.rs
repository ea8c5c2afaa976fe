//! Cache of decoded blobs that many tasks share, such as the town.

use crate::mutex::locked;
use cosfly_diagnose::Result;
use cosfly_fingerprint::Digest;
use std::any::{Any, TypeId};
use std::cell::Cell;
use std::collections::{BTreeMap, VecDeque};
use std::sync::{Arc, Mutex, Weak};

type Value = Arc<dyn Any + Send + Sync>;
type Slot = Arc<Mutex<Option<Weak<dyn Any + Send + Sync>>>>;
type Key = (Digest, TypeId);

/// Number of values kept while no task uses them. Otherwise a run of one task at a time would decode the town anew for
/// every item.
const KEPT: usize = 8;
/// Number of slots above which empty ones are removed for the first time.
const FEW_SLOTS: usize = 256;

thread_local! {
    /// Depth of decodes on this thread. A nested decode never waits for another one: a decode may run tasks of a thread
    /// pool, and a thread of the pool that waits inside its own task would wait for ever.
    static DEPTH: Cell<u32> = const { Cell::new(0) };
}

/// Slots by blob and type.
#[derive(Default)]
struct Slots {
    by_key: BTreeMap<Key, Slot>,
    /// Number of slots above which empty ones are removed: twice the number in use at the last removal, so that the
    /// scan costs a constant time per slot.
    limit: usize,
}

/// Values by blob and type: weak references to all, strong ones to the most recent.
#[derive(Default)]
pub(crate) struct DecodeCache {
    slots: Mutex<Slots>,
    recent: Mutex<VecDeque<(Key, Value)>>,
}

impl DecodeCache {
    /// Value of a blob, from the cache or by `decode`; concurrent requests of one value decode it once.
    pub(crate) fn get_or_decode(
        &self,
        digest: Digest,
        kind: TypeId,
        decode: impl FnOnce() -> Result<Value>,
    ) -> Result<Value> {
        let key = (digest, kind);
        let slot = self.slot(key);
        let value = if DEPTH.get() == 0 {
            let mut held = locked(&slot);
            match held.as_ref().and_then(Weak::upgrade) {
                Some(value) => value,
                None => {
                    let value = decode_inside(decode)?;
                    *held = Some(Arc::downgrade(&value));
                    value
                }
            }
        } else {
            let known = slot.try_lock().ok().and_then(|held| held.as_ref().and_then(Weak::upgrade));
            known.map_or_else(|| decode_inside(decode), Ok)?
        };
        self.keep(key, &value);
        Ok(value)
    }

    fn slot(&self, key: Key) -> Slot {
        let mut slots = locked(&self.slots);
        if slots.by_key.len() > slots.limit {
            slots.by_key.retain(|_, slot| {
                Arc::strong_count(slot) > 1 || locked(slot).as_ref().is_some_and(|weak| weak.strong_count() > 0)
            });
            slots.limit = FEW_SLOTS.max(2 * slots.by_key.len());
        }
        Arc::clone(slots.by_key.entry(key).or_default())
    }

    fn keep(&self, key: Key, value: &Value) {
        let mut recent = locked(&self.recent);
        recent.retain(|(other, _)| *other != key);
        recent.push_back((key, Arc::clone(value)));
        let dropped = if recent.len() > KEPT { recent.pop_front() } else { None };
        // A large value is freed outside the lock.
        drop(recent);
        drop(dropped);
    }
}

fn decode_inside(decode: impl FnOnce() -> Result<Value>) -> Result<Value> {
    struct Leave;
    impl Drop for Leave {
        fn drop(&mut self) {
            DEPTH.set(DEPTH.get() - 1);
        }
    }
    DEPTH.set(DEPTH.get() + 1);
    let _leave = Leave;
    decode()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicU32, Ordering};

    fn number(cache: &DecodeCache, name: &str, decodes: &AtomicU32) -> u32 {
        let value = cache.get_or_decode(Digest::of(name.as_bytes()), TypeId::of::<u32>(), || {
            Ok(Arc::new(decodes.fetch_add(1, Ordering::Relaxed)) as Value)
        });
        *value.unwrap().downcast::<u32>().unwrap()
    }

    #[test]
    fn a_shared_blob_is_decoded_once_by_any_number_of_threads() {
        let (cache, decodes) = (DecodeCache::default(), AtomicU32::new(0));
        std::thread::scope(|scope| {
            for _ in 0..8 {
                scope.spawn(|| (0..100).for_each(|_| assert_eq!(number(&cache, "town", &decodes), 0)));
            }
        });
        assert_eq!(decodes.load(Ordering::Relaxed), 1);
    }

    #[test]
    fn memory_holds_few_values_however_many_blobs_are_decoded() {
        let (cache, decodes) = (DecodeCache::default(), AtomicU32::new(0));
        for blob in 0..2000 {
            number(&cache, &format!("path-{blob}"), &decodes);
            number(&cache, "town", &decodes);
        }
        assert_eq!(decodes.load(Ordering::Relaxed), 2001);
        assert!(locked(&cache.recent).len() <= KEPT && locked(&cache.slots).by_key.len() <= FEW_SLOTS + 1);
    }

    #[test]
    fn a_decode_that_decodes_the_same_blob_does_not_wait_for_itself() {
        let cache = DecodeCache::default();
        let (digest, kind) = (Digest::of(b"x"), TypeId::of::<u32>());
        let value = cache.get_or_decode(digest, kind, || cache.get_or_decode(digest, kind, || Ok(Arc::new(3_u32))));
        assert_eq!(*value.unwrap().downcast::<u32>().unwrap(), 3);
    }
}
