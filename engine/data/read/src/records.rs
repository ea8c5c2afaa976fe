//! Reads all records of an MCAP file in order and checks every checksum.

use ::mcap::records::Record;
use ::mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};
use cosfly_diagnose::contained;
use std::io::Read;

/// Longest record that is read; a raw depth image of the largest camera fits.
pub(crate) const RECORD_LIMIT: usize = 1 << 30;

/// What is wrong with bytes on which the library panics.
pub(crate) const NO_WRITER: &str = "it holds what no writer writes";

/// Calls `visit` with every record, after all its checksums are checked.
pub fn read_records(input: &mut impl Read, visit: &mut dyn FnMut(Record<'_>)) -> Result<(), String> {
    let options = LinearReaderOptions::default()
        .with_prevalidate_chunk_crcs(true)
        .with_validate_data_section_crc(true)
        .with_validate_summary_section_crc(true)
        .with_check_finishes_after_end_magic(true)
        .with_record_length_limit(RECORD_LIMIT);
    let mut reader = LinearReader::new_with_options(options);
    while let Some(event) = contained(|| reader.next_event()).ok_or(NO_WRITER)? {
        match event.map_err(|error| format!("the log is damaged: {error}"))? {
            LinearReadEvent::ReadRequest(wanted) => {
                let read = input.read(reader.insert(wanted)).map_err(|error| format!("it cannot be read: {error}"))?;
                reader.notify_read(read);
            }
            LinearReadEvent::Record { opcode, data } => {
                let record = contained(|| ::mcap::parse_record(opcode, data)).ok_or(NO_WRITER)?;
                visit(record.map_err(|error| format!("a record is damaged: {error}"))?);
            }
        }
    }
    Ok(())
}
