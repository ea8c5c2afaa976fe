//! How numbers and texts get into and out of a core module's memory: the part of the component model's canonical ABI that
//! cost terms need. Nothing that the module says of its memory is trusted.

use crate::interface_0_1::{Metadata, Refusal};
use cosfly_diagnose::counted;
use cosfly_frames::DVec3;
use std::mem::offset_of;
use std::ops::Range;
use wasmtime::{AsContext, AsContextMut, Memory, Result, TypedFunc, bail};

type Realloc = TypedFunc<(u32, u32, u32, u32), u32>;

/// The memory of an instance, and how it gives room in it.
#[derive(Clone)]
pub struct DirectAbi {
    /// The memory.
    pub memory: Memory,
    /// `cabi_realloc`: old address, old size, alignment, new size.
    pub realloc: Realloc,
}

impl DirectAbi {
    fn room(&self, mut store: impl AsContextMut, align: u32, bytes: usize) -> Result<(u32, Range<usize>)> {
        let Ok(size) = u32::try_from(bytes) else { bail!("{bytes} bytes are more than its memory can hold") };
        let at = self.realloc.call(&mut store, (0, 0, align, size))?;
        let end = at as usize + bytes;
        if !at.is_multiple_of(align) || end > self.memory.data_size(&store) {
            bail!("`cabi_realloc` gave the address {at} for {bytes}", bytes = counted(bytes, "byte"));
        }
        Ok((at, at as usize..end))
    }

    /// Gives the plugin points, 3 numbers each: address and count of numbers.
    pub fn put_points(&self, mut store: impl AsContextMut, points: &[DVec3]) -> Result<(u32, u32)> {
        let (at, range) = self.room(&mut store, 8, 24 * points.len())?;
        self.memory.data_mut(&mut store)[range].copy_from_slice(bytes_of(points));
        Ok((at, 3 * points.len() as u32))
    }

    /// Gives the plugin numbers: address and count.
    pub fn put_numbers(&self, mut store: impl AsContextMut, numbers: &[f64]) -> Result<(u32, u32)> {
        let (at, range) = self.room(&mut store, 8, 8 * numbers.len())?;
        let (places, _) = self.memory.data_mut(&mut store)[range].as_chunks_mut::<8>();
        places.iter_mut().zip(numbers).for_each(|(place, number)| *place = number.to_le_bytes());
        Ok((at, numbers.len() as u32))
    }

    /// Gives the plugin a text: address and bytes.
    pub fn put_text(&self, mut store: impl AsContextMut, text: &str) -> Result<(u32, u32)> {
        let (at, range) = self.room(&mut store, 1, text.len())?;
        self.memory.data_mut(&mut store)[range].copy_from_slice(text.as_bytes());
        Ok((at, text.len() as u32))
    }

    /// Writes the answer of a host function, a list of numbers, where the plugin waits for it.
    pub fn answer(&self, mut store: impl AsContextMut, to: u32, numbers: &[f64]) -> Result<()> {
        let (at, count) = self.put_numbers(&mut store, numbers)?;
        let memory = self.memory.data_mut(&mut store);
        let Some(place) = memory.get_mut(to as usize..to as usize + 8).filter(|_| to.is_multiple_of(4)) else {
            bail!("it wants an answer at the address {to}, outside its memory");
        };
        place[..4].copy_from_slice(&at.to_le_bytes());
        place[4..].copy_from_slice(&count.to_le_bytes());
        Ok(())
    }

    /// Answer of the plugin at `at`, aligned for pointers.
    pub fn read<'a, T: 'static>(&self, store: impl Into<wasmtime::StoreContext<'a, T>>, at: u32) -> Result<Answer<'a>> {
        if !at.is_multiple_of(4) {
            bail!("its answer is at the address {at}, which is not a multiple of 4");
        }
        Ok(Answer { memory: self.memory.data(store), at: at as usize })
    }

    /// A list of numbers that the plugin gives to a host function.
    pub fn numbers(&self, store: impl AsContext, at: u32, count: u32) -> Result<Vec<f64>> {
        Ok(list_at(self.memory.data(&store), at, count)?.numbers().collect())
    }

    /// A text that the plugin gives to a host function.
    pub fn text(&self, store: impl AsContext, at: u32, bytes: u32) -> Result<String> {
        text_at(self.memory.data(&store), at, bytes)
    }
}

/// The numbers of points in a row, as WebAssembly's memory holds them.
#[cfg(target_endian = "little")]
fn bytes_of(points: &[DVec3]) -> &[u8] {
    const { assert!(size_of::<DVec3>() == 24 && offset_of!(DVec3, y) == 8 && offset_of!(DVec3, z) == 16) };
    // SAFETY: a point is three numbers and nothing between them, as was just asserted; numbers are bytes.
    unsafe { std::slice::from_raw_parts(points.as_ptr().cast(), size_of_val(points)) }
}

/// A record in a plugin's memory.
pub struct Answer<'a> {
    memory: &'a [u8],
    at: usize,
}

/// Numbers in a plugin's memory.
pub struct List<'a>(&'a [[u8; 8]]);

impl<'a> List<'a> {
    /// How many.
    pub fn count(&self) -> usize {
        self.0.len()
    }

    /// The numbers in order.
    pub fn numbers(&self) -> impl Iterator<Item = f64> + use<'a> {
        self.0.iter().map(|bytes| f64::from_le_bytes(*bytes))
    }
}

impl Answer<'_> {
    /// The byte at `offset`.
    pub fn byte(&self, offset: usize) -> Result<u8> {
        match self.memory.get(self.at + offset) {
            Some(byte) => Ok(*byte),
            None => bail!("its answer is at the address {}, outside its memory", self.at),
        }
    }

    /// The number of 32 bits at `offset`.
    pub fn word(&self, offset: usize) -> Result<u32> {
        match self.memory.get(self.at + offset..).and_then(|rest| rest.first_chunk::<4>()) {
            Some(word) => Ok(u32::from_le_bytes(*word)),
            None => bail!("its answer is at the address {}, outside its memory", self.at),
        }
    }

    /// The text whose address and length are at `offset`.
    pub fn text(&self, offset: usize) -> Result<String> {
        text_at(self.memory, self.word(offset)?, self.word(offset + 4)?)
    }

    /// The list of numbers whose address and count are at `offset`.
    pub fn list(&self, offset: usize) -> Result<List<'_>> {
        list_at(self.memory, self.word(offset)?, self.word(offset + 4)?)
    }

    /// Whether it is `ok`, or the refusal; both begin at 4.
    pub fn outcome(&self) -> Result<std::result::Result<(), Refusal>> {
        match self.byte(0)? {
            0 => return Ok(Ok(())),
            1 => {}
            other => bail!("it answers neither `ok` nor an error but {other}"),
        }
        let words = self.text(8)?;
        Ok(Err(match self.byte(4)? {
            0 => Refusal::InvalidParams(words),
            1 => Refusal::Unsupported(words),
            2 => Refusal::Failed(words),
            other => bail!("it answers an error of an unknown kind, {other}"),
        }))
    }

    /// Metadata of the plugin.
    pub fn metadata(&self) -> Result<Metadata> {
        let (name, version) = (self.text(0)?, self.text(8)?);
        Ok(Metadata { name, version, summary: self.text(16)?, params_schema: self.text(24)? })
    }
}

fn slice(memory: &[u8], at: u32, bytes: usize) -> Result<&[u8]> {
    match memory.get(at as usize..).and_then(|rest| rest.get(..bytes)) {
        Some(slice) => Ok(slice),
        None => bail!("it gives {bytes} at the address {at}, outside its memory", bytes = counted(bytes, "byte")),
    }
}

fn text_at(memory: &[u8], at: u32, bytes: u32) -> Result<String> {
    match std::str::from_utf8(slice(memory, at, bytes as usize)?) {
        Ok(text) => Ok(text.to_owned()),
        Err(error) => bail!("it gives a text that is not UTF-8: {error}"),
    }
}

fn list_at(memory: &[u8], at: u32, count: u32) -> Result<List<'_>> {
    if !at.is_multiple_of(8) {
        bail!("it gives a list at the address {at}, which is not a multiple of 8");
    }
    Ok(List(slice(memory, at, 8 * count as usize)?.as_chunks().0))
}
