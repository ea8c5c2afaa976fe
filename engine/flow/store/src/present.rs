//! The files of an area of a store, listed at once: a tenth of the cost of a look at each file.

use crate::layout::Area;
use crate::pack::head;
use crate::side_by_side::side_by_side;
use crate::store::Store;
use cosfly_diagnose::{Diagnostic, Result};
use cosfly_fingerprint::Digest;
use std::io;

/// Fewer folders than this are not worth a thread.
const SHARDS_PER_THREAD: usize = 32;

/// Files in some folders of an area, by the first bytes of their digests: eight bytes a file.
pub(crate) struct Present(Vec<Option<Vec<u64>>>);

impl Present {
    /// Lists those folders of the area for which `is_wanted` is true.
    pub(crate) fn of(store: &Store, area: Area, is_wanted: impl Fn(usize) -> bool) -> Result<Self> {
        let shards: Vec<u8> = (0..=u8::MAX).filter(|shard| is_wanted(usize::from(*shard))).collect();
        let heads_of = |shard: &u8| -> io::Result<Vec<u64>> {
            let mut heads: Vec<u64> = store.layout.list_shard(area, *shard)?.iter().map(head).collect();
            heads.extend(store.packed_heads(area, *shard));
            heads.sort_unstable();
            Ok(heads)
        };
        let listed = side_by_side(&shards, SHARDS_PER_THREAD, heads_of);
        let mut present = vec![None; 1 + usize::from(u8::MAX)];
        for (shard, heads) in shards.into_iter().zip(listed) {
            let heads = heads.map_err(|error| {
                Diagnostic::io(format!("list `{}`", store.layout.folder(area.folder()).display()), &error)
            })?;
            present[usize::from(shard)] = Some(heads);
        }
        Ok(Self(present))
    }

    /// Whether the area had a file of the digest when its folder was listed; `None` where it was not listed.
    pub(crate) fn holds(&self, digest: &Digest) -> Option<bool> {
        let heads = self.0[usize::from(digest.0[0])].as_ref()?;
        Some(heads.binary_search(&head(digest)).is_ok())
    }
}
