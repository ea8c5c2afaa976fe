//! [`contained`]: work that may panic on damaged bytes, without a word on the standard error stream.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::sync::Once;

thread_local! {
    static IS_CONTAINED: Cell<bool> = const { Cell::new(false) };
}

static HOOK: Once = Once::new();

/// Result of the work; none if it panics. Panics of other threads and of other work are printed as before.
pub fn contained<T>(work: impl FnOnce() -> T) -> Option<T> {
    HOOK.call_once(|| {
        let usual = take_hook();
        set_hook(Box::new(move |panic| {
            if !IS_CONTAINED.get() {
                usual(panic);
            }
        }));
    });
    let was_contained = IS_CONTAINED.replace(true);
    let result = catch_unwind(AssertUnwindSafe(work));
    IS_CONTAINED.set(was_contained);
    result.ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_that_panics_gives_nothing_and_work_around_it_goes_on() {
        assert_eq!(contained(|| 3), Some(3));
        let around = contained(|| {
            let inner: Option<u8> = contained(|| panic!("damaged"));
            assert!(IS_CONTAINED.get() && inner.is_none());
            4
        });
        assert_eq!(around, Some(4));
        assert!(!IS_CONTAINED.get());
    }
}
