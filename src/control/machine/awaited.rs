//! Inputs that change while a program waits for them.
//!
//! A program that waits for a part, and then for its removal, comes to its end with no value of the input that stays as
//! it is. So where a scenario has it so, all inputs change once a program has read one so many times and nothing has
//! happened in between, but for dwells. They change right before that read: both sides of a conversion find the same
//! there, and have gone round as often, in however many blocks each of them waits.

use super::Machine;
use crate::canon::Sys;
use crate::control::trace::{EventKind, Trace};

/// How often a program reads an input before it changes.
const READS: u32 = 64;

/// What is known of the waiting of a program.
#[derive(Clone, Debug, Default)]
pub(super) struct Awaited {
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

impl Machine {
    /// An input is about to be read. That it changes stands in the trace: a conversion must wait for the same one.
    pub(super) fn input_asked(&mut self, number: u32, trace: &mut Trace) {
        let Some(awaited) = &mut self.awaited else { return };
        let happened = trace.happened();
        match &mut awaited.first {
            Some(first) if first.happened == happened => {
                first.reads += u32::from(first.number == number);
                if first.reads < READS {
                    return;
                }
                (awaited.changes, awaited.first) = (awaited.changes + 1, None);
                let value = self.peek(Sys::Input, &[number]).unwrap_or(0.0);
                trace.push(EventKind::Write { state: Sys::Input, subscripts: vec![number], value });
            }
            first => *first = Some(First { number, happened, reads: 1 }),
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
