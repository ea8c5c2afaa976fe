//! The part of Arrow streams that stages need: one record batch of floats, integers and booleans in; of those, texts or bytes out.
//!
//! The whole library would make plugins of a hundred kilobytes into some of two megabytes. Layout: Arrow columnar format 1.5,
//! IPC streams; messages are Flatbuffers.

use super::flatbuffers::{Builder, Cell, Node, i64_at, u32_at};

/// The values of a column.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// 64-bit floats.
    Reals(Vec<f64>),
    /// 64-bit integers.
    Integers(Vec<i64>),
    /// Booleans.
    Booleans(Vec<bool>),
    /// Texts.
    Texts(Vec<String>),
    /// Bytes.
    Bytes(Vec<Vec<u8>>),
}

/// A batch as it is read, with the metadata of the schema.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// How many rows there are.
    pub rows: usize,
    /// Names and values.
    pub metadata: Vec<(String, String)>,
    /// Names and values.
    pub columns: Vec<(String, Values)>,
}

const CONTINUED: u32 = 0xFFFF_FFFF;
/// Message headers.
const SCHEMA: u8 = 1;
const RECORD_BATCH: u8 = 3;
/// Types of fields.
const INT: u8 = 2;
const FLOATING_POINT: u8 = 3;
const BINARY: u8 = 4;
const UTF8: u8 = 5;
const BOOL: u8 = 6;
/// Version 5 of the metadata.
const V5: i16 = 4;

/// Reads a stream of one batch.
///
/// # Errors
/// That the stream is another one than in the interface.
pub fn read(stream: &[u8]) -> Result<Table, String> {
    read_checked(stream).ok_or_else(|| "the flight is no Arrow stream of floats, integers and booleans".to_owned())
}

fn read_checked(stream: &[u8]) -> Option<Table> {
    let mut at = 0;
    let mut table = Table::default();
    let mut fields = Vec::new();
    loop {
        if u32_at(stream, at)? != CONTINUED {
            return None;
        }
        let length = u32_at(stream, at + 4)? as usize;
        if length == 0 {
            return None;
        }
        let message = stream.get(at + 8..(at + 8).checked_add(length)?)?;
        let root = Node { bytes: message, at: u32_at(message, 0)? as usize };
        let body_length = root.slot(3).and_then(|at| i64_at(message, at)).unwrap_or(0);
        let body_at = at + 8 + length;
        let body = stream.get(body_at..body_at.checked_add(usize::try_from(body_length).ok()?)?)?;
        let header = root.table(2)?;
        match *message.get(root.slot(1)?)? {
            SCHEMA => {
                for field in header.tables(1)? {
                    fields.push((field.text(0)?, field_kind(&field)?));
                }
                for pair in header.tables(2).unwrap_or_default() {
                    table.metadata.push((pair.text(0)?, pair.text(1)?));
                }
            }
            RECORD_BATCH => {
                let rows = usize::try_from(i64_at(message, header.slot(0)?)?).ok()?;
                let buffers = header.vector(2)?;
                table.rows = rows;
                for (column, (name, kind)) in fields.into_iter().enumerate() {
                    // Two buffers per column, validity and data: 16 bytes each, offset and length.
                    let data_at = buffers + 4 + 16 * (2 * column + 1);
                    let start = usize::try_from(i64_at(message, data_at)?).ok()?;
                    let length = if kind == BOOL { rows.div_ceil(8) } else { rows.checked_mul(8)? };
                    table.columns.push((name, values(kind, body.get(start..start.checked_add(length)?)?, rows)));
                }
                return Some(table);
            }
            _ => return None,
        }
        at = body_at + body.len();
    }
}

/// The type of a field, where it is one that is read.
fn field_kind(field: &Node<'_>) -> Option<u8> {
    let kind = *field.bytes.get(field.slot(2)?)?;
    let first = field.table(3)?;
    let parameter = first.slot(0).and_then(|at| field.bytes.get(at));
    // Double precision; 64 bits.
    let is_read = match kind {
        FLOATING_POINT => parameter == Some(&2),
        INT => parameter == Some(&64),
        other => other == BOOL,
    };
    is_read.then_some(kind)
}

fn values(kind: u8, data: &[u8], rows: usize) -> Values {
    let (numbers, _) = data.as_chunks::<8>();
    match kind {
        FLOATING_POINT => Values::Reals(numbers.iter().map(|bytes| f64::from_le_bytes(*bytes)).collect()),
        INT => Values::Integers(numbers.iter().map(|bytes| i64::from_le_bytes(*bytes)).collect()),
        _ => Values::Booleans((0..rows).map(|row| data[row / 8] >> (row % 8) & 1 == 1).collect()),
    }
}

/// Writes a stream of one batch; the columns are of one length.
pub fn write(columns: &[(String, Values)]) -> Vec<u8> {
    let mut stream = Vec::new();
    push_message(&mut stream, schema(columns), &[]);
    let (message, body) = batch(columns);
    push_message(&mut stream, message, &body);
    stream.extend_from_slice(&CONTINUED.to_le_bytes());
    stream.extend_from_slice(&[0; 4]);
    stream
}

fn push_message(stream: &mut Vec<u8>, mut message: Vec<u8>, body: &[u8]) {
    message.resize(message.len().next_multiple_of(8), 0);
    stream.extend_from_slice(&CONTINUED.to_le_bytes());
    stream.extend_from_slice(&(message.len() as u32).to_le_bytes());
    stream.extend_from_slice(&message);
    stream.extend_from_slice(body);
}

/// Writes the message table with a header of a kind, still to be linked.
fn message(out: &mut Builder, kind: u8, body_bytes: i64) -> usize {
    let at = out.table(&[Cell::Short(V5), Cell::Byte(kind), Cell::Offset, Cell::Long(body_bytes)]);
    out.link(0, at);
    at
}

fn schema(columns: &[(String, Values)]) -> Vec<u8> {
    let mut out = Builder::new();
    let message = message(&mut out, SCHEMA, 0);
    let schema = out.table(&[Cell::Absent, Cell::Offset]);
    out.link_cell(message, 2, schema);
    let fields = out.offsets(columns.len());
    out.link_cell(schema, 1, fields);
    for (k, (name, column)) in columns.iter().enumerate() {
        let kind = match column {
            Values::Reals(_) => FLOATING_POINT,
            Values::Integers(_) => INT,
            Values::Booleans(_) => BOOL,
            Values::Texts(_) => UTF8,
            Values::Bytes(_) => BINARY,
        };
        let field =
            out.table(&[Cell::Offset, Cell::Byte(0), Cell::Byte(kind), Cell::Offset, Cell::Absent, Cell::Offset]);
        out.link(fields + 4 + 4 * k, field);
        let name = out.text(name);
        out.link_cell(field, 0, name);
        let of_kind = match kind {
            FLOATING_POINT => out.table(&[Cell::Short(2)]),
            INT => out.table(&[Cell::Word(64), Cell::Byte(1)]),
            _ => out.table(&[]),
        };
        out.link_cell(field, 3, of_kind);
        let children = out.offsets(0);
        out.link_cell(field, 5, children);
    }
    out.0
}

fn batch(columns: &[(String, Values)]) -> (Vec<u8>, Vec<u8>) {
    let (mut body, mut buffers) = (Vec::new(), Vec::new());
    let mut add = |bytes: &[u8]| {
        buffers.push([body.len() as i64, bytes.len() as i64]);
        body.extend_from_slice(bytes);
        body.resize(body.len().next_multiple_of(64), 0);
    };
    let mut rows = 0;
    for (_, column) in columns {
        add(&[]);
        match column {
            Values::Reals(values) => {
                rows = values.len();
                add(&values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<u8>>());
            }
            Values::Integers(values) => {
                rows = values.len();
                add(&values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<u8>>());
            }
            Values::Booleans(values) => {
                rows = values.len();
                let mut bits = vec![0_u8; rows.div_ceil(8)];
                (0..rows).filter(|row| values[*row]).for_each(|row| bits[row / 8] |= 1 << (row % 8));
                add(&bits);
            }
            Values::Texts(values) => {
                rows = values.len();
                add(&ends_of(values.iter().map(String::len)));
                add(values.concat().as_bytes());
            }
            Values::Bytes(values) => {
                rows = values.len();
                add(&ends_of(values.iter().map(Vec::len)));
                add(&values.concat());
            }
        }
    }
    let mut out = Builder::new();
    let message = message(&mut out, RECORD_BATCH, body.len() as i64);
    let batch = out.table(&[Cell::Long(rows as i64), Cell::Offset, Cell::Offset]);
    out.link_cell(message, 2, batch);
    let nodes = out.pairs(&vec![[rows as i64, 0]; columns.len()]);
    out.link_cell(batch, 1, nodes);
    let buffers = out.pairs(&buffers);
    out.link_cell(batch, 2, buffers);
    (out.0, body)
}

/// Where each of some texts begins and ends when all stand one behind the other.
fn ends_of(lengths: impl Iterator<Item = usize>) -> Vec<u8> {
    let mut ends = vec![0_i32];
    lengths.for_each(|length| ends.push(ends[ends.len() - 1] + length as i32));
    ends.iter().flat_map(|end| end.to_le_bytes()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_read_back_and_damage_is_refused_without_a_panic() {
        let columns = [
            ("a", Values::Reals(vec![1.0, -2.5, 3.0])),
            ("longer_name", Values::Integers(vec![0, i64::MAX, -7])),
            ("truths", Values::Booleans(vec![true, false, true])),
        ];
        let columns = columns.map(|(name, values)| (name.to_owned(), values));
        let stream = write(&columns);
        let table = read(&stream).unwrap();
        assert_eq!((table.rows, &table.columns[..]), (3, &columns[..]));
        for at in 0..stream.len() {
            let _ = read(&stream[..at]);
            for bit in [1, 0x80] {
                let mut damaged = stream.clone();
                damaged[at] ^= bit;
                let _ = read(&damaged);
            }
        }
    }
}
