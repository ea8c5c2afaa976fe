//! Many small files of an area in one file. A store of a hundred thousand flights has a million files of some hundred bytes,
//! and each of them takes a block of the disk and a place among the files that a user may have.
//!
//! ```text
//! header  pages  first 8 bytes of the digests, sorted  pages: first entry, place, length  counts of entries and pages, digest of the tables
//! ```
//!
//! A page is a zstd frame of entries: digest, time of last change, length, bytes. Numbers are little-endian.

use crate::mutex::locked;
use cosfly_fingerprint::{Digest, DigestOfPieces};
use std::fs::File;
use std::io::{self, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::Path;
use std::sync::Mutex;

/// Magic bytes of the file.
const HEADER: &[u8] = b"cosfly-pack 1\n";
/// Largest file that is packed, bytes: a larger one wastes little of its blocks.
pub(crate) const LARGEST: u64 = 1 << 14;
/// Bytes of entries from which on a page is written.
const PAGE: usize = 1 << 15;
/// Bytes that a page may have.
const LARGEST_PAGE: usize = PAGE + ENTRY + LARGEST as usize;
/// Bytes of an entry before the file's own.
const ENTRY: usize = 32 + 8 + 4;
/// Bytes of a page in the table: first entry, place, length.
const PAGE_ROW: usize = 4 + 8 + 4;
/// Bytes of the end: number of entries, number of pages, digest of the tables.
const END: usize = 8 + 8 + 32;
/// Best ratio of the levels that cost less than writing the file that is packed.
const LEVEL: i32 = 3;

/// A file in a pack.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Packed {
    /// Name of the file.
    pub(crate) digest: Digest,
    /// Time of last change, seconds since 1970.
    pub(crate) changed_s: u64,
    /// Content.
    pub(crate) bytes: Vec<u8>,
}

/// An open pack: eight bytes of memory for a file in it.
#[derive(Debug)]
pub(crate) struct Pack {
    file: Mutex<File>,
    /// First bytes of the digests, sorted.
    heads: Vec<u64>,
    pages: Vec<Page>,
}

#[derive(Clone, Copy, Debug)]
struct Page {
    first: u32,
    place: u64,
    length: u32,
}

impl Pack {
    /// Opens a pack; `None` where there is none or its tables are not as [`PackWriter`] wrote them.
    pub(crate) fn open(path: &Path) -> Option<Self> {
        let mut file = File::open(path).ok()?;
        let size = file.metadata().ok()?.len();
        let end_place = size.checked_sub(END as u64)?;
        let end = read_at(&mut file, end_place, END)?;
        let mut fields = Fields(&end);
        let (entries, pages, digest) = (fields.number()?, fields.number()?, fields.digest()?);
        let rows = pages.checked_mul(PAGE_ROW as u64)?;
        let tables = entries.checked_mul(8)?.checked_add(rows)?;
        let tables_place = end_place.checked_sub(tables)?;
        let tables = read_at(&mut file, tables_place, usize::try_from(tables).ok()?)?;
        if read_at(&mut file, 0, HEADER.len())? != HEADER || Digest::of(&tables) != digest {
            return None;
        }
        let (heads, rows) = tables.split_at(usize::try_from(entries).ok()?.checked_mul(8)?);
        let heads = heads.as_chunks::<8>().0.iter().map(|bytes| u64::from_le_bytes(*bytes)).collect();
        let pages = rows.chunks_exact(PAGE_ROW).map(Page::of).collect::<Option<_>>()?;
        Some(Self { file: Mutex::new(file), heads, pages })
    }

    /// First bytes of the digests in the pack, sorted.
    pub(crate) fn heads(&self) -> &[u64] {
        &self.heads
    }

    /// Whether the pack has a file of that name, as far as eight bytes of the digest tell.
    pub(crate) fn holds(&self, digest: &Digest) -> bool {
        self.heads.binary_search(&head(digest)).is_ok()
    }

    /// Bytes of a file in the pack; `None` where there is none or its page is damaged.
    pub(crate) fn read(&self, digest: &Digest) -> Option<Vec<u8>> {
        // Files whose digests share the first bytes are neighbours, maybe of several pages.
        let head = head(digest);
        let first = self.heads.partition_point(|other| *other < head);
        let end = first + self.heads[first..].partition_point(|other| *other == head);
        let page = self.pages.partition_point(|page| page.first as usize <= first).checked_sub(1)?;
        let pages = self.pages[page..].iter().take_while(|page| (page.first as usize) < end);
        pages.flat_map(|page| self.page(page)).find(|packed| packed.digest == *digest).map(|packed| packed.bytes)
    }

    /// All files in the pack by their digests, but those of damaged pages.
    pub(crate) fn entries(&self) -> impl Iterator<Item = Packed> + '_ {
        self.pages.iter().flat_map(|page| self.page(page))
    }

    fn page(&self, page: &Page) -> Vec<Packed> {
        let frame = read_at(&mut locked(&self.file), page.place, page.length as usize);
        let entries = frame.and_then(|frame| zstd::bulk::decompress(&frame, LARGEST_PAGE).ok()).and_then(|bytes| {
            let mut fields = Fields(&bytes);
            let mut entries = Vec::new();
            while !fields.0.is_empty() {
                entries.push(fields.entry()?);
            }
            Some(entries)
        });
        entries.unwrap_or_default()
    }
}

impl Page {
    fn of(row: &[u8]) -> Option<Self> {
        let mut fields = Fields(row);
        let page = Self { first: fields.small()?, place: fields.number()?, length: fields.small()? };
        // A page is never longer than what it holds and the little that zstd adds.
        (page.length as usize <= zstd::zstd_safe::compress_bound(LARGEST_PAGE)).then_some(page)
    }
}

/// Eight bytes of a digest, which sort as the digests do.
pub(crate) fn head(digest: &Digest) -> u64 {
    let (heads, _) = digest.0.as_chunks::<8>();
    u64::from_be_bytes(heads[0])
}

/// Range of the heads of the digests whose first byte is `shard`.
pub(crate) fn heads_of_shard(heads: &[u64], shard: u8) -> &[u64] {
    let first_of = |shard: u64| heads.partition_point(|head| (head >> 56) < shard);
    &heads[first_of(u64::from(shard))..first_of(u64::from(shard) + 1)]
}

fn read_at(file: &mut File, place: u64, length: usize) -> Option<Vec<u8>> {
    let size = file.metadata().ok()?.len();
    if place.checked_add(length as u64)? > size {
        return None;
    }
    file.seek(SeekFrom::Start(place)).ok()?;
    let mut bytes = vec![0; length];
    file.read_exact(&mut bytes).ok()?;
    Some(bytes)
}

/// Writes a pack, entry by entry.
pub(crate) struct PackWriter {
    file: BufWriter<File>,
    place: u64,
    heads: Vec<u8>,
    rows: Vec<u8>,
    page: Vec<u8>,
    first: u32,
    count: u32,
}

impl PackWriter {
    pub(crate) fn new(file: File) -> io::Result<Self> {
        let mut file = BufWriter::new(file);
        file.write_all(HEADER)?;
        let place = HEADER.len() as u64;
        Ok(Self { file, place, heads: vec![], rows: vec![], page: vec![], first: 0, count: 0 })
    }

    /// Adds a file of at most [`LARGEST`] bytes; digests ascend.
    pub(crate) fn add(&mut self, packed: &Packed) -> io::Result<()> {
        debug_assert!(packed.bytes.len() as u64 <= LARGEST);
        self.heads.extend(head(&packed.digest).to_le_bytes());
        self.page.extend(packed.digest.0);
        self.page.extend(packed.changed_s.to_le_bytes());
        self.page.extend((packed.bytes.len() as u32).to_le_bytes());
        self.page.extend(&packed.bytes);
        self.count = self.count.checked_add(1).ok_or_else(|| io::Error::other("too many small files"))?;
        if self.page.len() >= PAGE { self.end_page() } else { Ok(()) }
    }

    fn end_page(&mut self) -> io::Result<()> {
        let frame = zstd::bulk::compress(&self.page, LEVEL)?;
        self.file.write_all(&frame)?;
        self.rows.extend(self.first.to_le_bytes());
        self.rows.extend(self.place.to_le_bytes());
        self.rows.extend((frame.len() as u32).to_le_bytes());
        self.place += frame.len() as u64;
        self.first = self.count;
        self.page.clear();
        Ok(())
    }

    /// Writes the tables and has the disk keep all of it; gives the number of files.
    pub(crate) fn finish(mut self) -> io::Result<u32> {
        if !self.page.is_empty() {
            self.end_page()?;
        }
        let mut digest = DigestOfPieces::default();
        [&self.heads, &self.rows].iter().for_each(|piece| digest.add(piece));
        self.file.write_all(&self.heads)?;
        self.file.write_all(&self.rows)?;
        self.file.write_all(&u64::from(self.count).to_le_bytes())?;
        self.file.write_all(&((self.rows.len() / PAGE_ROW) as u64).to_le_bytes())?;
        self.file.write_all(&digest.digest().0)?;
        self.file.into_inner()?.sync_all()?;
        Ok(self.count)
    }
}

/// Rest of some bytes that is still to be read.
struct Fields<'b>(&'b [u8]);

impl Fields<'_> {
    fn take<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (taken, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(*taken)
    }

    fn number(&mut self) -> Option<u64> {
        self.take().map(u64::from_le_bytes)
    }

    fn small(&mut self) -> Option<u32> {
        self.take().map(u32::from_le_bytes)
    }

    fn digest(&mut self) -> Option<Digest> {
        self.take().map(Digest)
    }

    fn entry(&mut self) -> Option<Packed> {
        let (digest, changed_s, length) = (self.digest()?, self.number()?, self.small()?);
        let (bytes, rest) = self.0.split_at_checked(length as usize)?;
        self.0 = rest;
        Some(Packed { digest, changed_s, bytes: bytes.to_vec() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    fn files(count: usize) -> BTreeMap<Digest, Packed> {
        let file = |number: usize| {
            let bytes = format!("{number} ").repeat(1 + number % 700).into_bytes();
            let digest = Digest::of(&bytes);
            (digest, Packed { digest, changed_s: number as u64, bytes })
        };
        (0..count).map(file).collect()
    }

    fn write(path: &Path, files: &BTreeMap<Digest, Packed>) {
        let mut writer = PackWriter::new(File::create(path).unwrap()).unwrap();
        files.values().for_each(|file| writer.add(file).unwrap());
        assert_eq!(writer.finish().unwrap() as usize, files.len());
    }

    #[test]
    fn every_file_reads_back_and_no_other_is_found() {
        let folder = tempfile::tempdir().unwrap();
        for count in [0, 1, 2, 3000] {
            let (path, files) = (folder.path().join(count.to_string()), files(count));
            write(&path, &files);
            let pack = Pack::open(&path).unwrap();
            assert!(pack.entries().eq(files.values().cloned()));
            for file in files.values() {
                assert!(pack.holds(&file.digest));
                assert_eq!(pack.read(&file.digest).as_ref(), Some(&file.bytes));
            }
            let absent = Digest::of(b"absent");
            assert!(!pack.holds(&absent) && pack.read(&absent).is_none());
            let shards: usize = (0..=u8::MAX).map(|shard| heads_of_shard(pack.heads(), shard).len()).sum();
            assert_eq!(shards, count);
        }
    }

    #[test]
    fn digests_with_the_same_first_bytes_are_told_apart_across_pages() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("pack");
        let file = |number: u8| {
            let mut digest = Digest([7; 32]);
            digest.0[31] = number;
            (digest, Packed { digest, changed_s: 0, bytes: vec![number; 9000] })
        };
        let files: BTreeMap<_, _> = (0..20).map(file).collect();
        write(&path, &files);
        let pack = Pack::open(&path).unwrap();
        assert!(pack.pages.len() > 3);
        assert!(files.values().all(|file| pack.read(&file.digest).as_ref() == Some(&file.bytes)));
    }

    #[test]
    fn a_damaged_pack_is_refused_or_loses_pages_and_never_gives_more() {
        let folder = tempfile::tempdir().unwrap();
        let (path, files) = (folder.path().join("pack"), files(300));
        write(&path, &files);
        let bytes = std::fs::read(&path).unwrap();
        for place in (0..bytes.len()).step_by(97).chain(bytes.len() - END..bytes.len()) {
            let mut changed = bytes.clone();
            changed[place] ^= 0x55;
            std::fs::write(&path, &changed).unwrap();
            if let Some(pack) = Pack::open(&path) {
                assert!(pack.entries().count() <= 2 * files.len());
            }
            std::fs::write(&path, &bytes[..place]).unwrap();
            assert!(Pack::open(&path).is_none());
        }
    }
}
