//! An allocator that hands freed blocks out again as they are: every call of a plugin asks for the same sizes.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::ptr::null_mut;

/// Blocks that are kept, and the largest that is, bytes.
const KEPT: usize = 4;
const LARGEST: usize = 1 << 16;

/// The system's allocator behind a few blocks that were freed last.
pub struct RecentBlocks {
    kept: [Cell<(*mut u8, usize, usize)>; KEPT],
    next: Cell<usize>,
}

// SAFETY: a plugin has one thread.
#[cfg(target_family = "wasm")]
unsafe impl Sync for RecentBlocks {}

impl RecentBlocks {
    pub const fn new() -> Self {
        Self { kept: [const { Cell::new((null_mut(), 0, 0)) }; KEPT], next: Cell::new(0) }
    }
}

// SAFETY: every block comes from the system's allocator and is either with the caller or kept, with the layout that it was asked
// for; kept ones are handed out for that layout only, or freed.
unsafe impl GlobalAlloc for RecentBlocks {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        for kept in &self.kept {
            let (block, size, align) = kept.get();
            if size == layout.size() && align == layout.align() {
                kept.set((null_mut(), 0, 0));
                return block;
            }
        }
        // SAFETY: as the caller promises.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        if layout.size() > LARGEST {
            // SAFETY: as the caller promises; the block is not kept.
            return unsafe { System.dealloc(block, layout) };
        }
        let next = self.next.get();
        self.next.set((next + 1) % KEPT);
        let (old, size, align) = self.kept[next].replace((block, layout.size(), layout.align()));
        if !old.is_null() {
            // SAFETY: it was kept with this layout.
            unsafe { System.dealloc(old, Layout::from_size_align_unchecked(size, align)) }
        }
    }

    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: as the caller promises; the block is with the caller.
        unsafe { System.realloc(block, layout, size) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn freed_blocks_are_handed_out_again_for_their_own_layout_only() {
        let blocks = RecentBlocks::new();
        let layout = |size: usize, align: usize| Layout::from_size_align(size, align).unwrap();
        let (small, large) = (layout(64, 8), layout(2 * LARGEST, 8));
        // SAFETY: every block is freed once, with the layout that it was asked for.
        unsafe {
            let first = blocks.alloc(small);
            blocks.dealloc(first, small);
            let others = [blocks.alloc(layout(64, 16)), blocks.alloc(layout(72, 8)), blocks.alloc(large)];
            assert!(!others.contains(&first));
            let again = blocks.alloc(small);
            assert_eq!(again, first);
            blocks.dealloc(again, small);
            blocks.dealloc(others[0], layout(64, 16));
            blocks.dealloc(others[1], layout(72, 8));
            blocks.dealloc(others[2], large);
            // More than are kept: the oldest are freed, none twice.
            let many: Vec<*mut u8> = (1..20).map(|k| blocks.alloc(layout(8 * k, 8))).collect();
            many.into_iter().enumerate().for_each(|(k, block)| blocks.dealloc(block, layout(8 * (k + 1), 8)));
        }
    }
}
