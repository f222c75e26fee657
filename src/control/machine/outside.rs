//! What a program that nobody knows does to the machine.

use super::Machine;
use super::exit_state::ExitState;
use super::frame::Frame;
use crate::canon::{Group, Op};
use crate::control::outside::Drawn;

/// The modes that such a program is tried to leave otherwise than it found them. The unit and the plane nobody leaves so.
pub const LEFT: [Group; 3] = [Group::Motion, Group::Distance, Group::Cycle];

/// What is drawn of the state, by number.
const OFFSET: u64 = 1;
const MODE: u64 = 2;

impl Machine {
    /// What such a program finds: the state that a return would leave.
    pub fn found(&self) -> ExitState {
        let mut state = self.state();
        state.length.0 = if self.length_lost.is_some() { self.length_value() } else { self.frame.length };
        // The length counts by itself: it may be lost.
        state.shift = Frame { length: 0.0, ..self.frame.clone() }.shifts();
        state
    }

    /// Goes on where such a program may have left the machine: elsewhere, with another zero point, and in other modes if
    /// those are drawn too.
    pub fn go_on(&mut self, drawn: Drawn, modes: bool) {
        let lathe = self.rules.lathe;
        let axes = (0..3).filter(|axis| !(lathe && *axis == 1));
        let (shift, number) = (drawn.shift(), self.frame.number);
        for axis in axes {
            self.position[axis] += shift[axis];
            if number > 0 && !lathe && drawn.one_of(OFFSET, 3) == 0 {
                self.work_offsets.entry(number).or_default()[axis] += shift[2 - axis] / 2.0;
            }
        }
        self.probed = self.position;
        if number > 0 && !self.stale {
            self.select(number);
        }
        if !modes {
            return;
        }
        self.cycle = None;
        self.incremental = drawn.one_of(MODE, 2) == 0;
        self.motion = if drawn.one_of(MODE + 1, 2) == 0 { Op::Rapid } else { Op::Linear };
    }
}
