//! A contour: the blocks from P to Q of a program, and the cycles that read them.

use super::profile::Profile;
use super::{finish, rough};
use crate::canon::{Op, Role};
use crate::control::machine::{Command, Machine};
use crate::control::outcome::Stop;
use crate::control::trace::{Place, Trace};

/// A block of a contour, its words read.
#[derive(Clone, Debug)]
pub struct Contoured {
    /// The block.
    pub at: Place,
    /// What its words say.
    pub command: Command,
}

/// The blocks of a contour, in order.
#[derive(Clone, Debug, Default)]
pub struct Contour {
    /// The blocks.
    pub blocks: Vec<Contoured>,
}

impl Machine {
    /// Runs a cycle over a contour; what else its block says has been done.
    pub fn cut_contour(
        &mut self,
        op: Op,
        command: &Command,
        contour: &Contour,
        trace: &mut Trace,
    ) -> Result<(), Stop> {
        let (start, motion) = (self.position, self.motion);
        let profile = Profile::read(self, op, contour, trace)?;
        trace.doubt("machine:lathe.contour.moves");
        let words = contour.blocks.iter().map(|block| self.most_off(&block.command, |_| true));
        let own = self.most_off(command, |role| role != Role::CutDepth);
        let [x, z] = self.off_ends(&profile.pieces);
        let off = words.fold(own, f64::max).max(x).max(z);
        trace.rounded = self.off_by() + 4.0 * off;
        match op {
            Op::RoughTurning => rough::run(self, command, &profile, 0, trace)?,
            Op::RoughFacing => rough::run(self, command, &profile, 1, trace)?,
            Op::Pattern => finish::pattern(self, command, &profile, trace)?,
            _ => finish::finish(self, contour, &profile, trace)?,
        }
        self.rapid_to(start, trace);
        trace.roughs = false;
        self.cycle_done(motion);
        Ok(())
    }

    /// Switches the run-out of threads on or off.
    pub fn set_run_out(&mut self, on: bool) {
        self.lathe.runs_straight = !on;
    }
}
