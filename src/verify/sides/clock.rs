//! How long verification may take: in processor time, so that a busy machine decides nothing.

use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

/// What the programs of a library have taken so far, together.
#[derive(Debug, Default)]
pub struct Spent(AtomicU64);

/// What one program may still take.
#[derive(Clone, Copy, Debug)]
pub struct Clock {
    started: Duration,
    limit: Duration,
}

impl Spent {
    /// A clock for the next program: it has so many seconds, or what is left of those of the library.
    pub fn clock(&self, program: f64, library: f64) -> Clock {
        let spent = Duration::from_nanos(self.0.load(Ordering::Relaxed));
        let limit = seconds(program).min(seconds(library).saturating_sub(spent));
        Clock { started: now(), limit }
    }

    /// Adds what a program took.
    pub fn add(&self, clock: &Clock) {
        let taken = clock.taken().as_nanos().try_into().unwrap_or(u64::MAX);
        self.0.fetch_add(taken, Ordering::Relaxed);
    }
}

impl Clock {
    fn taken(&self) -> Duration {
        now().saturating_sub(self.started)
    }

    /// True once the time is up.
    pub fn is_up(&self) -> bool {
        self.taken() >= self.limit
    }

    /// Milliseconds that are left, and one for a run that says so itself.
    pub fn left(&self) -> u64 {
        let left = self.limit.saturating_sub(self.taken());
        u64::try_from(left.as_millis()).unwrap_or(u64::MAX).saturating_add(1)
    }
}

/// A number of seconds; as many as there can be for one that is none.
fn seconds(seconds: f64) -> Duration {
    Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX)
}

/// The processor time of this thread.
#[cfg(target_os = "linux")]
fn now() -> Duration {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    Duration::try_from(time).unwrap_or_default()
}

/// Other systems tell the time of day.
#[cfg(not(target_os = "linux"))]
fn now() -> Duration {
    use std::sync::LazyLock;
    static START: LazyLock<std::time::Instant> = LazyLock::new(std::time::Instant::now);
    START.elapsed()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_library_shares_its_time() {
        let spent = Spent::default();
        assert!(!spent.clock(1000.0, 1000.0).is_up());
        assert!(spent.clock(0.0, 1000.0).is_up());
        assert!(!spent.clock(f64::INFINITY, f64::INFINITY).is_up());
        spent.0.store(2_000_000_000, Ordering::Relaxed);
        assert!(spent.clock(1000.0, 2.0).is_up());
        assert!(spent.clock(1000.0, 3.0).left() <= 1001);
    }
}
