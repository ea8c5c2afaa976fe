//! [`Bytes`]: numbers at places of a byte slice; a place beyond its end is an error, never a panic.

use cosfly_diagnose::counted;
use cosfly_town::MapError;

/// Bytes of a file.
#[derive(Clone, Copy, Debug)]
pub struct Bytes<'a>(pub &'a [u8]);

impl<'a> Bytes<'a> {
    /// `length` bytes from `start` on; `what` names them in the error.
    ///
    /// # Errors
    /// The file ends before them.
    pub fn slice(self, start: u64, length: u64, what: &str) -> Result<&'a [u8], MapError> {
        let range = || Some(usize::try_from(start).ok()?..usize::try_from(start.checked_add(length)?).ok()?);
        range().and_then(|range| self.0.get(range)).ok_or_else(|| {
            let message = format!(
                "the file ends before {what}: {length} from byte {start} on, of {}",
                self.0.len(),
                length = counted(length, "byte")
            );
            MapError::new(message).hint("the file seems to be cut off: fetch or export it again")
        })
    }

    /// An array of `N` bytes.
    ///
    /// # Errors
    /// Those of [`Self::slice`].
    pub fn array<const N: usize>(self, start: u64, what: &str) -> Result<[u8; N], MapError> {
        let mut out = [0; N];
        out.copy_from_slice(self.slice(start, N as u64, what)?);
        Ok(out)
    }

    /// A little-endian number of two bytes.
    ///
    /// # Errors
    /// Those of [`Self::slice`].
    pub fn u16(self, start: u64, what: &str) -> Result<u16, MapError> {
        self.array(start, what).map(u16::from_le_bytes)
    }

    /// A little-endian number of four bytes.
    ///
    /// # Errors
    /// Those of [`Self::slice`].
    pub fn u32(self, start: u64, what: &str) -> Result<u32, MapError> {
        self.array(start, what).map(u32::from_le_bytes)
    }

    /// A little-endian number of eight bytes.
    ///
    /// # Errors
    /// Those of [`Self::slice`].
    pub fn u64(self, start: u64, what: &str) -> Result<u64, MapError> {
        self.array(start, what).map(u64::from_le_bytes)
    }

    /// A little-endian real number of eight bytes.
    ///
    /// # Errors
    /// Those of [`Self::slice`].
    pub fn f64(self, start: u64, what: &str) -> Result<f64, MapError> {
        self.array(start, what).map(f64::from_le_bytes)
    }
}
