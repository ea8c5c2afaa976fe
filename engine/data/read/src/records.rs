//! Reads all records of an MCAP file in order and checks every checksum.

use ::mcap::records::Record;
use ::mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};
use cosfly_diagnose::contained;
use std::fmt::{self, Display, Formatter};
use std::io::Read;

/// Longest record that is read; a raw depth image of the largest camera fits.
pub(crate) const RECORD_LIMIT: usize = 1 << 30;

/// Problem of bytes on which the library panics.
pub(crate) const NO_WRITER: &str = "it holds what no writer writes";

/// The reason why a log cannot be read to its end.
#[derive(Debug)]
#[non_exhaustive]
pub enum LogDamage {
    /// The file cannot be read.
    Unreadable(std::io::Error),
    /// The file breaks the rules of MCAP, a checksum included.
    Log(::mcap::McapError),
    /// One record breaks them.
    Record(::mcap::McapError),
    /// The library panics on the bytes.
    NoWriter,
}

impl Display for LogDamage {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unreadable(error) => write!(f, "it cannot be read: {error}"),
            Self::Log(error) => write!(f, "the log is damaged: {error}"),
            Self::Record(error) => write!(f, "a record is damaged: {error}"),
            Self::NoWriter => f.write_str(NO_WRITER),
        }
    }
}

impl std::error::Error for LogDamage {}

/// Calls `visit` with every record, after all its checksums are checked.
///
/// # Errors
/// The first damage.
pub fn read_records(input: &mut impl Read, visit: &mut dyn FnMut(Record<'_>)) -> Result<(), LogDamage> {
    let options = LinearReaderOptions::default()
        .with_prevalidate_chunk_crcs(true)
        .with_validate_data_section_crc(true)
        .with_validate_summary_section_crc(true)
        .with_check_finishes_after_end_magic(true)
        .with_record_length_limit(RECORD_LIMIT);
    let mut reader = LinearReader::new_with_options(options);
    while let Some(event) = contained(|| reader.next_event()).ok_or(LogDamage::NoWriter)? {
        match event.map_err(LogDamage::Log)? {
            LinearReadEvent::ReadRequest(wanted) => {
                let read = input.read(reader.insert(wanted)).map_err(LogDamage::Unreadable)?;
                reader.notify_read(read);
            }
            LinearReadEvent::Record { opcode, data } => {
                let record = contained(|| ::mcap::parse_record(opcode, data)).ok_or(LogDamage::NoWriter)?;
                visit(record.map_err(LogDamage::Record)?);
            }
        }
    }
    Ok(())
}
