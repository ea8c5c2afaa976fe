//! Reading of a store from its packs.

use crate::fault::PublishStep;
use crate::layout::Area;
use crate::mutex::locked;
use crate::pack::{Pack, heads_of_shard};
use crate::packs::is_sound;
use crate::store::Store;
use cosfly_blobs::BlobRef;
use cosfly_fingerprint::Digest;
use std::fs;
use std::path::Path;

impl Store {
    fn pack(&self, area: Area) -> Option<&Pack> {
        self.packs.of(&self.layout, area)
    }

    /// Whether a file is in a pack.
    pub(crate) fn is_packed(&self, area: Area, digest: &Digest) -> bool {
        self.pack(area).is_some_and(|pack| pack.holds(digest)) && !locked(&self.packed_lost).contains(digest)
    }

    /// First bytes of the digests of the packed files of a shard, sorted.
    pub(crate) fn packed_heads(&self, area: Area, shard: u8) -> &[u64] {
        self.pack(area).map_or(&[], |pack| heads_of_shard(pack.heads(), shard))
    }

    /// Bytes of a packed file; `None` where it is not packed or not what its name says.
    pub(crate) fn packed(&self, area: Area, digest: &Digest) -> Option<Vec<u8>> {
        let pack = self.pack(area).filter(|pack| pack.holds(digest))?;
        let bytes = pack.read(digest).filter(|bytes| is_sound(area, digest, bytes));
        if bytes.is_none() {
            locked(&self.packed_lost).insert(*digest);
        }
        bytes
    }

    /// Bytes of a record or document: from its file, a pack or the remote.
    pub(crate) fn read_record(&self, area: Area, digest: &Digest) -> Option<Vec<u8>> {
        let path = self.layout.file(area, digest);
        fs::read(&path).ok().or_else(|| self.packed(area, digest)).or_else(|| self.fetch(&path))
    }

    /// Gives a packed blob a file of its own; true where it has one now.
    pub(crate) fn unpack(&self, blob: &BlobRef, path: &Path) -> bool {
        let Some(bytes) = self.packed(Area::Blobs, &blob.digest) else { return false };
        let written = self.write_temporary(&[&bytes], 0o444, PublishStep::WriteBlob);
        written.and_then(|temporary| self.move_into_place(&temporary, path, PublishStep::RenameBlob)).is_ok()
    }
}
