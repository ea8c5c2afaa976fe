//! The gate of requests: so many at a time, so many a minute.

use crate::config::ServerConfig;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Longest wait before the caller looks whether the run is stopping.
const LOOK_AGAIN: Duration = Duration::from_millis(50);

/// Lets requests pass.
#[derive(Debug, Default)]
pub struct Gate {
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Debug, Default)]
struct State {
    running: u32,
    /// Earliest start of the next request.
    next: Option<Instant>,
}

/// A request that passed; leaves when dropped.
#[derive(Debug)]
pub struct Passed<'a>(&'a Gate);

impl Gate {
    /// Waits until a request may start; the error of `keep_going` ends the wait.
    pub fn pass<E>(&self, config: &ServerConfig, keep_going: &dyn Fn() -> Result<(), E>) -> Result<Passed<'_>, E> {
        let mut state = self.locked();
        loop {
            keep_going()?;
            let now = Instant::now();
            let wait = state.next.map_or(Duration::ZERO, |next| next.saturating_duration_since(now));
            if state.running < config.concurrency && wait.is_zero() {
                break;
            }
            let wait = if wait.is_zero() { LOOK_AGAIN } else { wait.min(LOOK_AGAIN) };
            state = self.changed.wait_timeout(state, wait).unwrap_or_else(PoisonError::into_inner).0;
        }
        state.running += 1;
        if config.per_minute > 0 {
            state.next = Some(Instant::now() + Duration::from_secs(60) / config.per_minute);
        }
        Ok(Passed(self))
    }

    fn locked(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for Passed<'_> {
    fn drop(&mut self) {
        self.0.locked().running -= 1;
        self.0.changed.notify_one();
    }
}

/// Sleeps, in short pieces; the error of `keep_going` ends the sleep.
pub fn pause<E>(time: Duration, keep_going: &dyn Fn() -> Result<(), E>) -> Result<(), E> {
    let end = Instant::now() + time;
    loop {
        keep_going()?;
        let left = end.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Ok(());
        }
        std::thread::sleep(left.min(LOOK_AGAIN));
    }
}
