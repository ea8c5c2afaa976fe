//! The files of a dataset on their way into an output sink, with the hashes of what went in.

use super::source::PublishedLog;
use crate::table_file::TableWriter;
use cosfly_blobs::OutputSink;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_fingerprint::sha256::{HashingWriter, sha256_of};
use cosfly_schema::tables::{FileRecord, Table};
use std::io::Write;

/// A sink, and the records of the files that went into it.
pub(crate) struct Files<'a> {
    sink: &'a mut dyn OutputSink,
    pub(crate) records: Vec<FileRecord>,
}

impl<'a> Files<'a> {
    pub(crate) fn new(sink: &'a mut dyn OutputSink) -> Self {
        Self { sink, records: vec![] }
    }

    pub(crate) fn link_log(&mut self, path: &str, log: &PublishedLog) -> Result<()> {
        self.sink.link(path, log.blob)?;
        let (bytes, sha256) = (log.record.bytes, log.record.sha256.clone());
        self.records.push(FileRecord { path: path.to_owned(), bytes, sha256 });
        Ok(())
    }

    pub(crate) fn put(&mut self, path: &str, bytes: &[u8]) -> Result<FileRecord> {
        self.sink.put(path, bytes)?;
        let file = FileRecord { path: path.to_owned(), bytes: bytes.len() as u64, sha256: sha256_of(bytes) };
        self.records.push(file.clone());
        Ok(file)
    }

    /// Puts a file that nothing names the hash of.
    pub(crate) fn put_unnamed(&mut self, path: &str, bytes: &[u8]) -> Result<()> {
        self.sink.put(path, bytes)
    }

    /// A table of a list in memory, in one file.
    pub(crate) fn table<S>(&mut self, table: &Table<S>, path: &str, records: &[S]) -> Result<u64> {
        let mut rows = 0;
        self.hashed(path, &mut |output| {
            let mut writer = TableWriter::new(table, output)?;
            records.iter().try_for_each(|record| writer.append(record))?;
            rows = writer.finish()?;
            Ok(())
        })?;
        Ok(rows)
    }

    /// A file that is written piece by piece, and its hash.
    pub(crate) fn hashed(
        &mut self,
        path: &str,
        write: &mut dyn FnMut(&mut (dyn Write + Send)) -> Result<()>,
    ) -> Result<()> {
        let mut outcome = None;
        self.sink.stream(path, &mut |output| {
            let mut hashing = HashingWriter::new(output);
            write(&mut hashing)?;
            outcome = Some(hashing.finish());
            Ok(())
        })?;
        let (bytes, sha256) = outcome.ok_or_else(|| {
            Diagnostic::new("dataset-sink", Fault::Bug, format!("the output sink did not ask for `{path}`"))
        })?;
        self.records.push(FileRecord { path: path.to_owned(), bytes, sha256 });
        Ok(())
    }
}
