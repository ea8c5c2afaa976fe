//! Values at the border between a plugin and cosfly: the canonical ABI of WebAssembly's component model, as far as the interface needs it.
//!
//! Lists and texts are an address and a length. What comes in was put into memory by [`room`] and belongs to the plugin; what goes out
//! stays where it is until the next answer.

use std::alloc::Layout;
use std::any::Any;
use std::cell::RefCell;

/// Room in memory for the host: of the size `new`, in place of the `old` bytes at `block`.
///
/// # Safety
/// `block` came from here, with the same `align` and the size `old`.
pub unsafe fn room(block: *mut u8, old: usize, align: usize, new: usize) -> *mut u8 {
    if new == 0 {
        return std::ptr::without_provenance_mut(align);
    }
    // SAFETY: the sizes are not 0, and the caller vouches for the block.
    let room = unsafe {
        let layout = |size| Layout::from_size_align_unchecked(size, align);
        if old == 0 { std::alloc::alloc(layout(new)) } else { std::alloc::realloc(block, layout(old), new) }
    };
    if room.is_null() {
        std::process::abort();
    }
    room
}

/// A list that came in.
///
/// # Safety
/// `at` and `count` describe one that was put there by [`room`], and nobody else takes it.
pub unsafe fn list<T>(at: *mut T, count: usize) -> Vec<T> {
    // SAFETY: as the caller vouches.
    unsafe { Vec::from_raw_parts(at, count, count) }
}

/// A text that came in.
///
/// # Safety
/// As for [`list`]; the host gives UTF-8.
pub unsafe fn text(at: *mut u8, bytes: usize) -> String {
    // SAFETY: as the caller vouches.
    unsafe { String::from_utf8_unchecked(list(at, bytes)) }
}

/// A list that the host answers through `ask`, which is told where to write address and length.
#[cfg(target_family = "wasm")]
pub fn answered<T>(ask: impl FnOnce(*mut [usize; 2])) -> Vec<T> {
    let mut place = [0; 2];
    ask(&raw mut place);
    // SAFETY: the host has put the list there for the plugin.
    unsafe { list(std::ptr::with_exposed_provenance_mut(place[0]), place[1]) }
}

/// A refusal of a plugin.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// The parameters contradict each other.
    InvalidParams(String),
    /// Any other reason.
    Failed(String),
}

/// An answer: records laid out as 32-bit words, and the lists and texts that they lead to.
#[derive(Default)]
pub struct Answer {
    words: Vec<usize>,
    kept: Vec<Box<dyn Any>>,
}

impl Answer {
    /// The answer of a function that can fail: what `write` adds, or the refusal.
    pub fn outcome<T>(outcome: Result<T, Refusal>, write: impl FnOnce(Self, T) -> Self) -> Self {
        match outcome {
            Ok(value) => write(Self::default().word(0), value),
            Err(Refusal::InvalidParams(words)) => Self::default().word(1).word(0).text(words),
            Err(Refusal::Failed(words)) => Self::default().word(1).word(2).text(words),
        }
    }

    /// Adds a number, a truth, or the number of a case.
    pub fn word(mut self, word: usize) -> Self {
        self.words.push(word);
        self
    }

    /// Adds a text.
    pub fn text(self, text: impl Into<String>) -> Self {
        self.list(text.into().into_bytes())
    }

    /// Adds a list of numbers or bytes.
    pub fn list<T: 'static>(self, list: Vec<T>) -> Self {
        let count = list.len();
        self.counted(count, list)
    }

    /// Adds a list of records, each written by `write`.
    pub fn records<T>(mut self, items: Vec<T>, write: impl Fn(Self, T) -> Self) -> Self {
        let (count, mut all) = (items.len(), Self::default());
        for item in items {
            all = write(all, item);
        }
        self.kept.append(&mut all.kept);
        self.counted(count, all.words)
    }

    fn counted<T: 'static>(mut self, count: usize, list: Vec<T>) -> Self {
        self.words.extend([list.as_ptr().expose_provenance(), count]);
        self.kept.push(Box::new(list));
        self
    }

    /// Hands the answer over: its address. It stays until the next one.
    pub fn leave(self) -> *const usize {
        thread_local! {
            static LAST: RefCell<Answer> = const { RefCell::new(Answer { words: vec![], kept: vec![] }) };
        }
        let at = self.words.as_ptr();
        LAST.replace(self);
        at
    }
}

/// Gives cosfly room in the plugin's memory; part of every plugin.
#[doc(hidden)]
#[macro_export]
macro_rules! border {
    () => {
        #[unsafe(export_name = "cabi_realloc")]
        unsafe extern "C" fn room(block: *mut u8, old: usize, align: usize, new: usize) -> *mut u8 {
            // SAFETY: the host keeps to the canonical ABI.
            unsafe { $crate::macros::abi::room(block, old, align, new) }
        }
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_are_words_that_lead_to_their_texts() {
        let names = vec!["one".to_owned(), "three".to_owned()];
        let answer = Answer::outcome(Ok(names), |all, names| all.records(names, |all, name| all.word(7).text(name)));
        let [0, records, 2] = answer.words[..] else { panic!("{:?}", answer.words) };
        // SAFETY: the records are kept with the answer.
        let words: &[[usize; 3]] = unsafe { std::slice::from_raw_parts(std::ptr::with_exposed_provenance(records), 2) };
        let lengths = words.iter().map(|[number, _, length]| (*number, *length));
        assert_eq!(lengths.collect::<Vec<_>>(), [(7, 3), (7, 5)]);
        let refusal: Result<(), Refusal> = Err(Refusal::Failed("no".to_owned()));
        assert_eq!(Answer::outcome(refusal, |all, ()| all).words[..2], [1, 2]);
    }
}
