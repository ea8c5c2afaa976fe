//! Flatbuffers, as far as Arrow streams need them: tables, vectors, texts.

pub fn u32_at(bytes: &[u8], at: usize) -> Option<u32> {
    Some(u32::from_le_bytes(*bytes.get(at..)?.first_chunk()?))
}

pub fn i64_at(bytes: &[u8], at: usize) -> Option<i64> {
    Some(i64::from_le_bytes(*bytes.get(at..)?.first_chunk()?))
}

pub fn u16_at(bytes: &[u8], at: usize) -> Option<usize> {
    Some(usize::from(u16::from_le_bytes(*bytes.get(at..)?.first_chunk()?)))
}

/// A Flatbuffers table.
#[derive(Clone, Copy)]
pub struct Node<'a> {
    pub bytes: &'a [u8],
    pub at: usize,
}

impl<'a> Node<'a> {
    /// Where a slot's value is; none when it has its default.
    pub fn slot(&self, slot: usize) -> Option<usize> {
        let back = u32_at(self.bytes, self.at)? as i32;
        let directory = usize::try_from(i64::try_from(self.at).ok()? - i64::from(back)).ok()?;
        if 4 + 2 * slot >= u16_at(self.bytes, directory)? {
            return None;
        }
        let offset = u16_at(self.bytes, directory + 4 + 2 * slot)?;
        (offset > 0).then_some(self.at + offset)
    }

    /// Target of a slot's offset.
    pub fn vector(&self, slot: usize) -> Option<usize> {
        let at = self.slot(slot)?;
        at.checked_add(u32_at(self.bytes, at)? as usize)
    }

    pub fn table(&self, slot: usize) -> Option<Node<'a>> {
        Some(Node { bytes: self.bytes, at: self.vector(slot)? })
    }

    pub fn tables(&self, slot: usize) -> Option<Vec<Node<'a>>> {
        let start = self.vector(slot)?;
        let count = u32_at(self.bytes, start)? as usize;
        (0..count)
            .map(|k| {
                let at = start + 4 + 4 * k;
                Some(Node { bytes: self.bytes, at: at.checked_add(u32_at(self.bytes, at)? as usize)? })
            })
            .collect()
    }

    pub fn text(&self, slot: usize) -> Option<String> {
        let start = self.vector(slot)?;
        let length = u32_at(self.bytes, start)? as usize;
        String::from_utf8(self.bytes.get(start + 4..(start + 4).checked_add(length)?)?.to_vec()).ok()
    }
}

/// The value of a table's slot.
#[derive(Clone, Copy)]
pub enum Cell {
    Absent,
    Byte(u8),
    Short(i16),
    Word(i32),
    Long(i64),
    /// Filled in when its target is written.
    Offset,
}

/// Writes Flatbuffers from front to back: every value in a cell of eight bytes, offsets filled in later.
pub struct Builder(pub Vec<u8>);

impl Builder {
    /// A buffer whose root is the next table.
    pub fn new() -> Self {
        Self(vec![0; 8])
    }

    pub fn align(&mut self, to: usize, extra: usize) {
        while !(self.0.len() + extra).is_multiple_of(to) {
            self.0.push(0);
        }
    }

    /// Writes a table; its cells begin 8 bytes after the place that is returned.
    pub fn table(&mut self, cells: &[Cell]) -> usize {
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
    pub fn link(&mut self, from: usize, to: usize) {
        self.0[from..from + 4].copy_from_slice(&((to - from) as u32).to_le_bytes());
    }

    pub fn link_cell(&mut self, table: usize, slot: usize, to: usize) {
        self.link(table + 8 * (slot + 1), to);
    }

    pub fn text(&mut self, text: &str) -> usize {
        self.align(4, 0);
        let at = self.0.len();
        self.0.extend_from_slice(&(text.len() as u32).to_le_bytes());
        self.0.extend_from_slice(text.as_bytes());
        self.0.push(0);
        at
    }

    /// A vector of offsets, filled in later.
    pub fn offsets(&mut self, count: usize) -> usize {
        self.align(4, 0);
        let at = self.0.len();
        self.0.extend_from_slice(&(count as u32).to_le_bytes());
        self.0.resize(at + 4 + 4 * count, 0);
        at
    }

    /// A vector of pairs of 64-bit numbers.
    pub fn pairs(&mut self, pairs: &[[i64; 2]]) -> usize {
        self.align(8, 4);
        let at = self.0.len();
        self.0.extend_from_slice(&(pairs.len() as u32).to_le_bytes());
        pairs.iter().flatten().for_each(|number| self.0.extend_from_slice(&number.to_le_bytes()));
        at
    }
}
