//! [`Copies`]: columns of results on their way into arrays of others.

/// Bytes that one thread copies at a time.
const COPIED_AT_ONCE: usize = 1 << 17;

/// One piece of a column, ready to be copied.
type Piece<'a> = Box<dyn FnMut() + Send + 'a>;

/// Columns that are copied together, so that threads are woken once.
#[derive(Default)]
pub struct Copies<'a> {
    pub(super) pieces: Vec<Piece<'a>>,
    bytes: usize,
}

impl<'a> Copies<'a> {
    /// One more column.
    ///
    /// # Panics
    /// If the lengths differ.
    pub fn add<T: Copy + Send + Sync>(&mut self, to: &'a mut [T], from: &'a [T]) {
        assert_eq!(to.len(), from.len(), "a column and its array");
        self.bytes += size_of_val(from);
        let length = COPIED_AT_ONCE / size_of::<T>().max(1);
        let pieces = to.chunks_mut(length).zip(from.chunks(length));
        self.pieces.extend(pieces.map(|(to, from)| -> Piece<'a> { Box::new(move || to.copy_from_slice(from)) }));
    }

    /// Whether there is enough for several threads.
    pub(super) fn is_much(&self) -> bool {
        self.bytes > 2 * COPIED_AT_ONCE
    }
}
