//! The files of an area of a store, listed at once: a tenth of the cost of a look at each file.

use crate::layout::Area;
use crate::side_by_side::side_by_side;
use crate::store::Store;
use cosfly_diagnose::{Diagnostic, Result};
use cosfly_fingerprint::Digest;
use std::io;

/// Fewer folders than this are not worth a thread.
const SHARDS_PER_THREAD: usize = 32;

/// Files of an area by the first bytes of their digests, sorted: eight bytes a file.
pub(crate) struct Present(Vec<u64>);

impl Present {
    /// Lists the folders of the area.
    pub(crate) fn of(store: &Store, area: Area) -> Result<Self> {
        let shards: Vec<u8> = (0..=u8::MAX).collect();
        let heads_of = |shard: &u8| -> io::Result<Vec<u64>> {
            Ok(store.layout.list_shard(area, *shard)?.iter().map(head).collect())
        };
        let listed: io::Result<Vec<Vec<u64>>> =
            side_by_side(&shards, SHARDS_PER_THREAD, heads_of).into_iter().collect();
        let heads = listed.map_err(|error| {
            Diagnostic::io(format!("list `{}`", store.layout.folder(area.folder()).display()), &error)
        })?;
        Ok(Self(heads.concat()))
    }

    /// Whether the area had a file of the digest when it was listed.
    pub(crate) fn holds(&self, digest: &Digest) -> bool {
        self.0.binary_search(&head(digest)).is_ok()
    }
}

fn head(digest: &Digest) -> u64 {
    let (heads, _) = digest.0.as_chunks::<8>();
    u64::from_be_bytes(heads[0])
}
