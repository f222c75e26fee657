//! Jumps: where a sequence number is looked for.

use super::code::{Ex, Program};
use super::run::Runner;
use crate::control::outcome::Stop;
use crate::control::session::Halt;

impl Runner<'_> {
    /// The number that a jump computes: the nearest whole one.
    pub fn jump_target(&mut self, value: &Ex, branch: usize) -> Result<u32, Halt> {
        let value = self.eval(value)?.unwrap_or(0.0);
        self.rounds_to_whole(value);
        let value = value.round();
        if let Some(place) = self.branches.get(self.branch_at(branch)) {
            self.session.branches.took(*place, value as i64);
        }
        if (0.0..=f64::from(u32::MAX)).contains(&value) {
            // In range by the test.
            return Ok(value as u32);
        }
        Err(self.no_sequence(value))
    }

    /// The block that a jump in the running program finds.
    pub fn jump(&mut self, number: u32, from: usize) -> Result<usize, Halt> {
        let Some(frame) = self.frames.last() else { return Err(self.no_sequence(f64::from(number))) };
        let program = frame.program.code;
        let places = program.labels.get(&number).map_or(&[][..], Vec::as_slice);
        let (Some(first), Some(last)) = (places.first(), places.last()) else {
            return Err(self.no_sequence(f64::from(number)));
        };
        let to = if first == last {
            *first
        } else if self.rules.goto_forward.ask(&mut self.session.trace) {
            places.iter().copied().find(|place| *place > from).unwrap_or(*first)
        } else {
            // Numbers that were passed are remembered and found first.
            places.iter().copied().find(|place| *place <= from).unwrap_or(*first)
        };
        if enters_loop(program, from, to) {
            self.session.trace.doubt("machine:jump.into.loop");
        }
        Ok(to)
    }

    pub fn no_sequence(&self, number: f64) -> Halt {
        let text = format!("N{number} is not in the program");
        Halt::Alarm(Stop::no_label(self.style.alarms.no_sequence, text))
    }

    /// Goes on with a block of the running program.
    pub fn go(&mut self, to: usize) {
        if let Some(frame) = self.frames.last_mut() {
            frame.at = to;
        }
    }
}

/// True where the target stands in a loop that the jump does not.
fn enters_loop(program: &Program, from: usize, to: usize) -> bool {
    let mut around = program.loop_of.get(to).copied().flatten();
    while let Some(loop_) = around.and_then(|index| program.loops.get(index)) {
        // The head of a loop is not inside it.
        if to != loop_.head && !(loop_.head..=loop_.tail).contains(&from) {
            return true;
        }
        around = loop_.outer;
    }
    false
}
