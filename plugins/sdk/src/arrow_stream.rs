//! The little of Arrow streams that stages need: one record batch of floats, integers and truths in; of those, texts or bytes out.
//!
//! The whole library would make plugins of a hundred kilobytes into some of two megabytes. Layout: Arrow columnar format 1.5,
//! IPC streams; messages are Flatbuffers.

/// The values of a column.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// 64-bit floats.
    Reals(Vec<f64>),
    /// 64-bit integers.
    Integers(Vec<i64>),
    /// Truths.
    Booleans(Vec<bool>),
    /// Texts.
    Texts(Vec<String>),
    /// Bytes.
    Bytes(Vec<Vec<u8>>),
}

/// What is read: the schema's metadata, and the columns.
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
/// What of it is not as in the interface.
pub fn read(stream: &[u8]) -> Result<Table, String> {
    read_checked(stream).ok_or_else(|| "the flight is no Arrow stream of floats, integers and truths".to_owned())
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

fn u32_at(bytes: &[u8], at: usize) -> Option<u32> {
    Some(u32::from_le_bytes(*bytes.get(at..)?.first_chunk()?))
}

fn i64_at(bytes: &[u8], at: usize) -> Option<i64> {
    Some(i64::from_le_bytes(*bytes.get(at..)?.first_chunk()?))
}

fn u16_at(bytes: &[u8], at: usize) -> Option<usize> {
    Some(usize::from(u16::from_le_bytes(*bytes.get(at..)?.first_chunk()?)))
}

/// A Flatbuffers table.
#[derive(Clone, Copy)]
struct Node<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Node<'a> {
    /// Where a slot's value is; none when it has its default.
    fn slot(&self, slot: usize) -> Option<usize> {
        let back = u32_at(self.bytes, self.at)? as i32;
        let directory = usize::try_from(i64::try_from(self.at).ok()? - i64::from(back)).ok()?;
        if 4 + 2 * slot >= u16_at(self.bytes, directory)? {
            return None;
        }
        let offset = u16_at(self.bytes, directory + 4 + 2 * slot)?;
        (offset > 0).then_some(self.at + offset)
    }

    /// What a slot's offset leads to.
    fn vector(&self, slot: usize) -> Option<usize> {
        let at = self.slot(slot)?;
        at.checked_add(u32_at(self.bytes, at)? as usize)
    }

    fn table(&self, slot: usize) -> Option<Node<'a>> {
        Some(Node { bytes: self.bytes, at: self.vector(slot)? })
    }

    fn tables(&self, slot: usize) -> Option<Vec<Node<'a>>> {
        let start = self.vector(slot)?;
        let count = u32_at(self.bytes, start)? as usize;
        (0..count)
            .map(|k| {
                let at = start + 4 + 4 * k;
                Some(Node { bytes: self.bytes, at: at.checked_add(u32_at(self.bytes, at)? as usize)? })
            })
            .collect()
    }

    fn text(&self, slot: usize) -> Option<String> {
        let start = self.vector(slot)?;
        let length = u32_at(self.bytes, start)? as usize;
        String::from_utf8(self.bytes.get(start + 4..(start + 4).checked_add(length)?)?.to_vec()).ok()
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

/// The value of a table's slot.
#[derive(Clone, Copy)]
enum Cell {
    Absent,
    Byte(u8),
    Short(i16),
    Word(i32),
    Long(i64),
    /// Filled in when its target is written.
    Offset,
}

/// Writes Flatbuffers from front to back: every value in a cell of eight bytes, offsets filled in later.
struct Builder(Vec<u8>);

impl Builder {
    /// A buffer whose root is the next table.
    fn new() -> Self {
        Self(vec![0; 8])
    }

    fn align(&mut self, to: usize, extra: usize) {
        while !(self.0.len() + extra).is_multiple_of(to) {
            self.0.push(0);
        }
    }

    /// Writes a table; its cells begin 8 bytes after the place that is returned.
    fn table(&mut self, cells: &[Cell]) -> usize {
        let directory_bytes = 4 + 2 * cells.len();
        self.align(8, directory_bytes);
        let directory = self.0.len();
        self.0.extend_from_slice(&(directory_bytes as u16).to_le_bytes());
        self.0.extend_from_slice(&(8 * (cells.len() + 1) as u16).to_le_bytes());
        for (k, cell) in cells.iter().enumerate() {
            let offset = if matches!(cell, Cell::Absent) { 0 } else { 8 * (k + 1) as u16 };
            self.0.extend_from_slice(&offset.to_le_bytes());
        }
        let at = self.0.len();
        self.0.extend_from_slice(&((at - directory) as i32).to_le_bytes());
        self.0.extend_from_slice(&[0; 4]);
        for cell in cells {
            let mut bytes = [0; 8];
            match cell {
                Cell::Byte(value) => bytes[0] = *value,
                Cell::Short(value) => bytes[..2].copy_from_slice(&value.to_le_bytes()),
                Cell::Word(value) => bytes[..4].copy_from_slice(&value.to_le_bytes()),
                Cell::Long(value) => bytes = value.to_le_bytes(),
                Cell::Absent | Cell::Offset => {}
            }
            self.0.extend_from_slice(&bytes);
        }
        at
    }

    /// Lets the offset at a place lead to what is written next or was just written at `to`.
    fn link(&mut self, from: usize, to: usize) {
        self.0[from..from + 4].copy_from_slice(&((to - from) as u32).to_le_bytes());
    }

    fn link_cell(&mut self, table: usize, slot: usize, to: usize) {
        self.link(table + 8 * (slot + 1), to);
    }

    fn text(&mut self, text: &str) -> usize {
        self.align(4, 0);
        let at = self.0.len();
        self.0.extend_from_slice(&(text.len() as u32).to_le_bytes());
        self.0.extend_from_slice(text.as_bytes());
        self.0.push(0);
        at
    }

    /// A vector of offsets, filled in later.
    fn offsets(&mut self, count: usize) -> usize {
        self.align(4, 0);
        let at = self.0.len();
        self.0.extend_from_slice(&(count as u32).to_le_bytes());
        self.0.resize(at + 4 + 4 * count, 0);
        at
    }

    /// A vector of pairs of 64-bit numbers.
    fn pairs(&mut self, pairs: &[[i64; 2]]) -> usize {
        self.align(8, 4);
        let at = self.0.len();
        self.0.extend_from_slice(&(pairs.len() as u32).to_le_bytes());
        pairs.iter().flatten().for_each(|number| self.0.extend_from_slice(&number.to_le_bytes()));
        at
    }

    /// The message table with its header of a kind, still to be linked.
    fn message(&mut self, kind: u8, body_bytes: i64) -> usize {
        let at = self.table(&[Cell::Short(V5), Cell::Byte(kind), Cell::Offset, Cell::Long(body_bytes)]);
        self.link(0, at);
        at
    }
}

fn schema(columns: &[(String, Values)]) -> Vec<u8> {
    let mut out = Builder::new();
    let message = out.message(SCHEMA, 0);
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
    let message = out.message(RECORD_BATCH, body.len() as i64);
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
