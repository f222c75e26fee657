//! Inputs that change while a program waits for them.
//!
//! A program that waits for a part, and then for its removal, comes to its end with no value of the input that stays as
//! it is. So where a scenario has it so, all inputs change once a program has read one so many times and nothing has
//! happened in between, but for dwells. They change right before that read: both sides of a conversion find the same
//! there, and have gone round as often, in however many blocks each of them waits.
//!
//! A program that looks at an input once more, after it has done something about it, goes on in another way only if the
//! input changes between the two looks. So a scenario may also say before which look that is.

use super::Machine;
use crate::canon::Sys;
use crate::control::Scenario;
use crate::control::trace::{EventKind, Trace};

/// How often a program reads an input before it changes.
const READS: u32 = 64;

/// What is known of the waiting of a program.
#[derive(Clone, Debug, Default)]
pub(super) struct Awaited {
    /// True where inputs change while the program waits for them.
    waits: bool,
    /// Before which look they change.
    at: Option<u32>,
    /// How many looks there were.
    looks: u32,
    /// How often the inputs have changed.
    changes: u64,
    /// The first input that was read since something happened.
    first: Option<First>,
}

#[derive(Clone, Copy, Debug)]
struct First {
    number: u32,
    /// How much had happened.
    happened: usize,
    /// How often it was read since.
    reads: u32,
}

impl Awaited {
    /// What a scenario says of its inputs; none if they stay as they are.
    pub(super) fn of(scenario: &Scenario) -> Option<Self> {
        let Scenario { inputs_change: waits, inputs_change_at: at, .. } = *scenario;
        (waits || at.is_some()).then(|| Self { waits, at, ..Self::default() })
    }

    /// An input is about to be read, and so much has happened. True if the inputs change before that.
    fn changes_before(&mut self, number: u32, happened: usize) -> bool {
        match &mut self.first {
            Some(first) if first.happened == happened => {
                first.reads += u32::from(first.number == number);
                if !self.waits || first.reads < READS {
                    return false;
                }
                self.first = None;
            }
            first => {
                *first = Some(First { number, happened, reads: 1 });
                self.looks = self.looks.saturating_add(1);
                if self.at != Some(self.looks) {
                    return false;
                }
            }
        }
        self.changes += 1;
        true
    }
}

impl Machine {
    /// An input is about to be read. That it changes stands in the trace: a conversion must wait for the same one.
    pub(super) fn input_asked(&mut self, number: u32, trace: &mut Trace) {
        let Some(awaited) = &mut self.awaited else { return };
        if awaited.changes_before(number, trace.happened()) {
            let value = self.peek(Sys::Input, &[number]).unwrap_or(0.0);
            trace.push(EventKind::Write { state: Sys::Input, subscripts: vec![number], value });
        }
    }

    /// What an input is, which was this at the start. At the first change each becomes the other; later ones are drawn.
    pub(super) fn input(&self, number: u32, start: f64) -> f64 {
        let changed = match self.awaited.as_ref().map_or(0, |awaited| awaited.changes) {
            0 => false,
            1 => true,
            changes => {
                let mixed = (changes << 32 ^ u64::from(number)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
                mixed >> 63 == 1
            }
        };
        if changed { f64::from(u8::from(start == 0.0)) } else { start }
    }
}
